//! A dense symmetric positive matrix and its inverse, by the Cholesky factor.
#![allow(clippy::inline_always, reason = "a kernel must take on the vectors of its caller")]

use std::ops::Range;

use ndarray::{Array2, s};

/// The inverse of the Cholesky factor `L` of a matrix `K = L Lᵀ`, row-major in its lower triangle, so
/// that any block of `K⁻¹ = L⁻ᵀ L⁻¹` is at hand.
#[derive(Debug, Clone)]
pub(super) struct Inverse {
    rows: Array2<f64>,
}

impl Inverse {
    /// Inverts `(n, n)` of which the lower triangle counts; `None` if it is not positive.
    ///
    /// # Cost
    /// 2 n³ / 3 operations.
    pub fn of(n: usize, matrix: Vec<f64>) -> Option<Self> {
        pulp::Arch::new().dispatch(Invert { n, matrix })
    }

    /// `K⁻¹ y`, column by column.
    pub fn solve(&self, y: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let n = self.rows.nrows();
        let mut half = vec![[0.0; 3]; n];
        for (i, out) in half.iter_mut().enumerate() {
            for (l, y) in self.row(i).iter().zip(y) {
                for a in 0..3 {
                    out[a] += l * y[a];
                }
            }
        }
        let mut whole = vec![[0.0; 3]; n];
        for (i, half) in half.iter().enumerate() {
            for (l, out) in self.row(i).iter().zip(&mut whole) {
                for a in 0..3 {
                    out[a] += l * half[a];
                }
            }
        }
        whole
    }

    /// The entries of `K⁻¹` whose row and column lie in `range`.
    ///
    /// # Cost
    /// 2 n k² operations for k rows.
    pub fn block(&self, range: &Range<usize>) -> Array2<f64> {
        let columns = self.rows.slice(s![range.start.., range.clone()]);
        columns.t().dot(&columns)
    }

    /// Row `i` of `L⁻¹` up to the diagonal.
    fn row(&self, i: usize) -> &[f64] {
        let n = self.rows.ncols();
        self.rows.as_slice().map_or(&[], |rows| &rows[i * n..=i * n + i])
    }
}

struct Invert {
    n: usize,
    matrix: Vec<f64>,
}

impl pulp::WithSimd for Invert {
    type Output = Option<Inverse>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        let Self { n, mut matrix } = self;
        factorise(&mut matrix, n)?;
        let mut rows = vec![0.0; n * n];
        for i in 0..n {
            let (above, row) = rows.split_at_mut(i * n);
            let row = &mut row[..=i];
            for k in 0..i {
                add_scaled(&mut row[..=k], -matrix[i * n + k], &above[k * n..=k * n + k]);
            }
            let pivot = 1.0 / matrix[i * n + i];
            row[i] = 1.0;
            for x in row {
                *x *= pivot;
            }
        }
        Some(Inverse { rows: Array2::from_shape_vec((n, n), rows).ok()? })
    }
}

/// The lower factor in place of the lower triangle; `None` if a pivot is not positive.
#[inline(always)]
fn factorise(a: &mut [f64], n: usize) -> Option<()> {
    for i in 0..n {
        let (above, row) = a.split_at_mut(i * n);
        for j in 0..i {
            let other = &above[j * n..=j * n + j];
            row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        let pivot = row[i] - dot(&row[..i], &row[..i]);
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        row[i] = pivot.sqrt();
    }
    Some(())
}

/// Solves the small positive system `A x = b`, `A` `(n, n)` row-major in its lower triangle; `None` if
/// it is not positive.
pub(super) fn solve_small(a: Vec<f64>, b: Vec<[f64; 3]>) -> Option<Vec<[f64; 3]>> {
    pulp::Arch::new().dispatch(Solve { a, b })
}

struct Solve {
    a: Vec<f64>,
    b: Vec<[f64; 3]>,
}

impl pulp::WithSimd for Solve {
    type Output = Option<Vec<[f64; 3]>>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        let Self { mut a, mut b } = self;
        let n = b.len();
        factorise(&mut a, n)?;
        for i in 0..n {
            for k in 0..i {
                let (l, known) = (a[i * n + k], b[k]);
                for c in 0..3 {
                    b[i][c] -= l * known[c];
                }
            }
            b[i] = b[i].map(|x| x / a[i * n + i]);
        }
        for i in (0..n).rev() {
            b[i] = b[i].map(|x| x / a[i * n + i]);
            let known = b[i];
            for k in 0..i {
                for c in 0..3 {
                    b[k][c] -= a[i * n + k] * known[c];
                }
            }
        }
        Some(b)
    }
}

/// Inner product over sixteen running sums, which the compiler turns into vector instructions.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 16;
    let mut sums = [0.0; LANES];
    let (heads, tails) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f64 = heads.remainder().iter().zip(tails.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in heads.zip(tails) {
        for k in 0..LANES {
            sums[k] += x[k] * y[k];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[inline(always)]
fn add_scaled(out: &mut [f64], factor: f64, x: &[f64]) {
    for (out, x) in out.iter_mut().zip(x) {
        *out += factor * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A well-conditioned matrix of forty rows.
    fn matrix(n: usize) -> Vec<f64> {
        let cell = |i: usize, j: usize| {
            let near = (-(i.abs_diff(j) as f64) / 7.0).exp();
            if i == j { 1.1 } else { near }
        };
        (0..n * n).map(|k| cell(k / n, k % n)).collect()
    }

    #[test]
    fn the_inverse_solves() {
        let n = 40;
        let k = matrix(n);
        let inverse = Inverse::of(n, k.clone()).unwrap();
        let y: Vec<[f64; 3]> = (0..n).map(|i| [i as f64, 1.0, (i % 5) as f64]).collect();
        let x = inverse.solve(&y);
        for i in 0..n {
            for a in 0..3 {
                let product: f64 = (0..n).map(|j| k[i * n + j] * x[j][a]).sum();
                // Forty terms of order forty, condition below a thousand.
                assert!((product - y[i][a]).abs() < 1e-10);
            }
        }
        let (whole, part) = (inverse.block(&(0..n)), inverse.block(&(13..21)));
        assert!((&part - &whole.slice(s![13..21, 13..21])).iter().all(|x| x.abs() < 1e-12));
        let direct = solve_small(k, y).unwrap();
        assert!(
            x.iter().flatten().zip(direct.iter().flatten()).all(|(p, q)| (p - q).abs() < 1e-10)
        );
    }

    #[test]
    fn a_matrix_that_is_not_positive_has_no_inverse() {
        assert!(Inverse::of(2, vec![1.0, 2.0, 2.0, 1.0]).is_none());
        assert!(Inverse::of(1, vec![f64::NAN]).is_none());
    }
}
