//! The expected sufficient statistics of an E-step and the M-step they determine.

use ndarray::{Array1, Array2, ArrayView2, Axis};

use crate::{
    covariance::{Covariance, CovarianceStructure},
    dynamics::Dynamics,
    error::LdsError,
    inference::{EStep, Inference},
    kernel,
    missing::MissingEntries,
    model::{LdsModel, LdsParts},
    observations::Observations,
    smoother::check_dimensions,
};

/// What the M-step needs to know about the hidden states and the missing entries.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    frames: usize,
    /// `Σ E[z zᵀ]`, `(H, H)`.
    states: Array2<f64>,
    /// `Σ E[z[t+1] z[t]ᵀ]`, `(H, H)`.
    lag_one: Array2<f64>,
    /// `Σ E[x zᵀ]`, `(m, H)`.
    cross: Array2<f64>,
    /// `Σ E[x²]`, `(m)`.
    squares: Array1<f64>,
    first_mean: Array1<f64>,
    first_covariance: Array2<f64>,
    /// `E[z zᵀ]` of the last frame, `(H, H)`.
    last: Array2<f64>,
}

/// The form each covariance is restricted to, and the smallest variance it may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseStructure {
    /// Of the state noise. `BoLeRO` as published: isotropic.
    pub state: CovarianceStructure,
    /// Of the observation noise; isotropic or diagonal. `BoLeRO` as published: isotropic.
    pub observation: CovarianceStructure,
    /// Of the first state. `BoLeRO` as published: isotropic.
    pub initial: CovarianceStructure,
    /// No variance is learnt below this; positive, in the squared unit of the data.
    pub variance_floor: f64,
}

impl Default for NoiseStructure {
    fn default() -> Self {
        Self {
            state: CovarianceStructure::Isotropic,
            observation: CovarianceStructure::Isotropic,
            initial: CovarianceStructure::Isotropic,
            variance_floor: 1e-10,
        }
    }
}

impl NoiseStructure {
    pub(crate) fn validate(&self) -> Result<(), LdsError> {
        if self.observation == CovarianceStructure::Full {
            return Err(LdsError::FullObservationNoise);
        }
        if self.variance_floor.is_finite() && self.variance_floor > 0.0 {
            return Ok(());
        }
        Err(LdsError::Parameter {
            field: "variance_floor",
            value: self.variance_floor,
            allowed: "a positive finite number",
        })
    }
}

/// The exact expected statistics of states and missing entries given what was observed.
///
/// # Errors
///
/// When observations and model differ in dimension, or the recursion breaks down numerically.
pub fn e_step(model: &LdsModel, observations: &Observations) -> Result<Statistics, LdsError> {
    check_dimensions(model, observations.values())?;
    let dynamics = Dynamics::new(model);
    let mut pass = Inference::new(observations, model.hidden(), EStep::Exact);
    pass.run(&dynamics, observations, observations.values())
        .ok_or(LdsError::Breakdown { iteration: 1 })?;
    let mut filled = Array2::zeros(observations.values().dim());
    pass.predict(&dynamics, observations.gap_frames(), &mut filled);
    let mut data = observations.values().to_owned();
    MissingEntries::new(observations, data.view_mut()).fill_from(filled.view());
    Ok(gather(&pass, &dynamics, observations, data.view()))
}

/// The model that maximises the expected complete log-likelihood under the given structure.
///
/// # Errors
///
/// When the structure is not allowed, there is only one frame, or the statistics are numerically
/// degenerate.
///
/// Implements [Li10] Eq. (31), (32), (33), (35) and (36).
/// Deviates from [Li10] Eq. (34): its last term prints the lag-one moment where the moment of the
/// earlier state belongs.
pub fn m_step(statistics: &Statistics, structure: &NoiseStructure) -> Result<LdsModel, LdsError> {
    structure.validate()?;
    if statistics.frames < 2 {
        return Err(LdsError::TooFewFrames { frames: statistics.frames, needed: 2 });
    }
    maximize(statistics, structure).ok_or(LdsError::NotPositiveDefinite { what: "state moment" })
}

/// Collects the statistics of a finished pass. Under the exact E-step the variance of missing
/// entries is added; otherwise the fills count as data, as published.
pub(crate) fn gather(
    pass: &Inference,
    dynamics: &Dynamics,
    observations: &Observations,
    filled: ArrayView2<'_, f64>,
) -> Statistics {
    let n = dynamics.n;
    let frames = observations.frames();
    let (states, lag_one) = pass.second_moments();
    let mut cross = pass.cross_moment(filled);
    let mut squares = observations.squares_with(filled);
    if pass.e_step() == EStep::Exact {
        for group in observations.gap_groups() {
            let mut sum = vec![0.0; n * n];
            pass.backward.add_covariances(group.frames.iter().copied(), &mut sum);
            let mut spread = vec![0.0; n];
            for &j in &group.dimensions {
                let emission = dynamics.emission.row(j).to_vec();
                kernel::apply(&sum, &emission, &mut spread, n);
                squares[j] +=
                    kernel::dot(&emission, &spread) + group.frames.len() as f64 * dynamics.noise[j];
                cross.row_mut(j).iter_mut().zip(&spread).for_each(|(c, s)| *c += s);
            }
        }
    }
    let matrix = |flat: &[f64]| Array2::from_shape_fn((n, n), |(i, j)| flat[i * n + j]);
    let last_mean = pass.smoothed.row(frames - 1).insert_axis(Axis(0));
    Statistics {
        frames,
        states,
        lag_one,
        cross,
        squares,
        first_mean: pass.smoothed.row(0).to_owned(),
        first_covariance: matrix(pass.backward.covariance(0)),
        last: last_mean.t().dot(&last_mean) + matrix(pass.backward.covariance(frames - 1)),
    }
}

/// The M-step; nothing when a moment matrix has no Cholesky factor or an entry is not finite.
pub(crate) fn maximize(statistics: &Statistics, structure: &NoiseStructure) -> Option<LdsModel> {
    let Statistics { frames, states, lag_one, cross, squares, first_mean, first_covariance, last } =
        statistics;
    let first = outer(first_mean) + first_covariance;
    let earlier = states - last;
    let later = states - &first;
    let transition = solve_symmetric(&earlier, lag_one)?;
    let emission = solve_symmetric(states, cross)?;
    let explained = lag_one.dot(&transition.t());
    let state_moment = (&later - &explained - explained.t()
        + transition.dot(&earlier).dot(&transition.t()))
        / (frames - 1) as f64;
    let spread = emission.dot(states);
    let mut noise = squares.clone();
    ndarray::Zip::from(&mut noise)
        .and(emission.rows())
        .and(cross.rows())
        .and(spread.rows())
        .for_each(|r, g, c, s| *r = (*r - 2.0 * g.dot(&c) + g.dot(&s)) / *frames as f64);
    let floor = structure.variance_floor;
    LdsModel::new(LdsParts {
        transition,
        emission,
        state_noise: Covariance::fit(structure.state, &state_moment, floor)?,
        observation_noise: observation_noise(structure, noise)?,
        initial_mean: first_mean.clone(),
        initial_covariance: Covariance::fit(structure.initial, first_covariance, floor)?,
    })
    .ok()
}

fn observation_noise(structure: &NoiseStructure, variances: Array1<f64>) -> Option<Covariance> {
    let floor = structure.variance_floor;
    if !variances.iter().all(|v| v.is_finite()) {
        return None;
    }
    Some(match structure.observation {
        CovarianceStructure::Isotropic => {
            Covariance::Isotropic((variances.sum() / variances.len() as f64).max(floor))
        }
        _ => Covariance::Diagonal(variances.mapv(|v| v.max(floor))),
    })
}

fn outer(vector: &Array1<f64>) -> Array2<f64> {
    let column = vector.view().insert_axis(Axis(1));
    column.dot(&column.t())
}

/// `right · left⁻¹` for a symmetric positive definite `left`.
pub(crate) fn solve_symmetric(left: &Array2<f64>, right: &Array2<f64>) -> Option<Array2<f64>> {
    let (rows, n) = right.dim();
    let mut symmetric: Vec<f64> = left.iter().copied().collect();
    kernel::symmetrize(&mut symmetric, n);
    let mut solution: Vec<f64> = right.t().iter().copied().collect();
    kernel::fast(n, Solve { symmetric, solution: &mut solution, rows }).then_some(())?;
    let transposed = Array2::from_shape_vec((n, rows), solution).ok()?;
    Some(transposed.t().as_standard_layout().into_owned())
}

/// Solves for the right-hand sides in the columns of `solution`; `false` without a Cholesky factor.
struct Solve<'a> {
    symmetric: Vec<f64>,
    solution: &'a mut [f64],
    rows: usize,
}

impl kernel::Job for Solve<'_> {
    type Output = bool;

    #[allow(clippy::inline_always, reason = "the job takes on the vectors of its caller")]
    #[inline(always)]
    fn run(self, n: usize) -> bool {
        let mut factor = vec![0.0; n * n];
        let found = kernel::cholesky(&self.symmetric, &mut factor, n);
        if found {
            kernel::solve_cholesky(&factor, self.solution, n, self.rows);
        }
        found
    }
}
