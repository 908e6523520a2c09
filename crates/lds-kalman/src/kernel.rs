//! Small dense kernels on row-major `n × n` slices, free of allocation.
//!
//! The recursion calls these once per frame on matrices of the hidden dimension, where a call
//! into a general library costs as much as the arithmetic.

/// Columns computed together, so that their sums stay in registers.
const BLOCK: usize = 8;

/// `out = A · B`, where element `(i, k)` of `A` lies at `i * row + k * column`.
fn multiply_strided(a: &[f64], row: usize, column: usize, b: &[f64], out: &mut [f64], n: usize) {
    let blocked = n - n % BLOCK;
    for i in 0..n {
        let out_row = &mut out[i * n..(i + 1) * n];
        for start in (0..blocked).step_by(BLOCK) {
            let mut sum = [0.0; BLOCK];
            for k in 0..n {
                let factor = a[i * row + k * column];
                let b_row = &b[k * n + start..k * n + start + BLOCK];
                for (s, x) in sum.iter_mut().zip(b_row) {
                    *s += factor * x;
                }
            }
            out_row[start..start + BLOCK].copy_from_slice(&sum);
        }
        for j in blocked..n {
            out_row[j] = (0..n).map(|k| a[i * row + k * column] * b[k * n + j]).sum();
        }
    }
}

/// `out = A · B`.
pub(crate) fn multiply(a: &[f64], b: &[f64], out: &mut [f64], n: usize) {
    multiply_strided(a, n, 1, b, out, n);
}

/// `out = Aᵀ · B`.
pub(crate) fn multiply_transposed(a: &[f64], b: &[f64], out: &mut [f64], n: usize) {
    multiply_strided(a, 1, n, b, out, n);
}

/// `out = A · x`, given `transposed = Aᵀ` (the matrix itself when it is symmetric).
pub(crate) fn apply(transposed: &[f64], x: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    add_applied(transposed, x, out);
}

/// `out += A · x`, given `transposed = Aᵀ` (the matrix itself when it is symmetric).
pub(crate) fn add_applied(transposed: &[f64], x: &[f64], out: &mut [f64]) {
    for (row, &factor) in transposed.chunks_exact(x.len()).zip(x) {
        for (o, a) in out.iter_mut().zip(row) {
            *o += factor * a;
        }
    }
}

/// Inner product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// `out += factor · a`.
pub(crate) fn add_scaled(out: &mut [f64], factor: f64, a: &[f64]) {
    for (o, x) in out.iter_mut().zip(a) {
        *o += factor * x;
    }
}

/// `out = Aᵀ`.
pub(crate) fn transpose(a: &[f64], out: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..n {
            out[j * n + i] = a[i * n + j];
        }
    }
}

/// Makes `a` symmetric by averaging it with its transpose.
pub(crate) fn symmetrize(a: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..i {
            let mean = f64::midpoint(a[i * n + j], a[j * n + i]);
            a[i * n + j] = mean;
            a[j * n + i] = mean;
        }
    }
}

/// Lower Cholesky factor of `a` in `out` (zeros above the diagonal); `false` when `a` is not
/// positive definite or not finite.
pub(crate) fn cholesky(a: &[f64], out: &mut [f64], n: usize) -> bool {
    out.fill(0.0);
    for i in 0..n {
        for j in 0..i {
            let sum = a[i * n + j] - dot(&out[i * n..i * n + j], &out[j * n..j * n + j]);
            out[i * n + j] = sum / out[j * n + j];
        }
        let row = &out[i * n..i * n + i];
        let pivot = a[i * n + i] - dot(row, row);
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        out[i * n + i] = pivot.sqrt();
    }
    true
}

/// `2 Σ ln Lᵢᵢ`, the log-determinant of `L Lᵀ`.
pub(crate) fn log_determinant(factor: &[f64], n: usize) -> f64 {
    (0..n).map(|i| factor[i * n + i].ln()).sum::<f64>() * 2.0
}

/// Solves `L · X = B` in place for the `columns` right-hand sides in the rows of `b`.
pub(crate) fn solve_lower(factor: &[f64], b: &mut [f64], n: usize, columns: usize) {
    for i in 0..n {
        let (done, rest) = b.split_at_mut(i * columns);
        let row = &mut rest[..columns];
        for k in 0..i {
            add_scaled(row, -factor[i * n + k], &done[k * columns..(k + 1) * columns]);
        }
        let pivot = factor[i * n + i];
        for x in row {
            *x /= pivot;
        }
    }
}

/// Solves `Lᵀ · X = B` in place for the `columns` right-hand sides in the rows of `b`.
fn solve_upper(factor: &[f64], b: &mut [f64], n: usize, columns: usize) {
    for i in (0..n).rev() {
        let (head, done) = b.split_at_mut((i + 1) * columns);
        let row = &mut head[i * columns..];
        for k in i + 1..n {
            let from = (k - i - 1) * columns;
            add_scaled(row, -factor[k * n + i], &done[from..from + columns]);
        }
        let pivot = factor[i * n + i];
        for x in row {
            *x /= pivot;
        }
    }
}

/// Solves `L Lᵀ · X = B` in place for the `columns` right-hand sides in the rows of `b`.
pub(crate) fn solve_cholesky(factor: &[f64], b: &mut [f64], n: usize, columns: usize) {
    solve_lower(factor, b, n, columns);
    solve_upper(factor, b, n, columns);
}

/// Largest absolute entry and largest absolute difference of two slices.
pub(crate) fn magnitude_and_change(a: &[f64], b: &[f64]) -> (f64, f64) {
    a.iter().zip(b).fold((0.0_f64, 0.0_f64), |(size, change), (x, y)| {
        (size.max(x.abs()), change.max((x - y).abs()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A symmetric positive definite matrix without structure.
    fn example(n: usize) -> Vec<f64> {
        let raw: Vec<f64> = (0..n * n).map(|i| ((i * 7919 % 101) as f64 / 101.0) - 0.5).collect();
        let mut product = vec![0.0; n * n];
        multiply_transposed(&raw, &raw, &mut product, n);
        (0..n).for_each(|i| product[i * n + i] += 0.1);
        product
    }

    #[test]
    fn a_cholesky_solve_gives_the_inverse_for_sizes_around_the_block_width() {
        for n in [1, 2, 7, 8, 9, 16, 19] {
            let a = example(n);
            let mut factor = vec![0.0; n * n];
            assert!(cholesky(&a, &mut factor, n));
            let mut inverse = vec![0.0; n * n];
            (0..n).for_each(|i| inverse[i * n + i] = 1.0);
            solve_cholesky(&factor, &mut inverse, n, n);
            let mut product = vec![0.0; n * n];
            multiply(&a, &inverse, &mut product, n);
            for i in 0..n {
                for j in 0..n {
                    let expected = f64::from(u8::from(i == j));
                    // 1e-11: the condition number of the example is below 1e3.
                    assert!((product[i * n + j] - expected).abs() < 1e-11);
                }
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        let mut factor = [0.0; 4];
        assert!(!cholesky(&[1.0, 2.0, 2.0, 1.0], &mut factor, 2));
        assert!(!cholesky(&[f64::NAN, 0.0, 0.0, 1.0], &mut factor, 2));
    }
}
