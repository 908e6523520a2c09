//! The filter and the smoother as functions of a model and observations.

use ndarray::{Array2, Array3, ArrayView2};

use crate::{
    dynamics::Dynamics,
    error::LdsError,
    inference::{EStep, Inference},
    model::LdsModel,
    observations::Observations,
};

/// States given the frames up to each.
#[derive(Debug, Clone, PartialEq)]
pub struct Filtered {
    /// Means given the frames up to and including each, `(T, H)`.
    pub mean: Array2<f64>,
    /// Their covariances, `(T, H, H)`.
    pub covariance: Array3<f64>,
    /// Means given the frames before each, `(T, H)`.
    pub predicted_mean: Array2<f64>,
    /// Their covariances, `(T, H, H)`.
    pub predicted_covariance: Array3<f64>,
    /// Log-likelihood of the observed entries.
    pub log_likelihood: f64,
}

/// States given all frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    /// Means, `(T, H)`.
    pub mean: Array2<f64>,
    /// Covariances, `(T, H, H)`.
    pub covariance: Array3<f64>,
    /// Covariances of the state of frame `t + 1` with that of frame `t`, `(T − 1, H, H)`.
    pub lag_one: Array3<f64>,
    /// Log-likelihood of the observed entries.
    pub log_likelihood: f64,
}

/// Estimates the state of each frame from the frames up to it.
///
/// Missing entries are dropped, so the result is exact for any mask.
///
/// # Errors
///
/// When observations and model differ in dimension, or the recursion breaks down numerically.
///
/// Implements [Li10] Eq. (14) to (22) for the entries that are observed.
pub fn filter(model: &LdsModel, observations: &Observations) -> Result<Filtered, LdsError> {
    let (mut pass, dynamics) = prepare(model, observations)?;
    let log_likelihood = pass
        .filter(&dynamics, observations, observations.values())
        .ok_or(LdsError::Breakdown { iteration: 1 })?;
    let (frames, n) = pass.filtered.dim();
    let steps = pass.forward.step_of();
    let covariance = stack(frames, n, |t| pass.forward.filtered(steps[t]));
    let predicted_covariance = stack(frames, n, |t| pass.forward.predicted_at(t, &dynamics));
    Ok(Filtered {
        mean: pass.filtered,
        covariance,
        predicted_mean: pass.predicted,
        predicted_covariance,
        log_likelihood,
    })
}

/// Estimates the state of each frame from all frames.
///
/// Missing entries are dropped, so the result is exact for any mask.
///
/// # Errors
///
/// When observations and model differ in dimension, or the recursion breaks down numerically.
///
/// Implements [Li10] Eq. (24) to (28) for the entries that are observed.
pub fn smooth(model: &LdsModel, observations: &Observations) -> Result<Smoothed, LdsError> {
    let (mut pass, dynamics) = prepare(model, observations)?;
    let log_likelihood = pass
        .run(&dynamics, observations, observations.values())
        .ok_or(LdsError::Breakdown { iteration: 1 })?;
    let (frames, n) = pass.smoothed.dim();
    let covariance = stack(frames, n, |t| pass.backward.covariance(t));
    let lag_one = stack(frames - 1, n, |t| pass.backward.lag_one(t));
    Ok(Smoothed { mean: pass.smoothed, covariance, lag_one, log_likelihood })
}

fn prepare(
    model: &LdsModel,
    observations: &Observations,
) -> Result<(Inference, Dynamics), LdsError> {
    check_dimensions(model, observations.values())?;
    Ok((Inference::new(observations, model.hidden(), EStep::Exact), Dynamics::new(model)))
}

/// Checks that a matrix `(T, m)` has the columns of the model.
pub(crate) fn check_dimensions(
    model: &LdsModel,
    values: ArrayView2<'_, f64>,
) -> Result<(), LdsError> {
    if values.ncols() == model.dimensions() {
        return Ok(());
    }
    Err(LdsError::Shape {
        what: "observations",
        rows: values.nrows(),
        columns: model.dimensions(),
        found_rows: values.nrows(),
        found_columns: values.ncols(),
    })
}

fn stack<'a>(frames: usize, n: usize, block: impl Fn(usize) -> &'a [f64]) -> Array3<f64> {
    let mut out = Array3::zeros((frames, n, n));
    for (t, mut slot) in out.outer_iter_mut().enumerate() {
        slot.iter_mut().zip(block(t)).for_each(|(o, x)| *o = *x);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Covariance, LdsParts};
    use ndarray::array;

    #[test]
    fn sharing_stationary_covariances_changes_nothing_in_the_first_ten_digits() {
        let model = LdsModel::new(LdsParts {
            transition: array![[0.99, 0.1, 0.0], [0.0, 0.95, 0.1], [0.0, -0.1, 0.9]],
            emission: array![[1.0, 0.0, 0.3], [0.0, 1.0, 0.0], [0.5, 0.2, 1.0], [0.1, 0.0, 0.7]],
            state_noise: Covariance::Isotropic(0.1),
            observation_noise: Covariance::Isotropic(0.3),
            initial_mean: array![1.0, 0.0, -1.0],
            initial_covariance: Covariance::Isotropic(2.0),
        })
        .unwrap();
        let data = model.sample(400, 3).unwrap().observations;
        let mask = Array2::from_shape_fn((400, 4), |(t, j)| !(j < 2 && (150..260).contains(&t)));
        let observations = Observations::new(data.view(), mask.view()).unwrap();
        let run = |tolerance: f64| {
            let (mut pass, dynamics) = prepare(&model, &observations).unwrap();
            pass.set_stationary(tolerance);
            let value = pass.run(&dynamics, &observations, observations.values()).unwrap();
            let steps = pass.forward.step_of().iter().max().unwrap() + 1;
            (pass, value, steps)
        };
        let (shared, shared_value, shared_steps) = run(STATIONARY_FOR_TEST);
        let (full, full_value, full_steps) = run(-1.0);
        assert_eq!(full_steps, 400);
        assert!(shared_steps < 200, "{shared_steps} covariance steps");
        let scale = full.smoothed.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let apart = (&shared.smoothed - &full.smoothed).iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        // 1e-10: the promise made where the tolerance is defined.
        assert!(apart <= 1e-10 * scale, "{apart}");
        assert!((shared_value - full_value).abs() <= 1e-10 * full_value.abs());
        for t in 0..400 {
            let (size, change) = crate::kernel::magnitude_and_change(
                full.backward.covariance(t),
                shared.backward.covariance(t),
            );
            assert!(change <= 1e-10 * size, "frame {t}: {change}");
        }
    }

    const STATIONARY_FOR_TEST: f64 = crate::forward::STATIONARY;
}
