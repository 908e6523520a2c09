//! Where EM starts from.

use ndarray::{Array1, Array2};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use crate::{
    covariance::Covariance,
    error::LdsError,
    model::{LdsModel, LdsParts, normal_vector},
    observations::Observations,
    statistics::NoiseStructure,
    subspace::subspace,
};

/// How the first model is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Start {
    /// Standard normal numbers, added to the identity in transition and emission; unit
    /// covariances. `BoLeRO` as published starts so.
    Random,
    /// From what is seen, without a random number: states are the coordinates along the leading
    /// directions of the dimensions that miss least, every dimension is regressed on them over the
    /// frames that show it, and so is every state on the states of the frame before. What fills a gap
    /// at first has no part in it.
    ///
    /// Where frames show fewer entries than there are hidden dimensions, half of these are the
    /// velocities of the other half, and move steadily: through such frames only a pace can lead.
    #[default]
    Subspace,
}

/// The first model for observations.
pub(crate) fn first_model(
    start: Start,
    observations: &Observations,
    hidden: usize,
    seed: u64,
    structure: &NoiseStructure,
) -> Result<LdsModel, LdsError> {
    match start {
        Start::Random => random(observations.dimensions(), hidden, seed),
        Start::Subspace => subspace(observations, hidden, structure),
    }
}

fn random(dimensions: usize, hidden: usize, seed: u64) -> Result<LdsModel, LdsError> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut near_identity = |rows: usize| {
        let noise = normal_vector(rows * hidden, &mut rng);
        Array2::from_shape_fn((rows, hidden), |(i, j)| {
            noise[i * hidden + j] + f64::from(u8::from(i == j))
        })
    };
    let transition = near_identity(hidden);
    let emission = near_identity(dimensions);
    LdsModel::new(LdsParts {
        transition,
        emission,
        state_noise: Covariance::Isotropic(1.0),
        observation_noise: Covariance::Isotropic(1.0),
        initial_mean: Array1::from(normal_vector(hidden, &mut rng).to_vec()),
        initial_covariance: Covariance::Isotropic(1.0),
    })
}
