//! Filter and smoother over the values, with buffers that are reused from one pass to the next.

use std::f64::consts::TAU;

use ndarray::{Array1, Array2, ArrayView2};

use crate::{
    backward::Backward,
    dynamics::Dynamics,
    forward::{Forward, STATIONARY},
    kernel,
    observations::Observations,
    panel,
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
}

impl Inference {
    pub(crate) fn new(observations: &Observations, n: usize, e_step: EStep) -> Self {
        let frames = observations.frames();
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
        let m = observations.dimensions();
        let weighted = flat_mut(&mut self.weighted);
        panel::project(flat_view(&values), m, &dynamics.weighted_emission, self.n, weighted);
        let explained = kernel::fast(self.n, FilterMeans { pass: self, dynamics });
        let log_likelihood = self.log_likelihood(dynamics, observations, values, explained);
        log_likelihood.is_finite().then_some(log_likelihood)
    }

    /// The information of each pattern of the mask, then that of a frame that observes all.
    fn gather_information(&mut self, dynamics: &Dynamics, observations: &Observations) {
        let size = self.n * self.n;
        self.information.clear();
        for pattern in observations.patterns() {
            if self.e_step == EStep::FilledAsObserved {
                // Never read; the blocks stand where the pattern's number says.
                self.information.resize(self.information.len() + size, 0.0);
            } else {
                dynamics.add_information(&pattern.observed, &mut self.information);
            }
        }
        let all: Vec<usize> = (0..observations.dimensions()).collect();
        dynamics.add_information(&all, &mut self.information);
    }

    /// The log-likelihood of the entries that count, from the innovations.
    fn log_likelihood(
        &self,
        dynamics: &Dynamics,
        observations: &Observations,
        values: ArrayView2<'_, f64>,
        explained: Explained,
    ) -> f64 {
        let precision = dynamics.noise.mapv(f64::recip);
        let squares = match self.e_step {
            EStep::FilledAsObserved => observations.squares_with(values),
            EStep::Exact | EStep::Dynammo => observations.squares().clone(),
        };
        let total = squares.dot(&precision);
        let mut quadratic = total - explained.by_prediction;
        if total > CANCELLED * quadratic {
            quadratic = self.squared_residuals(dynamics, observations, values, &precision);
        }
        let log_noise = dynamics.noise.mapv(|r| (TAU * r).ln());
        let of_all = log_noise.sum();
        let by_pattern: Vec<f64> = observations
            .patterns()
            .iter()
            .map(|pattern| match self.e_step {
                EStep::Exact => pattern.observed.iter().map(|&j| log_noise[j]).sum(),
                EStep::FilledAsObserved | EStep::Dynammo => of_all,
            })
            .collect();
        let mut sum = quadratic - explained.by_correction;
        for (&pattern, &step) in observations.pattern_of().iter().zip(self.forward.step_of()) {
            sum += self.forward.log_determinant(step) + by_pattern[pattern];
        }
        -0.5 * sum
    }

    /// `Σ eᵀ Σ⁻¹ e` over the entries that count, where `e` is what the prediction misses.
    fn squared_residuals(
        &self,
        dynamics: &Dynamics,
        observations: &Observations,
        values: ArrayView2<'_, f64>,
        precision: &Array1<f64>,
    ) -> f64 {
        let (n, m) = (self.n, observations.dimensions());
        let mut expected = vec![0.0; m];
        let mut sum = 0.0;
        for ((t, row), state) in values.rows().into_iter().enumerate().zip(self.predicted.rows()) {
            let state = state.to_slice().expect("buffers are made in standard layout");
            panel::project(state, n, &dynamics.emission_transposed, m, &mut expected);
            let weighted = |j: usize| precision[j] * (row[j] - expected[j]).powi(2);
            let pattern = &observations.patterns()[observations.pattern_of()[t]];
            sum += match self.e_step {
                EStep::FilledAsObserved => (0..m).map(weighted).sum::<f64>(),
                _ => pattern.observed.iter().map(|&j| weighted(j)).sum(),
            };
        }
        sum
    }

    /// `G E[z]`, `(T, m)`, into the rows of `out` of these frames.
    pub(crate) fn predict(&self, dynamics: &Dynamics, frames: &[usize], out: &mut Array2<f64>) {
        let (n, m) = (self.n, out.ncols());
        let (states, out) = (flat(&self.smoothed), flat_mut(out));
        for run in frames.chunk_by(|a, b| a + 1 == *b) {
            let (first, end) = (run[0], run[0] + run.len());
            let emission = &dynamics.emission_transposed;
            panel::project(
                &states[first * n..end * n],
                n,
                emission,
                m,
                &mut out[first * m..end * m],
            );
        }
    }

    /// `Σ E[z zᵀ]` and `Σ E[z[t+1] z[t]ᵀ]`.
    pub(crate) fn second_moments(&self) -> (Array2<f64>, Array2<f64>) {
        let (n, last) = (self.n, self.frames - 1);
        let states = flat(&self.smoothed);
        let (mut same, mut lag) = (Array2::zeros((n, n)), Array2::zeros((n, n)));
        panel::correlate(states, n, states, n, flat_mut(&mut same));
        self.backward.add_covariances(0..self.frames, flat_mut(&mut same));
        panel::correlate(&states[n..], n, &states[..last * n], n, flat_mut(&mut lag));
        self.backward.add_lag_ones(0..last, flat_mut(&mut lag));
        (same, lag)
    }

    /// `Σ x E[z]ᵀ`, `(m, H)`, for data `(T, m)`.
    pub(crate) fn cross_moment(&self, data: ArrayView2<'_, f64>) -> Array2<f64> {
        let (n, m) = (self.n, data.ncols());
        let mut cross = Array2::zeros((m, n));
        panel::correlate(flat_view(&data), m, flat(&self.smoothed), n, flat_mut(&mut cross));
        cross
    }

    #[cfg(test)]
    pub(crate) fn set_stationary(&mut self, tolerance: f64) {
        self.stationary = tolerance;
    }
}

fn flat_view<'a>(array: &'a ArrayView2<'_, f64>) -> &'a [f64] {
    array.as_slice().expect("observations and fills are kept in standard layout")
}

fn flat(array: &Array2<f64>) -> &[f64] {
    array.as_slice().expect("buffers are made in standard layout")
}

fn flat_mut(array: &mut Array2<f64>) -> &mut [f64] {
    array.as_slice_mut().expect("buffers are made in standard layout")
}

/// The log-likelihood takes the squared innovations as the difference of two sums, unless the larger
/// one is this many times the difference: then so many digits are lost that they are computed.
const CANCELLED: f64 = 1e6;

/// Parts of the squared observations, in units of their noise.
#[derive(Debug, Clone, Copy, Default)]
struct Explained {
    /// `Σ xᵀ Σ⁻¹ x − (x − G μ)ᵀ Σ⁻¹ (x − G μ)` for the predicted states `μ`.
    by_prediction: f64,
    /// What the correction of the states by the innovations takes off.
    by_correction: f64,
}

/// The means of the filter.
///
/// Implements [Li10] Eq. (17) and (21) in the information form.
struct FilterMeans<'a> {
    pass: &'a mut Inference,
    dynamics: &'a Dynamics,
}

impl kernel::Job for FilterMeans<'_> {
    type Output = Explained;

    #[allow(clippy::inline_always, reason = "the job takes on the vectors of its caller")]
    #[inline(always)]
    fn run(self, n: usize) -> Explained {
        let Self { pass, dynamics } = self;
        let size = n * n;
        let (mut innovation, mut correction) = (vec![0.0; n], vec![0.0; n]);
        let mut explained = Explained::default();
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
            for ((i, w), p) in innovation.iter_mut().zip(&weighted[now.clone()]).zip(&*prediction) {
                *i = w - *i;
                explained.by_prediction += p * (w + *i);
            }
            let covariance = pass.forward.filtered(pass.forward.step_of()[t]);
            kernel::apply(covariance, &innovation, &mut correction, n);
            explained.by_correction += kernel::dot(&innovation, &correction);
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
