//! A model laid out for the recursions: flat row-major slices and the precision-weighted emission.

use ndarray::{Array1, Array2, Axis};

use crate::{kernel, model::LdsModel, observations::Pattern};

/// What the recursions read of a model.
#[derive(Debug)]
pub(crate) struct Dynamics {
    pub(crate) n: usize,
    pub(crate) transition: Vec<f64>,
    pub(crate) transition_transposed: Vec<f64>,
    pub(crate) state_noise: Vec<f64>,
    pub(crate) initial_mean: Vec<f64>,
    pub(crate) initial_covariance: Vec<f64>,
    pub(crate) emission: Array2<f64>,
    /// `Σ⁻¹ G`, `(m, H)`.
    pub(crate) weighted_emission: Array2<f64>,
    pub(crate) noise: Array1<f64>,
}

impl Dynamics {
    pub(crate) fn new(model: &LdsModel) -> Self {
        let n = model.hidden();
        let emission = model.emission().to_owned();
        let noise = model.observation_noise().variances(model.dimensions());
        let weighted_emission = &emission / &noise.view().insert_axis(Axis(1));
        let transition: Vec<f64> = model.transition().iter().copied().collect();
        let mut transition_transposed = vec![0.0; n * n];
        kernel::transpose(&transition, &mut transition_transposed, n);
        let flat = |matrix: Array2<f64>| matrix.iter().copied().collect();
        Self {
            n,
            transition,
            transition_transposed,
            state_noise: flat(model.state_noise().to_matrix(n)),
            initial_mean: model.initial_mean().to_vec(),
            initial_covariance: flat(model.initial_covariance().to_matrix(n)),
            emission,
            weighted_emission,
            noise,
        }
    }

    /// `Gᵀ Σ⁻¹ W G`, the information a frame with this pattern adds about the state.
    pub(crate) fn add_information(&self, pattern: &Pattern, out: &mut Vec<f64>) {
        let (n, start) = (self.n, out.len());
        if pattern.complete {
            self.add_complete_information(out);
            return;
        }
        out.resize(start + n * n, 0.0);
        let block = &mut out[start..];
        for &j in &pattern.observed {
            let (row, weighted) = (self.emission.row(j), self.weighted_emission.row(j));
            for (out_row, &factor) in block.chunks_exact_mut(n).zip(&row) {
                for (o, &w) in out_row.iter_mut().zip(&weighted) {
                    *o += factor * w;
                }
            }
        }
        kernel::symmetrize(block, n);
    }

    /// `Gᵀ Σ⁻¹ G`.
    pub(crate) fn add_complete_information(&self, out: &mut Vec<f64>) {
        let start = out.len();
        out.extend(self.emission.t().dot(&self.weighted_emission).iter());
        kernel::symmetrize(&mut out[start..], self.n);
    }
}
