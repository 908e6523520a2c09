//! Expectation maximisation with one hook between its two steps.

use std::ops::ControlFlow;

use ndarray::{Array2, ArrayView2};

use crate::{
    covariance::Covariance,
    dynamics::Dynamics,
    error::LdsError,
    inference::{EStep, Inference},
    kernel,
    missing::MissingEntries,
    model::LdsModel,
    observations::Observations,
    start::{Start, first_model},
    statistics::{NoiseStructure, gather, maximize},
};

/// How a model is learnt.
#[derive(Debug, Clone, PartialEq)]
pub struct EmParams {
    /// Hidden dimensions, from 1 to the number of observed ones. [Li10]: 16.
    pub hidden: usize,
    /// Most E-steps to run, at least 1. [Li10]: 100 to 200.
    pub iterations: usize,
    /// Stops when the log-likelihood changes by at most this per observed entry from one
    /// iteration to the next; 0 or more, in nats. 0 asks for a standstill.
    pub tolerance: f64,
    /// Seed of the random start.
    pub seed: u64,
    /// Where to start from.
    pub start: Start,
    /// How missing entries enter the estimate of the states.
    pub e_step: EStep,
    /// The form of the covariances.
    pub structure: NoiseStructure,
}

impl Default for EmParams {
    fn default() -> Self {
        Self {
            hidden: 16,
            iterations: 100,
            tolerance: 1e-6,
            seed: 0,
            start: Start::default(),
            e_step: EStep::default(),
            structure: NoiseStructure::default(),
        }
    }
}

impl EmParams {
    fn validate(&self, observations: &Observations) -> Result<(), LdsError> {
        self.structure.validate()?;
        for (field, value) in [("hidden", self.hidden), ("iterations", self.iterations)] {
            if value == 0 {
                return Err(LdsError::Parameter { field, value: 0.0, allowed: "at least 1" });
            }
        }
        if !(self.tolerance.is_finite() && self.tolerance >= 0.0) {
            return Err(LdsError::Parameter {
                field: "tolerance",
                value: self.tolerance,
                allowed: "a finite number from 0",
            });
        }
        if observations.frames() < 2 {
            return Err(LdsError::TooFewFrames { frames: observations.frames(), needed: 2 });
        }
        if self.hidden > observations.dimensions() {
            return Err(LdsError::HiddenTooLarge {
                hidden: self.hidden,
                dimensions: observations.dimensions(),
            });
        }
        if observations.observed() == 0 {
            return Err(LdsError::NothingObserved);
        }
        Ok(())
    }
}

/// What a hook between the E-step and the M-step is told.
#[derive(Debug)]
pub struct UpdateContext<'a> {
    /// Iteration, counted from 1.
    pub iteration: usize,
    /// Most iterations there will be.
    pub iterations: usize,
    /// What the model expects to observe, `G E[z]`, `(T, m)`, in frames that miss an entry; zero in
    /// the others.
    pub prediction: ArrayView2<'a, f64>,
    /// The observation noise of the model.
    pub observation_noise: &'a Covariance,
    /// The mask, `(T, m)`, `true` where observed.
    pub mask: ArrayView2<'a, bool>,
}

/// Chooses values for the missing entries after each E-step.
///
/// Under [`EStep::FilledAsObserved`] it is not asked in the first iteration: what an arbitrary
/// first model predicts would count as observed from then on.
pub trait MissingUpdate {
    /// Writes new values over the present ones of the missing entries.
    fn update(&mut self, context: &UpdateContext<'_>, missing: &mut MissingEntries<'_>);

    /// The entries that count as observed under [`EStep::FilledAsObserved`], `(T, m)`, for this
    /// mask; the others are dropped as under [`EStep::Exact`]. `None`: all.
    ///
    /// A fill that rests on the prediction alone is no evidence: counted, it would hold on to
    /// whatever filled the gap first. Where some are dropped, EM starts from the data's subspace.
    fn evidence(&self, mask: ArrayView2<'_, bool>) -> Option<Array2<bool>> {
        let _ = mask;
        None
    }

    /// Whether every fill is the mean that the model expects, so that exact EM never lowers the
    /// likelihood and a fall is a breakdown of the arithmetic.
    fn keeps_likelihood(&self) -> bool {
        false
    }
}

/// Fills with what the model predicts, `G E[z]`: the plain linear dynamical system.
#[derive(Debug, Clone, Copy, Default)]
pub struct Prediction;

impl MissingUpdate for Prediction {
    fn update(&mut self, context: &UpdateContext<'_>, missing: &mut MissingEntries<'_>) {
        missing.fill_from(context.prediction);
    }

    fn keeps_likelihood(&self) -> bool {
        true
    }
}

/// Progress of a fit, told to the observer after each E-step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EmProgress {
    /// Iteration, counted from 1.
    pub iteration: usize,
    /// Most iterations there will be.
    pub iterations: usize,
    /// Log-likelihood of the model of this iteration, see [`Fit::log_likelihoods`].
    pub log_likelihood: f64,
}

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Termination {
    /// The log-likelihood stood still within the tolerance.
    Converged,
    /// All iterations were used.
    IterationLimit,
    /// The next model was numerically degenerate; the last sound one is returned.
    Stalled,
    /// The observer asked to stop.
    Stopped,
}

/// A learnt model, and the fill that belongs to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The model.
    pub model: LdsModel,
    /// Means of the hidden states under it, `(T, H)`.
    pub states: Array2<f64>,
    /// The observations with missing entries filled, `(T, m)`; observed entries are untouched.
    pub filled: Array2<f64>,
    /// Standard deviation of each missing entry given what was observed, `(T, m)`, zero where
    /// observed; only the exact E-step has it.
    pub deviation: Option<Array2<f64>>,
    /// Log-likelihood of the model of each iteration: of the observed entries under
    /// [`EStep::Exact`] (then never falling when the hook is [`Prediction`]), of the filled data
    /// under [`EStep::FilledAsObserved`], of the innovations with those of missing entries zero
    /// under [`EStep::Dynammo`].
    pub log_likelihoods: Vec<f64>,
    /// Why the fit ended.
    pub termination: Termination,
}

impl Fit {
    /// Number of E-steps that were run.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.log_likelihoods.len()
    }
}

/// Learns a model by expectation maximisation and fills the missing entries.
///
/// Each iteration estimates the states, lets `hook` choose the missing entries, tells `observer`,
/// and, unless it is the last one, maximises the parameters. So the model, the states and the fill
/// that are returned belong together.
///
/// # Errors
///
/// When a parameter is out of range, there are fewer than two frames, nothing is observed, or the
/// first E-step breaks down numerically.
///
/// Implements [Li10] Algorithm 1 and 2, with `hook` as their third step.
/// Deviates from [Li10] Algorithm 1: the missing entries are updated before the parameters.
pub fn fit_em(
    observations: &Observations,
    params: &EmParams,
    hook: &mut dyn MissingUpdate,
    observer: &mut dyn FnMut(&EmProgress) -> ControlFlow<()>,
) -> Result<Fit, LdsError> {
    params.validate(observations)?;
    let filled = observations.interpolated();
    let EmParams { hidden, seed, structure, .. } = params;
    let evidence = match params.e_step {
        EStep::FilledAsObserved => hook.evidence(observations.mask()),
        EStep::Exact | EStep::Dynammo => None,
    };
    let evidence =
        evidence.map(|mask| Observations::new(filled.view(), mask.view())).transpose()?;
    let pass = match &evidence {
        Some(evidence) => Inference::new(evidence, *hidden, EStep::Exact),
        None => Inference::new(observations, *hidden, params.e_step),
    };
    // What a random transition predicts grows beyond all bounds in frames without evidence.
    let start = if evidence.is_some() { Start::Subspace } else { params.start };
    let model = first_model(start, observations, *hidden, *seed, structure)?;
    let mut loop_state = Loop {
        observations,
        evidence,
        params,
        pass,
        dynamics: Dynamics::new(&model),
        model,
        prediction: Array2::zeros(filled.dim()),
        filled,
        trace: Vec::new(),
    };
    let termination = loop_state.run(hook, observer)?;
    let deviation = loop_state.deviation();
    Ok(Fit {
        model: loop_state.model,
        states: loop_state.pass.smoothed,
        filled: loop_state.filled,
        deviation,
        log_likelihoods: loop_state.trace,
        termination,
    })
}

/// A fall of the likelihood by less than this share of it is rounding.
const ROUNDING: f64 = 1e-6;

struct Loop<'a> {
    observations: &'a Observations,
    /// Observed entries and those fills that count as observed, where not all of them do.
    evidence: Option<Observations>,
    params: &'a EmParams,
    pass: Inference,
    dynamics: Dynamics,
    model: LdsModel,
    prediction: Array2<f64>,
    filled: Array2<f64>,
    trace: Vec<f64>,
}

impl Loop<'_> {
    fn run(
        &mut self,
        hook: &mut dyn MissingUpdate,
        observer: &mut dyn FnMut(&EmProgress) -> ControlFlow<()>,
    ) -> Result<Termination, LdsError> {
        let iterations = self.params.iterations;
        let first = self.estimate().ok_or(LdsError::Breakdown { iteration: 1 })?;
        self.trace.push(first);
        loop {
            let iteration = self.trace.len();
            self.update_missing(hook);
            let log_likelihood = self.trace[iteration - 1];
            let progress = EmProgress { iteration, iterations, log_likelihood };
            if observer(&progress).is_break() {
                return Ok(Termination::Stopped);
            }
            if self.stands_still() {
                return Ok(Termination::Converged);
            }
            if iteration == iterations {
                return Ok(Termination::IterationLimit);
            }
            let rises = self.params.e_step == EStep::Exact && hook.keeps_likelihood();
            if !self.advance(rises) {
                return Ok(Termination::Stalled);
            }
        }
    }

    fn estimate(&mut self) -> Option<f64> {
        let Self { pass, dynamics, filled, .. } = self;
        let Some(evidence) = &mut self.evidence else {
            return pass.run(dynamics, self.observations, filled.view());
        };
        evidence.set_values(filled.view(), self.observations.gap_frames());
        pass.run(dynamics, evidence, evidence.values())
    }

    fn update_missing(&mut self, hook: &mut dyn MissingUpdate) {
        if self.trace.len() == 1 && self.params.e_step == EStep::FilledAsObserved {
            return;
        }
        let frames = self.observations.gap_frames();
        self.pass.predict(&self.dynamics, frames, &mut self.prediction);
        let context = UpdateContext {
            iteration: self.trace.len(),
            iterations: self.params.iterations,
            prediction: self.prediction.view(),
            observation_noise: self.model.observation_noise(),
            mask: self.observations.mask(),
        };
        hook.update(&context, &mut MissingEntries::new(self.observations, self.filled.view_mut()));
    }

    fn stands_still(&self) -> bool {
        let [.., before, now] = self.trace[..] else { return false };
        (now - before).abs() <= self.params.tolerance * self.observations.observed() as f64
    }

    /// M-step and the next E-step; on failure everything is as before and the answer is `false`.
    ///
    /// Where the likelihood has to rise and falls, the filter has lost its digits: a model that is
    /// unstable in a direction hardly observed makes covariances grow beyond what a double holds.
    fn advance(&mut self, rises: bool) -> bool {
        let before = self.trace.last().copied().unwrap_or(f64::NEG_INFINITY);
        let least =
            if rises { before - ROUNDING * (1.0 + before.abs()) } else { f64::NEG_INFINITY };
        let evidence = self.evidence.as_ref().unwrap_or(self.observations);
        let statistics = gather(&self.pass, &self.dynamics, evidence, self.filled.view());
        let Some(next) = maximize(&statistics, &self.params.structure) else { return false };
        let previous = std::mem::replace(&mut self.dynamics, Dynamics::new(&next));
        if let Some(log_likelihood) = self.estimate().filter(|now| *now >= least) {
            self.model = next;
            self.trace.push(log_likelihood);
            return true;
        }
        self.dynamics = previous;
        // This pass succeeded an iteration ago, with the same model.
        let _ = self.estimate();
        false
    }

    /// Standard deviations of the missing entries from the posterior of the states.
    fn deviation(&self) -> Option<Array2<f64>> {
        if self.params.e_step != EStep::Exact {
            return None;
        }
        let n = self.dynamics.n;
        let mut deviation = Array2::zeros(self.filled.dim());
        let mut spread = vec![0.0; n];
        for group in self.observations.gap_groups() {
            for &j in &group.dimensions {
                let emission = self.dynamics.emission.row(j).to_vec();
                for &t in &group.frames {
                    kernel::apply(self.pass.backward.covariance(t), &emission, &mut spread, n);
                    let variance = kernel::dot(&emission, &spread) + self.dynamics.noise[j];
                    deviation[(t, j)] = variance.sqrt();
                }
            }
        }
        Some(deviation)
    }
}
