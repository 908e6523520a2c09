//! A dense symmetric positive matrix, its Cholesky factor, and blocks of its inverse.
#![allow(clippy::inline_always, reason = "a kernel must take on the vectors of its caller")]

use std::ops::Range;

use pulp::Simd;

use super::tile::{Panel, TILE, tile};

/// The Cholesky factor `L` of a matrix `K = L Lᵀ`.
#[derive(Debug, Clone)]
pub(super) struct Factor {
    lower: Panel,
    /// One by the diagonal of `L`.
    pivots: Vec<f64>,
}

impl Factor {
    /// Factorises a square matrix of which the lower triangle counts; `None` if it is not positive.
    ///
    /// # Cost
    /// n³ / 3 operations.
    pub fn of(matrix: Panel) -> Option<Self> {
        pulp::Arch::new().dispatch(Factorise { lower: matrix })
    }

    /// `K⁻¹ y`, for each of three columns of `y`.
    pub fn solve(&self, y: &[[f64; 3]]) -> [Vec<f64>; 3] {
        pulp::Arch::new().dispatch(Solve { factor: self, y })
    }

    /// The last rows and columns of `K⁻¹`, from row `first` or up to three earlier, in a form that gives blocks of
    /// it: the inverse of a Schur complement, whose factor is the last block of `L`.
    ///
    /// # Cost
    /// m³ / 3 operations for m rows.
    pub fn tail(&self, first: usize) -> Tail {
        pulp::Arch::new().dispatch(Invert { factor: self, first: first / TILE * TILE })
    }
}

/// The last block of an inverse.
pub(super) struct Tail {
    first: usize,
    /// Row `j` holds column `j` of the inverse of the last block of `L`, so that `K⁻¹` holds their products.
    columns: Panel,
}

impl Tail {
    /// The entries of `K⁻¹` whose row and column lie in `range`, in the lower triangle of a matrix of that size.
    ///
    /// # Cost
    /// m k² operations for k rows.
    pub fn block(&self, range: &Range<usize>) -> Panel {
        pulp::Arch::new().dispatch(Block { tail: self, range })
    }
}

struct Factorise {
    lower: Panel,
}

impl pulp::WithSimd for Factorise {
    type Output = Option<Factor>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let mut a = self.lower;
        let (n, padded, stride) = (a.rows(), a.padded(), a.stride());
        for i in n..padded {
            a.row_mut(i).fill(0.0);
            a.row_mut(i)[i] = 1.0;
        }
        let mut pivots = vec![1.0; padded];
        for i in (0..padded).step_by(TILE) {
            let (above, own) = a.split(i);
            for j in (0..i).step_by(TILE) {
                let rows = std::array::from_fn(|r| &own[r * stride..r * stride + j]);
                let known = std::array::from_fn(|c| &above[(j + c) * stride..(j + c) * stride + j]);
                let sums = tile(simd, rows, known);
                for (row, sums) in own.chunks_exact_mut(stride).zip(sums) {
                    for (c, sum) in sums.into_iter().enumerate() {
                        let other = &above[(j + c) * stride + j..(j + c) * stride + j + c];
                        let near: f64 = row[j..j + c].iter().zip(other).map(|(x, y)| x * y).sum();
                        row[j + c] = (row[j + c] - sum - near) * pivots[j + c];
                    }
                }
            }
            let rows = std::array::from_fn(|r| &own[r * stride..r * stride + i]);
            let sums = tile(simd, rows, rows);
            for r in 0..TILE {
                for c in 0..=r {
                    let mut x = own[r * stride + i + c] - sums[r][c];
                    for k in 0..c {
                        x -= own[r * stride + i + k] * own[c * stride + i + k];
                    }
                    if c < r {
                        own[r * stride + i + c] = x * pivots[i + c];
                    } else {
                        if x.is_nan() || x <= 0.0 {
                            return None;
                        }
                        own[r * stride + i + r] = x.sqrt();
                        pivots[i + r] = 1.0 / x.sqrt();
                    }
                }
            }
        }
        Some(Factor { lower: a, pivots })
    }
}

struct Solve<'a> {
    factor: &'a Factor,
    y: &'a [[f64; 3]],
}

impl pulp::WithSimd for Solve<'_> {
    type Output = [Vec<f64>; 3];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self { factor: Factor { lower, pivots }, y } = self;
        let mut columns = [(); 3].map(|()| Vec::with_capacity(y.len()));
        for (axis, x) in columns.iter_mut().enumerate() {
            x.extend(y.iter().map(|y| y[axis]));
            for i in 0..x.len() {
                x[i] = (x[i] - dot(&lower.row(i)[..i], &x[..i])) * pivots[i];
            }
            for i in (0..x.len()).rev() {
                x[i] *= pivots[i];
                let known = x[i];
                for (x, l) in x[..i].iter_mut().zip(lower.row(i)) {
                    *x -= known * l;
                }
            }
        }
        columns
    }
}

struct Invert<'a> {
    factor: &'a Factor,
    first: usize,
}

impl pulp::WithSimd for Invert<'_> {
    type Output = Tail;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Tail {
        let Self { factor: Factor { lower, pivots }, first } = self;
        let m = lower.padded() - first;
        let mut columns = Panel::zeros(m, m);
        for i in (0..m).step_by(TILE) {
            for j in (0..=i).step_by(TILE) {
                let rows = std::array::from_fn(|r| &lower.row(first + i + r)[first + j..first + i]);
                let known = std::array::from_fn(|c| &columns.row(j + c)[j..i]);
                let sums = tile(simd, rows, known);
                for (r, sums) in sums.iter().enumerate() {
                    for (c, sum) in sums.iter().enumerate() {
                        let own = &lower.row(first + i + r)[first + i..first + i + r];
                        let unit = if i + r == j + c { 1.0 } else { 0.0 };
                        let column = &mut columns.row_mut(j + c)[i..i + TILE];
                        let near: f64 = own.iter().zip(&*column).map(|(x, y)| x * y).sum();
                        column[r] = (unit - sum - near) * pivots[first + i + r];
                    }
                }
            }
        }
        Tail { first, columns }
    }
}

struct Block<'a> {
    tail: &'a Tail,
    range: &'a Range<usize>,
}

impl pulp::WithSimd for Block<'_> {
    type Output = Panel;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Panel {
        let Self { tail: Tail { first, columns }, range } = self;
        let k = range.len();
        let mut block = Panel::zeros(k, k);
        let column = |i: usize| columns.row((range.start + i.min(k - 1)) - first);
        for i in (0..k).step_by(TILE) {
            // Columns of a lower triangle begin with zeros.
            let from = (range.start + i - first) / TILE * TILE;
            for j in (0..=i).step_by(TILE) {
                let of = |i: usize| std::array::from_fn(|r| &column(i + r)[from..]);
                let sums = tile(simd, of(i), of(j));
                for (r, sums) in sums.iter().enumerate() {
                    block.row_mut(i + r)[j..j + TILE].copy_from_slice(sums);
                }
            }
        }
        block
    }
}

/// Inner product over sixteen running sums, which the compiler turns into vector instructions.
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A well-conditioned matrix.
    fn matrix(n: usize) -> Panel {
        let mut matrix = Panel::zeros(n, n);
        for i in 0..n {
            for j in 0..n {
                let near = (-(i.abs_diff(j) as f64) / 7.0).exp();
                matrix.row_mut(i)[j] = if i == j { 1.1 } else { near };
            }
        }
        matrix
    }

    #[test]
    fn the_factor_solves() {
        for n in [1, 3, 4, 41] {
            let k = matrix(n);
            let y: Vec<[f64; 3]> = (0..n).map(|i| [i as f64, 1.0, (i % 5) as f64]).collect();
            let x = Factor::of(k.clone()).unwrap().solve(&y);
            for (i, y) in y.iter().enumerate() {
                for a in 0..3 {
                    let product: f64 = (0..n).map(|j| k.row(i)[j] * x[a][j]).sum();
                    // Forty terms of order forty, condition below a thousand.
                    assert!((product - y[a]).abs() < 1e-10);
                }
            }
        }
    }

    /// Columns of the inverse, found by solving, are those of the tail.
    #[test]
    fn the_tail_is_that_of_the_inverse() {
        let n = 41;
        let factor = Factor::of(matrix(n)).unwrap();
        let unit = |j: usize| -> Vec<[f64; 3]> {
            (0..n).map(|i| [if i == j { 1.0 } else { 0.0 }, 0.0, 0.0]).collect()
        };
        for first in [0, 5, 12] {
            let tail = factor.tail(first);
            let range = 14..27;
            let block = tail.block(&range);
            for j in range.clone() {
                let [column, ..] = factor.solve(&unit(j));
                for (i, known) in column.iter().enumerate().take(range.end).skip(j) {
                    let found = block.row(i - range.start)[j - range.start];
                    assert!((found - known).abs() < 1e-12, "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_has_no_factor() {
        let mut two = Panel::zeros(2, 2);
        two.row_mut(0)[0] = 1.0;
        two.row_mut(1)[..2].copy_from_slice(&[2.0, 1.0]);
        assert!(Factor::of(two).is_none());
        let mut odd = Panel::zeros(1, 1);
        odd.row_mut(0)[0] = f64::NAN;
        assert!(Factor::of(odd).is_none());
    }
}
