//! A Gaussian process fitted to one scene, with pseudo-gaps left out of it.
#![allow(clippy::inline_always, reason = "a kernel must take on the vectors of its caller")]

use std::ops::Range;

use super::{
    factor::{Factor, Tail, dot},
    kernel::{Kernel, Timed},
    scene::Scene,
};

/// The process given all rows.
pub(super) struct Process<'a> {
    scene: &'a Scene,
    kernel: Timed,
    noise: f64,
    tail: Tail,
    /// `K⁻¹ y`, by coordinate.
    weights: [Vec<f64>; 3],
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
    /// The process by a kernel, ready to leave out rows from `apart` on; `None` where the covariances are not
    /// positive, which takes positions that are not finite.
    pub fn fit(scene: &'a Scene, apart: usize, rate_hz: f64, kernel: Kernel) -> Option<Self> {
        let timed = kernel.timed(scene.lags(), rate_hz);
        let factor = Factor::of(timed.within(scene.within(), scene.rows()))?;
        let weights = factor.solve(&scene.frames.target);
        let tail = factor.tail(apart);
        Some(Self { scene, kernel: timed, noise: kernel.noise, tail, weights })
    }

    /// Local positions in the wanted frames.
    pub fn predict(&self) -> Vec<[f64; 3]> {
        pulp::Arch::new().dispatch(Predict { process: self })
    }

    /// What is left of the error in a row that the process has seen.
    pub fn residual(&self, row: usize) -> [f64; 3] {
        self.weight(row).map(|w| self.noise * w)
    }

    fn weight(&self, row: usize) -> [f64; 3] {
        std::array::from_fn(|a| self.weights[a][row])
    }

    /// The errors without the rows `hidden`, and in the rows just beside them, `before` and `after`.
    ///
    /// From blocks of the inverse: the errors of the left-out rows B are (K⁻¹)_BB⁻¹ (K⁻¹ y)_B, as in
    /// [RW06] Eq. (5.12) for one row.
    pub fn leave_out(
        &self,
        hidden: &Range<usize>,
        before: Option<usize>,
        after: Option<usize>,
    ) -> Option<LeftOut> {
        let least = before.map_or(hidden.start, |row| row.min(hidden.start));
        let around = least..after.map_or(hidden.end, |row| (row + 1).max(hidden.end));
        let block = self.tail.block(&around);
        let own = hidden.start - around.start..hidden.end - around.start;
        let weights: Vec<[f64; 3]> = hidden.clone().map(|row| self.weight(row)).collect();
        let columns = Factor::of(block.part(&own))?.solve(&weights);
        let beside = |row: usize| {
            let at = row - around.start;
            // Only the lower triangle is there.
            let cell = |k: usize| if k < at { block.row(at)[k] } else { block.row(k)[at] };
            let weight = self.weight(row);
            std::array::from_fn(|a| {
                let sum: f64 = own.clone().map(cell).zip(&columns[a]).map(|(k, e)| k * e).sum();
                self.noise * (weight[a] - sum)
            })
        };
        Some(LeftOut {
            errors: (0..hidden.len()).map(|k| std::array::from_fn(|a| columns[a][k])).collect(),
            before: before.map(beside),
            after: after.map(beside),
        })
    }
}

struct Predict<'a> {
    process: &'a Process<'a>,
}

impl pulp::WithSimd for Predict<'_> {
    type Output = Vec<[f64; 3]>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        let Process { scene, kernel, weights, .. } = self.process;
        let (rows, wanted) = (scene.rows(), scene.wanted());
        let mut covariance = vec![0.0; rows.frames.len()];
        // Loops, not closures: these would not take on the vectors of this function.
        let mut places = vec![scene.frames.mean; wanted.frames.len()];
        for (i, place) in places.iter_mut().enumerate() {
            let products = &scene.between().row(i)[..covariance.len()];
            kernel.row(products, wanted.squares[i], wanted.frames[i], rows, &mut covariance);
            for (place, weights) in place.iter_mut().zip(weights) {
                *place += dot(&covariance, weights);
            }
        }
        places
    }
}
