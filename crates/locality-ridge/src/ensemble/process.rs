//! A Gaussian process fitted to one scene, with pseudo-gaps left out of it.

use std::ops::Range;

use ndarray::s;

use super::{
    factor::{Inverse, solve_small},
    kernel::Kernel,
    scene::Scene,
};

/// The process given all rows.
pub(super) struct Process<'a> {
    scene: &'a Scene,
    rows: &'a [usize],
    rate_hz: f64,
    kernel: Kernel,
    inverse: Inverse,
    /// `K⁻¹ y`, `(rows, 3)`.
    weights: Vec<[f64; 3]>,
}

/// Errors that the process makes in rows that it has not seen, observed minus predicted, in local
/// coordinates, and what is left of the error in rows that it has.
pub(super) struct LeftOut {
    pub errors: Vec<[f64; 3]>,
    /// In the row before the left-out ones.
    pub before: Option<[f64; 3]>,
    /// In the row after them.
    pub after: Option<[f64; 3]>,
}

impl<'a> Process<'a> {
    /// `None` where the covariances are not positive, which takes positions that are not finite.
    pub fn fit(scene: &'a Scene, rows: &'a [usize], rate_hz: f64, kernel: Kernel) -> Option<Self> {
        let covariance = kernel.within(scene.within(rows), rate_hz);
        let inverse = Inverse::of(rows.len(), covariance)?;
        let weights = inverse.solve(&scene.target);
        Some(Self { scene, rows, rate_hz, kernel, inverse, weights })
    }

    /// Local positions in the wanted frames.
    pub fn predict(&self, wanted: &[usize]) -> Vec<[f64; 3]> {
        let covariance = self.kernel.between(self.scene.between(wanted, self.rows), self.rate_hz);
        covariance
            .chunks_exact(self.rows.len())
            .map(|row| {
                let sum = row.iter().zip(&self.weights).fold([0.0; 3], |sum: [f64; 3], (k, w)| {
                    std::array::from_fn(|a| sum[a] + k * w[a])
                });
                std::array::from_fn(|a| self.scene.mean[a] + sum[a])
            })
            .collect()
    }

    /// What is left of the error in a row that the process has seen.
    pub fn residual(&self, row: usize) -> [f64; 3] {
        self.weights[row].map(|w| self.kernel.noise * w)
    }

    /// The errors without the rows `hidden`, and in the rows just beside them.
    ///
    /// From blocks of the inverse: the errors of the left-out rows B are (K⁻¹)_BB⁻¹ (K⁻¹ y)_B, as in
    /// [RW06] Eq. (5.12) for one row.
    pub fn leave_out(&self, hidden: &Range<usize>) -> Option<LeftOut> {
        let around = hidden.start.saturating_sub(1)..(hidden.end + 1).min(self.rows.len());
        let block = self.inverse.block(&around);
        let own = hidden.start - around.start..hidden.end - around.start;
        let errors = solve_small(
            block.slice(s![own.clone(), own.clone()]).iter().copied().collect(),
            self.weights[hidden.clone()].to_vec(),
        )?;
        let beside = |row: usize| {
            let cross = block.slice(s![row - around.start, own.clone()]);
            let weight = cross.iter().zip(&errors).fold(self.weights[row], |weight, (k, e)| {
                std::array::from_fn(|a| weight[a] - k * e[a])
            });
            weight.map(|w| self.kernel.noise * w)
        };
        let before = (around.start < hidden.start).then(|| beside(around.start));
        let after = (hidden.end < around.end).then(|| beside(hidden.end));
        Some(LeftOut { errors, before, after })
    }
}
