//! Small dense kernels on row-major `n × n` slices, free of allocation.
//!
//! The recursion calls these once per frame on matrices of the hidden dimension, where a call
//! into a general library costs as much as the arithmetic. They are inlined into the jobs that
//! [`fast`] runs, which compiles them for the vectors of the processor at hand and for the usual
//! hidden dimension. No product is fused with a sum, so that results are the same on any processor.
#![allow(clippy::inline_always, reason = "a kernel must take on the vectors of its caller")]

/// The hidden dimension that has a copy of every loop of its own.
const USUAL: usize = 16;

/// Columns computed together, so that their sums stay in registers.
const BLOCK: usize = 16;

/// Work on matrices of the hidden dimension `n`.
pub(crate) trait Job {
    type Output;

    /// Does the work; to be marked `#[inline(always)]`.
    fn run(self, n: usize) -> Self::Output;
}

/// Runs a job compiled for the widest vectors of this processor, and for `n` where it is usual.
pub(crate) fn fast<J: Job>(n: usize, job: J) -> J::Output {
    pulp::Arch::new().dispatch(Dispatched { n, job })
}

struct Dispatched<J> {
    n: usize,
    job: J,
}

impl<J: Job> pulp::WithSimd for Dispatched<J> {
    type Output = J::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> J::Output {
        if self.n == USUAL { self.job.run(USUAL) } else { self.job.run(self.n) }
    }
}

/// Rows computed together: four vectors a row are too few sums to hide the latency of an addition.
const ROWS: usize = 2;

/// `out = A · B`, where element `(i, k)` of `A` lies at `i * row + k * column`.
#[inline(always)]
fn multiply_strided(a: &[f64], row: usize, column: usize, b: &[f64], out: &mut [f64], n: usize) {
    let (a, b, out) = (&a[..n * n], &b[..n * n], &mut out[..n * n]);
    let blocked = n - n % BLOCK;
    let paired = n - n % ROWS;
    for start in (0..blocked).step_by(BLOCK) {
        for i in (0..paired).step_by(ROWS) {
            let mut sums = [[0.0; BLOCK]; ROWS];
            for k in 0..n {
                let b_row = &b[k * n + start..][..BLOCK];
                // A loop: a closure per element would not always be inlined.
                let mut factors = [0.0; ROWS];
                for (r, factor) in factors.iter_mut().enumerate() {
                    *factor = a[(i + r) * row + k * column];
                }
                add_outer(&mut sums, &factors, b_row);
            }
            for (r, sum) in sums.iter().enumerate() {
                out[(i + r) * n + start..][..BLOCK].copy_from_slice(sum);
            }
        }
        for i in paired..n {
            let mut sum = [[0.0; BLOCK]];
            for k in 0..n {
                add_outer(&mut sum, &[a[i * row + k * column]], &b[k * n + start..][..BLOCK]);
            }
            out[i * n + start..][..BLOCK].copy_from_slice(&sum[0]);
        }
    }
    if blocked < n {
        for i in 0..n {
            let rest = &mut out[i * n + blocked..(i + 1) * n];
            rest.fill(0.0);
            for k in 0..n {
                add_scaled(rest, a[i * row + k * column], &b[k * n + blocked..(k + 1) * n]);
            }
        }
    }
}

/// Adds each factor times the row to its sums, which stay in registers.
#[inline(always)]
fn add_outer<const R: usize>(sums: &mut [[f64; BLOCK]; R], factors: &[f64; R], row: &[f64]) {
    let row = &row[..BLOCK];
    for (sum, factor) in sums.iter_mut().zip(factors) {
        for c in 0..BLOCK {
            sum[c] += factor * row[c];
        }
    }
}

/// `out = A · B`.
#[inline(always)]
pub(crate) fn multiply(a: &[f64], b: &[f64], out: &mut [f64], n: usize) {
    multiply_strided(a, n, 1, b, out, n);
}

/// `out = Aᵀ · B`.
#[inline(always)]
pub(crate) fn multiply_transposed(a: &[f64], b: &[f64], out: &mut [f64], n: usize) {
    multiply_strided(a, 1, n, b, out, n);
}

/// `out = A · x`, given `transposed = Aᵀ` (the matrix itself when it is symmetric).
#[inline(always)]
pub(crate) fn apply(transposed: &[f64], x: &[f64], out: &mut [f64], n: usize) {
    out[..n].fill(0.0);
    add_applied(transposed, x, out, n);
}

/// `out += A · x`, given `transposed = Aᵀ` (the matrix itself when it is symmetric).
#[inline(always)]
pub(crate) fn add_applied(transposed: &[f64], x: &[f64], out: &mut [f64], n: usize) {
    let (transposed, x, out) = (&transposed[..n * n], &x[..n], &mut out[..n]);
    let blocked = n - n % BLOCK;
    for start in (0..blocked).step_by(BLOCK) {
        // Two sums that alternate halve the time spent waiting for the one before.
        let (mut even, mut odd) = ([0.0; BLOCK], [0.0; BLOCK]);
        even.copy_from_slice(&out[start..][..BLOCK]);
        for k in (0..n - n % 2).step_by(2) {
            let (first, second) = (
                &transposed[k * n + start..][..BLOCK],
                &transposed[(k + 1) * n + start..][..BLOCK],
            );
            for c in 0..BLOCK {
                even[c] += x[k] * first[c];
                odd[c] += x[k + 1] * second[c];
            }
        }
        if n % 2 == 1 {
            add_scaled(&mut odd, x[n - 1], &transposed[(n - 1) * n + start..][..BLOCK]);
        }
        for c in 0..BLOCK {
            out[start + c] = even[c] + odd[c];
        }
    }
    if blocked < n {
        for k in 0..n {
            add_scaled(&mut out[blocked..], x[k], &transposed[k * n + blocked..(k + 1) * n]);
        }
    }
}

/// Inner product.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// `out += factor · a`.
#[inline(always)]
pub(crate) fn add_scaled(out: &mut [f64], factor: f64, a: &[f64]) {
    for (o, x) in out.iter_mut().zip(a) {
        *o += factor * x;
    }
}

/// `out = Aᵀ`.
#[inline(always)]
pub(crate) fn transpose(a: &[f64], out: &mut [f64], n: usize) {
    let (a, out) = (&a[..n * n], &mut out[..n * n]);
    for i in 0..n {
        for j in 0..n {
            out[j * n + i] = a[i * n + j];
        }
    }
}

/// Makes `a` symmetric by averaging it with its transpose.
#[inline(always)]
pub(crate) fn symmetrize(a: &mut [f64], n: usize) {
    let a = &mut a[..n * n];
    for i in 0..n {
        for j in 0..i {
            let mean = 0.5 * (a[i * n + j] + a[j * n + i]);
            a[i * n + j] = mean;
            a[j * n + i] = mean;
        }
    }
}

/// Upper Cholesky factor `U` of `a = Uᵀ U` in `out` (zeros below the diagonal), read from the
/// upper half of `a`; `false` when `a` is not positive definite or not finite.
#[inline(always)]
pub(crate) fn cholesky(a: &[f64], out: &mut [f64], n: usize) -> bool {
    let out = &mut out[..n * n];
    out.copy_from_slice(&a[..n * n]);
    for k in 0..n {
        let (head, tail) = out.split_at_mut((k + 1) * n);
        let row = &mut head[k * n..];
        let pivot = row[k];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        let scale = pivot.sqrt().recip();
        row[..k].fill(0.0);
        row[k..].iter_mut().for_each(|x| *x *= scale);
        // Whole rows: what is computed below the diagonal is never read, and vectors stay full.
        for (i, later) in tail.chunks_exact_mut(n).enumerate() {
            add_scaled(later, -row[k + 1 + i], row);
        }
    }
    true
}

/// `2 Σ ln Uᵢᵢ`, the log-determinant of `Uᵀ U`.
#[inline(always)]
pub(crate) fn log_determinant(factor: &[f64], n: usize) -> f64 {
    (0..n).map(|i| factor[i * n + i].ln()).sum::<f64>() * 2.0
}

/// Solves `Uᵀ · X = B` in place for the `columns` right-hand sides in the rows of `b`.
#[inline(always)]
pub(crate) fn solve_lower(factor: &[f64], b: &mut [f64], n: usize, columns: usize) {
    let (factor, b) = (&factor[..n * n], &mut b[..n * columns]);
    for i in 0..n {
        let (done, rest) = b.split_at_mut(i * columns);
        let weights = (0..i).map(|k| factor[k * n + i]);
        eliminate(&mut rest[..columns], weights.zip(done.chunks_exact(columns)), factor[i * n + i]);
    }
}

/// Solves `U · X = B` in place for the `columns` right-hand sides in the rows of `b`.
#[inline(always)]
fn solve_upper(factor: &[f64], b: &mut [f64], n: usize, columns: usize) {
    let (factor, b) = (&factor[..n * n], &mut b[..n * columns]);
    for i in (0..n).rev() {
        let (head, done) = b.split_at_mut((i + 1) * columns);
        let weights = factor[i * n + i + 1..(i + 1) * n].iter().copied();
        let done = weights.zip(done.chunks_exact(columns));
        eliminate(&mut head[i * columns..], done, factor[i * n + i]);
    }
}

/// Takes the weighted rows that are solved off the next one and divides it by its pivot.
#[inline(always)]
fn eliminate<'a>(
    row: &mut [f64],
    done: impl Iterator<Item = (f64, &'a [f64])> + Clone,
    pivot: f64,
) {
    let scale = pivot.recip();
    let blocked = row.len() - row.len() % BLOCK;
    for start in (0..blocked).step_by(BLOCK) {
        let block = &mut row[start..][..BLOCK];
        let mut sums = [0.0; BLOCK];
        sums.copy_from_slice(block);
        for (weight, done) in done.clone() {
            let done = &done[start..][..BLOCK];
            for c in 0..BLOCK {
                sums[c] -= weight * done[c];
            }
        }
        for c in 0..BLOCK {
            block[c] = sums[c] * scale;
        }
    }
    let rest = &mut row[blocked..];
    if rest.is_empty() {
        return;
    }
    for (weight, done) in done {
        add_scaled(rest, -weight, &done[blocked..]);
    }
    for x in rest {
        *x *= scale;
    }
}

/// Solves `Uᵀ U · X = B` in place for the `columns` right-hand sides in the rows of `b`.
#[inline(always)]
pub(crate) fn solve_cholesky(factor: &[f64], b: &mut [f64], n: usize, columns: usize) {
    solve_lower(factor, b, n, columns);
    solve_upper(factor, b, n, columns);
}

/// Largest absolute entry and largest absolute difference of two slices.
#[inline(always)]
pub(crate) fn magnitude_and_change(a: &[f64], b: &[f64]) -> (f64, f64) {
    let (mut size, mut change) = ([0.0_f64; 8], [0.0_f64; 8]);
    let larger = |x: f64, y: f64| if x > y { x } else { y };
    for (a, b) in a.chunks(8).zip(b.chunks(8)) {
        for (c, (x, y)) in a.iter().zip(b).enumerate() {
            size[c] = larger(x.abs(), size[c]);
            change[c] = larger((x - y).abs(), change[c]);
        }
    }
    let most = |values: [f64; 8]| values.into_iter().fold(0.0, larger);
    (most(size), most(change))
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
