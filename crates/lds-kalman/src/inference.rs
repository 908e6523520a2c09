//! Filter and smoother over the values, with buffers that are reused from one pass to the next.

use std::f64::consts::TAU;

use ndarray::{Array2, ArrayView2, linalg::general_mat_mul, s};

use crate::{
    backward::Backward,
    dynamics::Dynamics,
    forward::{Forward, STATIONARY},
    kernel,
    observations::Observations,
};

/// How missing entries are treated when the hidden states are estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum EStep {
    /// Missing entries are dropped: the exact posterior given what was observed.
    #[default]
    Exact,
    /// The present fill of a missing entry counts as if it had been observed. `BoLeRO` as
    /// published does this, and keeps the interpolation through the first iteration.
    ///
    /// Deviates from [Li10] Eq. (17): the formula is applied to filled values.
    FilledAsObserved,
    /// In the filter a missing entry takes its own prediction, so that its innovation is zero,
    /// while gain and covariance treat it as observed. `DynaMMo` as published does this.
    ///
    /// Deviates from [Li10] Eq. (17): the innovation of a missing entry is set to zero.
    Dynammo,
}

/// Buffers and results of a pass.
#[derive(Debug)]
pub(crate) struct Inference {
    e_step: EStep,
    frames: usize,
    n: usize,
    /// Tolerance of the stationarity test.
    stationary: f64,
    information: Vec<f64>,
    /// Information block that a frame adds to the mean.
    mean_pattern: Vec<usize>,
    /// Information block that a frame adds to the covariance.
    covariance_pattern: Vec<usize>,
    pub(crate) forward: Forward,
    pub(crate) backward: Backward,
    weighted: Array2<f64>,
    pub(crate) predicted: Array2<f64>,
    pub(crate) filtered: Array2<f64>,
    pub(crate) smoothed: Array2<f64>,
    residual: Array2<f64>,
}

impl Inference {
    pub(crate) fn new(observations: &Observations, n: usize, e_step: EStep) -> Self {
        let (frames, m) = observations.values().dim();
        let complete = vec![observations.patterns().len(); frames];
        let by_mask = observations.pattern_of().to_vec();
        let (mean_pattern, covariance_pattern) = match e_step {
            EStep::Exact => (by_mask.clone(), by_mask),
            EStep::FilledAsObserved => (complete.clone(), complete),
            EStep::Dynammo => (by_mask, complete),
        };
        let states = || Array2::zeros((frames, n));
        Self {
            e_step,
            frames,
            n,
            stationary: STATIONARY,
            information: Vec::new(),
            mean_pattern,
            covariance_pattern,
            forward: Forward::default(),
            backward: Backward::default(),
            weighted: states(),
            predicted: states(),
            filtered: states(),
            smoothed: states(),
            residual: Array2::zeros((frames, m)),
        }
    }

    pub(crate) fn e_step(&self) -> EStep {
        self.e_step
    }

    /// Filters and smooths; the log-likelihood, or nothing when the recursion breaks down.
    pub(crate) fn run(
        &mut self,
        dynamics: &Dynamics,
        observations: &Observations,
        filled: ArrayView2<'_, f64>,
    ) -> Option<f64> {
        let log_likelihood = self.filter(dynamics, observations, filled)?;
        self.backward.run(self.n, &self.forward, self.stationary);
        kernel::fast(self.n, SmoothMeans { pass: self });
        self.smoothed.iter().all(|x| x.is_finite()).then_some(log_likelihood)
    }

    /// Filters; the log-likelihood, or nothing when the recursion breaks down.
    pub(crate) fn filter(
        &mut self,
        dynamics: &Dynamics,
        observations: &Observations,
        filled: ArrayView2<'_, f64>,
    ) -> Option<f64> {
        let values = match self.e_step {
            EStep::FilledAsObserved => filled,
            EStep::Exact | EStep::Dynammo => observations.values(),
        };
        self.gather_information(dynamics, observations);
        let Self { forward, information, covariance_pattern, stationary, .. } = self;
        forward.run(dynamics, information, covariance_pattern, *stationary).then_some(())?;
        general_mat_mul(1.0, &values, &dynamics.weighted_emission, 0.0, &mut self.weighted);
        let explained = kernel::fast(self.n, FilterMeans { pass: self, dynamics });
        let log_likelihood = self.log_likelihood(dynamics, observations, values, explained);
        log_likelihood.is_finite().then_some(log_likelihood)
    }

    fn gather_information(&mut self, dynamics: &Dynamics, observations: &Observations) {
        self.information.clear();
        for pattern in observations.patterns() {
            dynamics.add_information(pattern, &mut self.information);
        }
        dynamics.add_complete_information(&mut self.information);
    }

    /// The log-likelihood from the innovations, with what the states explain taken off.
    fn log_likelihood(
        &mut self,
        dynamics: &Dynamics,
        observations: &Observations,
        values: ArrayView2<'_, f64>,
        explained: f64,
    ) -> f64 {
        self.residual.assign(&values);
        general_mat_mul(-1.0, &self.predicted, &dynamics.emission.t(), 1.0, &mut self.residual);
        let precision = dynamics.noise.mapv(f64::recip).to_vec();
        let log_noise = dynamics.noise.mapv(|r| (TAU * r).ln()).to_vec();
        let m = precision.len();
        let all_count = self.e_step != EStep::Exact;
        let all_seen = self.e_step == EStep::FilledAsObserved;
        let total_log_noise: f64 = log_noise.iter().sum();
        let mut sum = -explained;
        let rows = flat(&self.residual).chunks_exact(m);
        for ((row, &pattern), &step) in
            rows.zip(observations.pattern_of()).zip(self.forward.step_of())
        {
            let pattern = &observations.patterns()[pattern];
            sum += self.forward.log_determinant(step);
            sum += if all_seen || pattern.complete {
                row.iter().zip(&precision).map(|(e, p)| e * e * p).sum::<f64>()
            } else {
                pattern.observed.iter().map(|&j| row[j] * row[j] * precision[j]).sum()
            };
            sum += if all_count || pattern.complete {
                total_log_noise
            } else {
                pattern.observed.iter().map(|&j| log_noise[j]).sum()
            };
        }
        -0.5 * sum
    }

    /// `G E[z]`, `(T, m)`, into `out`.
    pub(crate) fn predict(&self, dynamics: &Dynamics, out: &mut Array2<f64>) {
        general_mat_mul(1.0, &self.smoothed, &dynamics.emission.t(), 0.0, out);
    }

    /// `Σ E[z zᵀ]` and `Σ E[z[t+1] z[t]ᵀ]`.
    pub(crate) fn second_moments(&self) -> (Array2<f64>, Array2<f64>) {
        let last = self.frames - 1;
        let mut same = self.smoothed.t().dot(&self.smoothed).as_standard_layout().into_owned();
        self.backward.add_covariances(0..self.frames, flat_mut(&mut same));
        let (later, earlier) =
            (self.smoothed.slice(s![1.., ..]), self.smoothed.slice(s![..last, ..]));
        let mut lag = later.t().dot(&earlier).as_standard_layout().into_owned();
        self.backward.add_lag_ones(0..last, flat_mut(&mut lag));
        (same, lag)
    }

    #[cfg(test)]
    pub(crate) fn set_stationary(&mut self, tolerance: f64) {
        self.stationary = tolerance;
    }
}

fn flat(array: &Array2<f64>) -> &[f64] {
    array.as_slice().expect("buffers are made in standard layout")
}

fn flat_mut(array: &mut Array2<f64>) -> &mut [f64] {
    array.as_slice_mut().expect("buffers are made in standard layout")
}

/// The means of the filter; answers the part of the squared innovations that the states explain.
///
/// Implements [Li10] Eq. (17) and (21) in the information form.
struct FilterMeans<'a> {
    pass: &'a mut Inference,
    dynamics: &'a Dynamics,
}

impl kernel::Job for FilterMeans<'_> {
    type Output = f64;

    #[allow(clippy::inline_always, reason = "the job takes on the vectors of its caller")]
    #[inline(always)]
    fn run(self, n: usize) -> f64 {
        let Self { pass, dynamics } = self;
        let size = n * n;
        let (mut innovation, mut correction) = (vec![0.0; n], vec![0.0; n]);
        let mut explained = 0.0;
        let weighted = flat(&pass.weighted);
        let predicted = flat_mut(&mut pass.predicted);
        let filtered = flat_mut(&mut pass.filtered);
        for t in 0..pass.frames {
            let now = t * n..(t + 1) * n;
            let prediction = &mut predicted[now.clone()];
            if t == 0 {
                prediction.copy_from_slice(&dynamics.initial_mean);
            } else {
                let before = &filtered[(t - 1) * n..t * n];
                kernel::apply(&dynamics.transition_transposed, before, prediction, n);
            }
            let information = &pass.information[pass.mean_pattern[t] * size..][..size];
            kernel::apply(information, prediction, &mut innovation, n);
            innovation.iter_mut().zip(&weighted[now.clone()]).for_each(|(i, b)| *i = b - *i);
            let covariance = pass.forward.filtered(pass.forward.step_of()[t]);
            kernel::apply(covariance, &innovation, &mut correction, n);
            explained += kernel::dot(&innovation, &correction);
            for ((f, p), c) in filtered[now].iter_mut().zip(prediction).zip(&correction) {
                *f = *p + c;
            }
        }
        explained
    }
}

/// The means of the smoother.
///
/// Implements [Li10] Eq. (26).
struct SmoothMeans<'a> {
    pass: &'a mut Inference,
}

impl kernel::Job for SmoothMeans<'_> {
    type Output = ();

    #[allow(clippy::inline_always, reason = "the job takes on the vectors of its caller")]
    #[inline(always)]
    fn run(self, n: usize) {
        let pass = self.pass;
        pass.smoothed.assign(&pass.filtered);
        let smoothed = flat_mut(&mut pass.smoothed);
        let predicted = flat(&pass.predicted);
        let mut change = vec![0.0; n];
        for t in (0..pass.frames.saturating_sub(1)).rev() {
            let (head, tail) = smoothed.split_at_mut((t + 1) * n);
            for ((c, s), p) in change.iter_mut().zip(tail).zip(&predicted[(t + 1) * n..]) {
                *c = *s - p;
            }
            let gain = pass.forward.gain_transposed(pass.forward.step_of()[t]);
            kernel::add_applied(gain, &change, &mut head[t * n..], n);
        }
    }
}
