//! Gap filling of takes: the only part of this crate that knows of markers.

mod params;
mod table;

use std::ops::ControlFlow;

use mocap_core::{
    FillError, FillReport, Filled, GapContext, GapFiller, IterReport, Refusal, Refused, Take,
};

use self::table::Table;
pub use self::{
    params::{Coordinates, Dark, Hidden, LdsFillerParams, Origin},
    table::Columns,
};
use crate::{EStep, Fit, LdsError, MissingUpdate, Prediction, Termination, fit_em};

/// Fills gaps with a linear dynamical system learnt from the take itself.
///
/// The objective it reports is the log-likelihood. With [`EStep::Exact`] each filled sample has a
/// standard deviation. Markers that are never seen stay open.
#[derive(Debug, Clone, PartialEq)]
pub struct LdsFiller {
    params: LdsFillerParams,
}

impl LdsFiller {
    /// A filler with these parameters.
    ///
    /// # Errors
    ///
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn new(params: LdsFillerParams) -> Result<Self, FillError> {
        params.validate()?;
        Ok(Self { params })
    }

    fn method(&self) -> &'static str {
        match self.params.e_step {
            EStep::Exact => "lds",
            EStep::Dynammo => "dynammo",
            EStep::FilledAsObserved => "lds-filled",
        }
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &LdsFillerParams {
        &self.params
    }
}

impl GapFiller for LdsFiller {
    /// `lds` with the exact E-step, `dynammo` with its own, `lds-filled` where fills count as
    /// observed.
    fn name(&self) -> &str {
        self.method()
    }

    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        fill_with(self.method(), take, &self.params, |_| Ok(Box::new(Prediction)), observer)
    }
}

/// Learns a model of a take with a hook of the caller's and fills the gaps.
///
/// `hook` is built once the seen markers are known; it works in metres, in the coordinates the
/// parameters ask for, seen from [`Columns::origin`].
///
/// # Errors
///
/// When the take is too short or shows nothing, a parameter does not fit it, its body frame cannot
/// be found, or `hook` refuses.
pub fn fill_with(
    method: &'static str,
    take: &Take,
    params: &LdsFillerParams,
    hook: impl FnOnce(&Columns) -> Result<Box<dyn MissingUpdate>, FillError>,
    observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
) -> Result<Filled, FillError> {
    params.validate()?;
    if take.gaps().is_empty() {
        let report = FillReport::new(method, mocap_core::Termination::NothingToFill);
        return Ok(Filled::unchanged(take, report)?);
    }
    if take.observed().count() == 0 {
        return Err(FillError::NothingObserved);
    }
    if take.frames() < 2 {
        return Err(FillError::TooFewFrames { method, frames: take.frames(), needed: 2 });
    }
    let frame = params.coordinates.frame(take)?;
    let local = frame.as_ref().map(|frame| frame.localise(take)).transpose()?;
    let table = Table::new(local.as_ref().unwrap_or(take), params.origin);
    let observations = table.observations().map_err(|error| fill_error(method, error))?;
    let mut hook = hook(&table.columns)?;
    let fit = fit_em(&observations, &params.em(&observations), hook.as_mut(), &mut |progress| {
        observer(&IterReport {
            iteration: progress.iteration,
            limit: progress.iterations,
            objective: progress.log_likelihood,
        })
    })
    .map_err(|error| fill_error(method, error))?;
    let mut estimates = table.estimates(take, &fit);
    if let Some(frame) = frame {
        frame.globalise(&mut estimates.positions)?;
    }
    Ok(Filled::merge(take, estimates, report(method, take, fit))?)
}

fn report(method: &'static str, take: &Take, fit: Fit) -> FillReport {
    let termination = match fit.termination {
        Termination::Converged => mocap_core::Termination::Converged,
        Termination::IterationLimit => mocap_core::Termination::IterationLimit,
        Termination::Stalled => mocap_core::Termination::Stalled,
        Termination::Stopped => mocap_core::Termination::Stopped,
    };
    let mut report = FillReport::new(method, termination);
    report.iterations = fit.iterations();
    report.objective = fit.log_likelihoods;
    let never_seen =
        take.gaps().into_iter().filter(|gap| gap.context(take.frames()) == GapContext::Whole);
    report.refusals = never_seen.map(|gap| Refused { gap, reason: Refusal::NeverSeen }).collect();
    report
}

fn fill_error(method: &'static str, error: LdsError) -> FillError {
    match error {
        LdsError::Parameter { field, value, allowed } => {
            FillError::Parameter { field, value, rule: allowed }
        }
        LdsError::NothingObserved => FillError::NothingObserved,
        LdsError::TooFewFrames { frames, needed } => {
            FillError::TooFewFrames { method, frames, needed }
        }
        other => FillError::Method { method, source: Box::new(other) },
    }
}
