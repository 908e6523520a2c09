//! Where EM starts from.

use ndarray::{Array1, Array2, ArrayView2, Axis, s};
use ndarray_linalg::{JobSvd, SVDDC};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use crate::{
    covariance::Covariance,
    error::LdsError,
    model::{LdsModel, LdsParts, normal_vector},
    statistics::{NoiseStructure, solve_symmetric},
};

/// How the first model is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Start {
    /// Standard normal numbers, added to the identity in transition and emission; unit
    /// covariances. `BoLeRO` as published starts so.
    Random,
    /// The leading right singular vectors of the interpolated data as emission, and the
    /// least-squares transition of the projections on them. Uses no random number.
    #[default]
    Subspace,
}

/// The first model for data `(T, m)` without missing entries.
pub(crate) fn first_model(
    start: Start,
    data: ArrayView2<'_, f64>,
    hidden: usize,
    seed: u64,
    structure: &NoiseStructure,
) -> Result<LdsModel, LdsError> {
    match start {
        Start::Random => random(data.ncols(), hidden, seed),
        Start::Subspace => subspace(data, hidden, structure),
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
        initial_mean: normal_vector(hidden, &mut rng),
        initial_covariance: Covariance::Isotropic(1.0),
    })
}

fn subspace(
    data: ArrayView2<'_, f64>,
    hidden: usize,
    structure: &NoiseStructure,
) -> Result<LdsModel, LdsError> {
    let broken = LdsError::Breakdown { iteration: 1 };
    let (frames, dimensions) = data.dim();
    let (_, _, directions) = data.to_owned().svddc(JobSvd::Some).map_err(|_| broken.clone())?;
    let directions = directions.ok_or(broken.clone())?;
    // Fewer frames than hidden dimensions leave columns that the data say nothing about: zero.
    let rank = hidden.min(directions.nrows());
    let mut emission = Array2::zeros((dimensions, hidden));
    emission.slice_mut(s![.., ..rank]).assign(&directions.slice(s![..rank, ..]).t());
    let states = data.dot(&emission);
    let (later, earlier) = (states.slice(s![1.., ..]), states.slice(s![..frames - 1, ..]));
    let mut moment = earlier.t().dot(&earlier);
    let scale = moment.diag().iter().fold(structure.variance_floor, |a, x| a.max(*x));
    // The ridge is what rounding does to the moment anyway; it decides only empty directions.
    moment.diag_mut().mapv_inplace(|x| x + 1e-12 * scale);
    let transition = solve_symmetric(&moment, &later.t().dot(&earlier)).ok_or(broken.clone())?;
    let state_error = &later - &earlier.dot(&transition.t());
    let data_error = &data - &states.dot(&emission.t());
    let floor = structure.variance_floor;
    let moments = |error: &Array2<f64>| error.mapv(|x| x * x).sum_axis(Axis(0));
    let mean_of = |error: &Array2<f64>| Array2::from_diag(&(moments(error) / error.nrows() as f64));
    let state_noise =
        Covariance::fit(structure.state, &mean_of(&state_error), floor).ok_or(broken.clone())?;
    let observation_noise =
        Covariance::fit(structure.observation, &mean_of(&data_error), floor).ok_or(broken)?;
    // One mean step of uncertainty about where the take begins.
    let step: Array1<f64> = moments(&(&later - &earlier)) / (frames - 1) as f64;
    let variance = (step.sum() / hidden as f64).max(floor);
    LdsModel::new(LdsParts {
        transition,
        emission,
        state_noise,
        observation_noise,
        initial_mean: states.row(0).to_owned(),
        initial_covariance: Covariance::Isotropic(variance),
    })
}
