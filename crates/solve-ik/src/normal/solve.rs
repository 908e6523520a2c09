//! Factor and solution of the equations.

use mocap_core::geometry::{sub, times};

use super::{Matrix, Normal};

/// A matrix that is not positive definite, also by NaN.
#[derive(Debug)]
pub(crate) struct Indefinite;

impl Normal {
    /// Factors the matrix with its diagonal raised by a share.
    pub(crate) fn factor(&mut self, damping: f64) -> Result<(), Indefinite> {
        self.factor.copy_from_slice(&self.blocks);
        for row in 0..self.rows() {
            let block = &mut self.factor[self.starts[row]];
            for (a, entries) in block.iter_mut().enumerate() {
                entries[a] *= 1.0 + damping;
            }
        }
        for row in (0..self.rows()).rev() {
            let start = self.starts[row];
            let chain = &self.chains[row];
            let l = cholesky(&self.factor[start])?;
            self.factor[start] = l;
            for at in 1..chain.len() {
                lower_solve_columns(&l, &mut self.factor[start + at]);
            }
            for a in 1..chain.len() {
                let ca = self.factor[start + a];
                let target = self.starts[chain[a]];
                for b in a..chain.len() {
                    let cb = self.factor[start + b];
                    let sum = &mut self.factor[target + b - a];
                    for r in 0..3 {
                        for c in 0..3 {
                            sum[r][c] -=
                                ca[0][r] * cb[0][c] + ca[1][r] * cb[1][c] + ca[2][r] * cb[2][c];
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// The first half of a solution, in place: the inner product of two of them is that of the inverse matrix.
    pub(crate) fn half_solve(&self, x: &mut [[f64; 3]]) {
        for row in (0..self.rows()).rev() {
            let start = self.starts[row];
            let y = lower_solve(&self.factor[start], x[row]);
            x[row] = y;
            for (at, &other) in self.chains[row].iter().enumerate().skip(1) {
                let c = &self.factor[start + at];
                for a in 0..3 {
                    x[other][a] -= c[0][a] * y[0] + c[1][a] * y[1] + c[2][a] * y[2];
                }
            }
        }
    }

    /// The first half of a solution for three right-hand sides at once that are zero but in these rows, which hold all their
    /// ancestors, from the leaves to the root.
    pub(crate) fn half_solve_blocks(&self, rows: &[usize], x: &mut [Matrix]) {
        for (k, &row) in rows.iter().enumerate() {
            let start = self.starts[row];
            lower_solve_columns(&self.factor[start], &mut x[k]);
            let y = x[k];
            let mut after = k;
            for (at, &other) in self.chains[row].iter().enumerate().skip(1) {
                // Both go towards the root.
                while rows[after] != other {
                    after += 1;
                }
                let c = &self.factor[start + at];
                for (a, sums) in x[after].iter_mut().enumerate() {
                    for (b, sum) in sums.iter_mut().enumerate() {
                        *sum -= c[0][a] * y[0][b] + c[1][a] * y[1][b] + c[2][a] * y[2][b];
                    }
                }
            }
        }
    }

    /// Solves with the factored matrix, in place.
    pub(crate) fn solve(&self, x: &mut [[f64; 3]]) {
        self.half_solve(x);
        self.back_solve(x);
    }

    /// The second half of a solution, in place.
    pub(crate) fn back_solve(&self, x: &mut [[f64; 3]]) {
        for row in 0..self.rows() {
            let start = self.starts[row];
            let mut y = x[row];
            for (at, &other) in self.chains[row].iter().enumerate().skip(1) {
                y = sub(y, times(&self.factor[start + at], x[other]));
            }
            x[row] = upper_solve(&self.factor[start], y);
        }
    }
}

fn cholesky(a: &Matrix) -> Result<Matrix, Indefinite> {
    let root = |x: f64| if x > 0.0 && x.is_finite() { Ok(x.sqrt()) } else { Err(Indefinite) };
    let l00 = root(a[0][0])?;
    let (l10, l20) = (a[1][0] / l00, a[2][0] / l00);
    let l11 = root(a[1][1] - l10 * l10)?;
    let l21 = (a[2][1] - l20 * l10) / l11;
    let l22 = root(a[2][2] - l20 * l20 - l21 * l21)?;
    Ok([[l00, 0.0, 0.0], [l10, l11, 0.0], [l20, l21, l22]])
}

#[inline]
fn lower_solve(l: &Matrix, b: [f64; 3]) -> [f64; 3] {
    let x = b[0] / l[0][0];
    let y = (b[1] - l[1][0] * x) / l[1][1];
    [x, y, (b[2] - l[2][0] * x - l[2][1] * y) / l[2][2]]
}

#[inline]
fn lower_solve_columns(l: &Matrix, b: &mut Matrix) {
    let [first, second, third] = b;
    for ((x, y), z) in first.iter_mut().zip(second).zip(third) {
        [*x, *y, *z] = lower_solve(l, [*x, *y, *z]);
    }
}

#[inline]
fn upper_solve(l: &Matrix, b: [f64; 3]) -> [f64; 3] {
    let z = b[2] / l[2][2];
    let y = (b[1] - l[2][1] * z) / l[1][1];
    [(b[0] - l[1][0] * y - l[2][0] * z) / l[0][0], y, z]
}
