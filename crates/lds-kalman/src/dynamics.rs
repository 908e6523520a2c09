//! A model laid out for the recursions: flat row-major slices and the precision-weighted emission.

use ndarray::{Array1, Array2, Axis};

use crate::{kernel, model::LdsModel, panel};

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
    /// `Gᵀ`, `(H, m)`.
    pub(crate) emission_transposed: Vec<f64>,
    /// `Σ⁻¹ G`, `(m, H)`.
    pub(crate) weighted_emission: Vec<f64>,
    pub(crate) noise: Array1<f64>,
}

impl Dynamics {
    pub(crate) fn new(model: &LdsModel) -> Self {
        let n = model.hidden();
        let emission = model.emission().as_standard_layout().into_owned();
        let noise = model.observation_noise().variances(model.dimensions());
        let weighted_emission = &emission / &noise.view().insert_axis(Axis(1));
        let emission_transposed = emission.t().iter().copied().collect();
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
            emission_transposed,
            weighted_emission: weighted_emission.iter().copied().collect(),
            noise,
        }
    }

    /// `Gᵀ Σ⁻¹ W G`, the information that a frame which observes these dimensions adds about the
    /// state.
    pub(crate) fn add_information(&self, observed: &[usize], out: &mut Vec<f64>) {
        let (n, start) = (self.n, out.len());
        out.resize(start + n * n, 0.0);
        let gather = |flat: &[f64]| -> Vec<f64> {
            observed.iter().flat_map(|&j| &flat[j * n..(j + 1) * n]).copied().collect()
        };
        let emission = self.emission.as_slice().expect("made in standard layout");
        let block = &mut out[start..];
        panel::correlate(&gather(emission), n, &gather(&self.weighted_emission), n, block);
        kernel::symmetrize(block, n);
    }
}
