//! The linear dynamical system itself.

use ndarray::{Array1, Array2, ArrayView1, ArrayView2};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use crate::{covariance::Covariance, error::LdsError};

/// A linear dynamical system with Gaussian noise.
///
/// | symbol | here | meaning |
/// |---|---|---|
/// | `F` | transition, `(H, H)` | `z[t+1] = F z[t] + noise` |
/// | `G` | emission, `(m, H)` | `x[t] = G z[t] + noise` |
/// | `Λ` | state noise | covariance of the first noise |
/// | `Σ` | observation noise | covariance of the second noise |
/// | `μ₀`, `Γ` | initial mean `(H)` and covariance | distribution of the first state |
///
/// `H` is the number of hidden dimensions, `m` the number of observed ones.
///
/// Implements [Li10] Eq. (1), (2), (3) and (4).
#[derive(Debug, Clone, PartialEq)]
pub struct LdsModel {
    transition: Array2<f64>,
    emission: Array2<f64>,
    state_noise: Covariance,
    observation_noise: Covariance,
    initial_mean: Array1<f64>,
    initial_covariance: Covariance,
}

/// The parts of an [`LdsModel`], to be checked by [`LdsModel::new`].
#[derive(Debug, Clone, PartialEq)]
pub struct LdsParts {
    /// `(H, H)`.
    pub transition: Array2<f64>,
    /// `(m, H)`.
    pub emission: Array2<f64>,
    /// Covariance of the state noise, positive definite.
    pub state_noise: Covariance,
    /// Covariance of the observation noise, isotropic or diagonal.
    pub observation_noise: Covariance,
    /// `(H)`.
    pub initial_mean: Array1<f64>,
    /// Covariance of the first state, positive definite.
    pub initial_covariance: Covariance,
}

/// A draw from a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Hidden states, `(T, H)`.
    pub states: Array2<f64>,
    /// Observations, `(T, m)`.
    pub observations: Array2<f64>,
}

impl LdsModel {
    /// Checks the parts and makes a model of them.
    ///
    /// # Errors
    ///
    /// When shapes disagree, an entry is not finite, a covariance is not symmetric positive
    /// definite, or the observation noise is full.
    pub fn new(parts: LdsParts) -> Result<Self, LdsError> {
        let (dimensions, hidden) = parts.emission.dim();
        for (what, size) in
            [("the hidden dimension", hidden), ("the observed dimension", dimensions)]
        {
            if size == 0 {
                return Err(LdsError::ZeroDimension { what });
            }
        }
        check_matrix("transition", parts.transition.view(), hidden, hidden)?;
        check_matrix("emission", parts.emission.view(), dimensions, hidden)?;
        let mean = parts.initial_mean.view().insert_axis(ndarray::Axis(0));
        check_matrix("initial mean", mean, 1, hidden)?;
        parts.state_noise.validate("state noise", hidden)?;
        parts.initial_covariance.validate("initial covariance", hidden)?;
        if matches!(parts.observation_noise, Covariance::Full(_)) {
            return Err(LdsError::FullObservationNoise);
        }
        parts.observation_noise.validate("observation noise", dimensions)?;
        let LdsParts {
            transition,
            emission,
            state_noise,
            observation_noise,
            initial_mean,
            initial_covariance,
        } = parts;
        Ok(Self {
            transition,
            emission,
            state_noise,
            observation_noise,
            initial_mean,
            initial_covariance,
        })
    }

    /// Number of hidden dimensions, `H`.
    #[must_use]
    pub fn hidden(&self) -> usize {
        self.emission.ncols()
    }

    /// Number of observed dimensions, `m`.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        self.emission.nrows()
    }

    /// The transition, `(H, H)`.
    #[must_use]
    pub fn transition(&self) -> ArrayView2<'_, f64> {
        self.transition.view()
    }

    /// The emission, `(m, H)`.
    #[must_use]
    pub fn emission(&self) -> ArrayView2<'_, f64> {
        self.emission.view()
    }

    /// The covariance of the state noise.
    #[must_use]
    pub fn state_noise(&self) -> &Covariance {
        &self.state_noise
    }

    /// The covariance of the observation noise, isotropic or diagonal.
    #[must_use]
    pub fn observation_noise(&self) -> &Covariance {
        &self.observation_noise
    }

    /// The mean of the first state, `(H)`.
    #[must_use]
    pub fn initial_mean(&self) -> ArrayView1<'_, f64> {
        self.initial_mean.view()
    }

    /// The covariance of the first state.
    #[must_use]
    pub fn initial_covariance(&self) -> &Covariance {
        &self.initial_covariance
    }

    /// The observations a path of states predicts: `(T, H)` to `(T, m)`.
    ///
    /// # Errors
    ///
    /// When the states do not have `H` columns.
    pub fn predict(&self, states: ArrayView2<'_, f64>) -> Result<Array2<f64>, LdsError> {
        check_shape("states", states, states.nrows(), self.hidden())?;
        Ok(states.dot(&self.emission.t()))
    }

    /// Draws a path of `frames` states and observations; the same seed gives the same draw.
    ///
    /// # Errors
    ///
    /// When a covariance has no numerical Cholesky factor.
    pub fn sample(&self, frames: usize, seed: u64) -> Result<Sample, LdsError> {
        let (hidden, dimensions) = (self.hidden(), self.dimensions());
        let factor = |covariance: &Covariance, what, n| {
            covariance.factor(n).ok_or(LdsError::NotPositiveDefinite { what })
        };
        let state_factor = factor(&self.state_noise, "state noise", hidden)?;
        let initial_factor = factor(&self.initial_covariance, "initial covariance", hidden)?;
        let deviations = self.observation_noise.variances(dimensions).mapv(f64::sqrt);
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut states = Array2::zeros((frames, hidden));
        let mut observations = Array2::zeros((frames, dimensions));
        let mut state = Array1::zeros(hidden);
        for t in 0..frames {
            let noise = normal_vector(hidden, &mut rng);
            state = if t == 0 {
                &self.initial_mean + &initial_factor.dot(&noise)
            } else {
                self.transition.dot(&state) + state_factor.dot(&noise)
            };
            let error = &deviations * &normal_vector(dimensions, &mut rng);
            observations.row_mut(t).assign(&(self.emission.dot(&state) + error));
            states.row_mut(t).assign(&state);
        }
        Ok(Sample { states, observations })
    }
}

/// Independent standard normal numbers.
pub(crate) fn normal_vector(n: usize, rng: &mut ChaCha8Rng) -> Array1<f64> {
    Array1::from_iter((0..n).map(|_| -> f64 { StandardNormal.sample(rng) }))
}

fn check_shape(
    what: &'static str,
    matrix: ArrayView2<'_, f64>,
    rows: usize,
    columns: usize,
) -> Result<(), LdsError> {
    let (found_rows, found_columns) = matrix.dim();
    if (found_rows, found_columns) == (rows, columns) {
        return Ok(());
    }
    Err(LdsError::Shape { what, rows, columns, found_rows, found_columns })
}

fn check_matrix(
    what: &'static str,
    matrix: ArrayView2<'_, f64>,
    rows: usize,
    columns: usize,
) -> Result<(), LdsError> {
    check_shape(what, matrix, rows, columns)?;
    match matrix.indexed_iter().find(|(_, x)| !x.is_finite()) {
        Some(((row, column), _)) => Err(LdsError::NotFinite { what, row, column }),
        None => Ok(()),
    }
}
