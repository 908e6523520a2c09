use std::ops::ControlFlow;

use thiserror::Error;

use crate::{BoneReport, CoreError, Filled, Gap, Take};

/// Fills the gaps of a take.
///
/// # Contract
/// - Observed samples come back bit for bit; [`Filled::merge`] sees to it.
/// - A filled sample is finite. A gap that the method cannot fill stays open and is listed in
///   [`FillReport::refusals`].
/// - A marker that is never seen stays open with [`Refusal::NeverSeen`], unless the method has other
///   knowledge of it.
/// - The same take and parameters give the same bits, on any number of threads.
/// - Running out of iterations is a [`Termination`], not an error.
pub trait GapFiller: Send + Sync {
    /// Short name of the method, as users type it.
    fn name(&self) -> &str;

    /// Fills the gaps and tells `observer` after each iteration; the observer may stop the work, and
    /// the best fill so far is returned.
    ///
    /// # Errors
    /// [`FillError`] where the method cannot run on this take at all.
    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError>;

    /// Fills the gaps.
    ///
    /// # Errors
    /// As [`fill_observed`](Self::fill_observed).
    fn fill(&self, take: &Take) -> Result<Filled, FillError> {
        self.fill_observed(take, &mut |_| ControlFlow::Continue(()))
    }
}

/// State of an iterative method after one iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IterReport {
    /// Iterations done, counted from 1.
    pub iteration: usize,
    /// Iterations at most.
    pub limit: usize,
    /// The method's objective, as [`FillReport::objective`] lists it.
    pub objective: f64,
}

/// Why a method ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Termination {
    /// The method has no iterations.
    ClosedForm,
    /// There was no gap to fill.
    NothingToFill,
    /// Its stop rule held.
    Converged,
    /// It ran all its iterations.
    IterationLimit,
    /// It could improve no further, short of its stop rule.
    Stalled,
    /// The observer stopped it.
    Stopped,
}

impl Termination {
    /// The name that reports use.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed-form",
            Self::NothingToFill => "nothing-to-fill",
            Self::Converged => "converged",
            Self::IterationLimit => "iteration-limit",
            Self::Stalled => "stalled",
            Self::Stopped => "stopped",
        }
    }
}

/// Why a gap was left open.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The marker is seen in no frame.
    #[error("the marker is never seen")]
    NeverSeen,
    /// The method needs observed samples on both sides of a gap.
    #[error("the gap reaches the start or end of the take")]
    OneSided,
    /// The gap is longer than the user allows.
    #[error("the gap lasts {gap_s:.3} s, longer than the limit of {limit_s:.3} s")]
    TooLong {
        /// Length of the gap in seconds.
        gap_s: f64,
        /// The limit in seconds.
        limit_s: f64,
    },
    /// Too few observed samples of the marker.
    #[error("the marker is seen in {seen} frames, {needed} are needed")]
    TooFewSamples {
        /// Frames that show the marker.
        seen: usize,
        /// Frames that the method needs.
        needed: usize,
    },
    /// No other marker is seen that the method could go by.
    #[error("no other marker is seen to fill it from")]
    NoNeighbour,
    /// Too few samples in a row beside the gap.
    #[error("only {found} samples in a row stand beside the gap, {needed} are needed")]
    ShortSeed {
        /// Samples in a row on the side that has fewer.
        found: usize,
        /// Samples in a row that the method needs on each side.
        needed: usize,
    },
    /// A marker that the method goes by is missing itself.
    #[error("its donor marker is missing within or right beside the gap")]
    DonorMissing {
        /// Index of the donor.
        donor: usize,
    },
    /// The method's answer was not finite.
    #[error("the method gave no finite position")]
    NotFinite,
    /// The method expects to err by more than the user allows.
    #[error("the expected error of {:.1} mm exceeds the limit of {:.1} mm", 1e3 * .expected_m, 1e3 * .limit_m)]
    TooUncertain {
        /// Root mean square of the expected 3-D error in metres.
        expected_m: f64,
        /// The limit in metres.
        limit_m: f64,
    },
    /// The user limits the error, and it is not known.
    #[error("the take shows nothing like the gap to tell how far a fill would err")]
    Untested,
    /// The observer stopped the work before the method came to this gap.
    #[error("the work was stopped before this gap")]
    Stopped,
}

/// A gap that was left open.
#[derive(Debug, Clone, PartialEq)]
pub struct Refused {
    /// The gap.
    pub gap: Gap,
    /// Why.
    pub reason: Refusal,
}

/// What a gap was filled with, for methods that choose.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The gap.
    pub gap: Gap,
    /// Root mean square of the expected 3-D error in metres, where it is known.
    pub expected_m: Option<f64>,
    /// Methods by their share in the fill, from 0 to 1, the largest first.
    pub shares: Vec<(String, f64)>,
}

/// How a fill came about.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FillReport {
    /// Name of the method.
    pub method: String,
    /// Why it ended.
    pub termination: Termination,
    /// Iterations done; 0 for a closed form.
    pub iterations: usize,
    /// Its objective after each iteration, `(iterations,)`; the method's docs say what it is.
    pub objective: Vec<f64>,
    /// Gaps left open.
    pub refusals: Vec<Refused>,
    /// What each gap was filled with, for methods that choose.
    pub choices: Vec<Choice>,
    /// Which frames keep their bones, for methods that promise exact lengths.
    pub bones: Option<BoneReport>,
}

impl FillReport {
    /// A report without iterations, objective or refusals.
    #[must_use]
    pub fn new(method: impl Into<String>, termination: Termination) -> Self {
        Self {
            method: method.into(),
            termination,
            iterations: 0,
            objective: Vec::new(),
            refusals: Vec::new(),
            choices: Vec::new(),
            bones: None,
        }
    }
}

/// Why a method cannot run on a take at all.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FillError {
    /// The take is too short.
    #[error("the take has {frames} frames, but {method} needs {needed}")]
    TooFewFrames {
        /// Name of the method.
        method: &'static str,
        /// Frames of the take.
        frames: usize,
        /// Frames that the method needs.
        needed: usize,
    },
    /// Nothing was observed.
    #[error("the take shows no marker in any frame; there is nothing to fill from")]
    NothingObserved,
    /// A parameter out of its range.
    #[error("parameter `{field}` is {value}; it must be {rule}")]
    Parameter {
        /// Name of the parameter.
        field: &'static str,
        /// The value as given.
        value: f64,
        /// The allowed range.
        rule: &'static str,
    },
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
    /// An error of the method's own.
    #[error("{method} failed")]
    Method {
        /// Name of the method.
        method: &'static str,
        /// What went wrong.
        #[source]
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}
