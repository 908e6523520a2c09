//! Gap filling of takes: the only part of this crate that knows of markers.

use std::{ops::ControlFlow, sync::Arc};

use mocap_core::{
    BodyFrame, BodyMarkers, CoreError, Estimates, FillError, FillReport, Filled, GapContext,
    GapFiller, IterReport, MarkerKnowledge, Refusal, Refused, Take, UpAxis,
};
use ndarray::{Array2, Array3};

use crate::{
    CovarianceStructure, EStep, EmParams, Fit, LdsError, MissingUpdate, NoiseStructure,
    Observations, Prediction, Start, Termination, fit_em,
};

/// Hidden dimensions of the published methods, [Li10] §4.
const PUBLISHED_HIDDEN: usize = 16;

/// Hidden dimensions where the user asks for none.
const DEFAULT_HIDDEN: usize = 32;

/// Frames for each hidden dimension beyond the published ones.
const FRAMES_EACH: usize = 9;

/// The coordinates in which a model is learnt.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Coordinates {
    /// Relative to the body where every frame shows reference markers of the CMU marker set, else
    /// as recorded: where the body is lost, its motion through the room is the surest thing to go by.
    #[default]
    Auto,
    /// As recorded.
    World,
    /// Relative to the body's place and heading, found from the visible reference markers that
    /// this marker-set knowledge names.
    Body(Arc<MarkerKnowledge>),
}

impl Coordinates {
    fn frame(&self, take: &Take) -> Result<Option<BodyFrame>, FillError> {
        match self {
            Self::World => Ok(None),
            Self::Body(known) => body_frame(take, known).map(Some),
            Self::Auto => match body_frame(take, &MarkerKnowledge::cmu_41()) {
                Err(FillError::Core(CoreError::NoBodyFrame)) => Ok(None),
                Ok(frame) if frame.bridged() > 0 => Ok(None),
                found => found.map(Some),
            },
        }
    }
}

fn body_frame(take: &Take, known: &MarkerKnowledge) -> Result<BodyFrame, FillError> {
    let markers = BodyMarkers::find(take, known).ok_or(CoreError::NoBodyFrame)?;
    let up = UpAxis::guess(take, known).ok_or(FillError::NothingObserved)?;
    Ok(BodyFrame::estimate(take, &markers, up)?)
}

/// Where the origin lies while a model is learnt. A linear system has no constant term: it spends
/// a hidden dimension on the body's mean shape, seen from this point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Origin {
    /// Where the coordinates have it. The published methods do this.
    AsRecorded,
    /// At the mean of all visible samples, so that moving a take does not change its fill.
    #[default]
    Centroid,
}

/// How many hidden dimensions a model has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hidden {
    /// So many, from 1 to three per seen marker; a take with fewer coordinates is refused.
    Exactly(usize),
    /// So many or fewer, where the take has fewer coordinates or is so short that a large model would
    /// learn its noise: at most one in nine frames, but 16 from 32 frames on.
    AtMost(usize),
}

impl Hidden {
    fn most(self) -> usize {
        match self {
            Self::Exactly(hidden) | Self::AtMost(hidden) => hidden,
        }
    }

    fn of(self, observations: &Observations) -> usize {
        let frames = observations.frames();
        let told = (frames / FRAMES_EACH).max(PUBLISHED_HIDDEN.min(frames / 2)).max(1);
        match self {
            Self::Exactly(hidden) => hidden,
            Self::AtMost(hidden) => hidden.min(told).min(observations.dimensions()),
        }
    }
}

/// How [`LdsFiller`] learns and fills.
#[derive(Debug, Clone, PartialEq)]
pub struct LdsFillerParams {
    /// Hidden dimensions. Default: at most 32. [Li10]: 16.
    pub hidden: Hidden,
    /// Most EM iterations, at least 1. Default 20; more learn the noise of the take. [Li10]: 100 to 200.
    pub iterations: usize,
    /// Stops when the log-likelihood changes by at most this many nats per observed coordinate;
    /// 0 or more.
    pub tolerance: f64,
    /// Seed of a random start.
    pub seed: u64,
    /// Where EM starts.
    pub start: Start,
    /// How missing samples enter the estimate of the states.
    pub e_step: EStep,
    /// The form of the covariances, with the variance floor in m².
    pub structure: NoiseStructure,
    /// Where the origin lies while a model is learnt.
    pub origin: Origin,
    /// The coordinates to learn in.
    pub coordinates: Coordinates,
}

impl Default for LdsFillerParams {
    /// Exact EM from the data's own subspace.
    fn default() -> Self {
        Self {
            hidden: Hidden::AtMost(DEFAULT_HIDDEN),
            iterations: 20,
            tolerance: 1e-6,
            seed: 0,
            start: Start::Subspace,
            e_step: EStep::Exact,
            structure: NoiseStructure {
                state: CovarianceStructure::Diagonal,
                ..NoiseStructure::default()
            },
            origin: Origin::Centroid,
            coordinates: Coordinates::Auto,
        }
    }
}

impl LdsFillerParams {
    /// `DynaMMo` with the hidden dimensions, iterations and covariances of [Li10] §4, but with start and
    /// origin as in the default.
    #[must_use]
    pub fn dynammo() -> Self {
        Self {
            hidden: Hidden::AtMost(PUBLISHED_HIDDEN),
            iterations: 100,
            e_step: EStep::Dynammo,
            structure: NoiseStructure::default(),
            ..Self::default()
        }
    }

    /// `DynaMMo` with all settings of [Li10] §4: a random start, body-local coordinates of the CMU
    /// marker set with their own origin. For comparison with published figures: the random
    /// transition grows what it predicts, beyond all bounds in frames that show nothing.
    #[must_use]
    pub fn published() -> Self {
        Self {
            start: Start::Random,
            origin: Origin::AsRecorded,
            coordinates: Coordinates::Body(Arc::new(MarkerKnowledge::cmu_41())),
            ..Self::dynammo()
        }
    }

    /// Checks what can be checked without a take.
    ///
    /// # Errors
    ///
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn validate(&self) -> Result<(), FillError> {
        let at_least_one = |field, value: usize| {
            let rule = "at least 1";
            if value == 0 { Err(FillError::Parameter { field, value: 0.0, rule }) } else { Ok(()) }
        };
        at_least_one("hidden", self.hidden.most())?;
        at_least_one("iterations", self.iterations)?;
        if !(self.tolerance.is_finite() && self.tolerance >= 0.0) {
            let (field, value) = ("tolerance", self.tolerance);
            return Err(FillError::Parameter { field, value, rule: "a finite number from 0" });
        }
        self.structure.validate().map_err(|error| fill_error("lds", error))
    }

    fn em(&self, observations: &Observations) -> EmParams {
        EmParams {
            hidden: self.hidden.of(observations),
            iterations: self.iterations,
            tolerance: self.tolerance,
            seed: self.seed,
            start: self.start,
            e_step: self.e_step,
            structure: self.structure,
        }
    }
}

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

/// Where the columns of the observations come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    markers: Vec<usize>,
    origin: [f64; 3],
}

impl Columns {
    /// The markers of the take that are seen at all, in order; the `k`-th has the columns
    /// `3k`, `3k + 1` and `3k + 2`.
    #[must_use]
    pub fn markers(&self) -> &[usize] {
        &self.markers
    }

    /// The place that is zero in the columns, in metres.
    #[must_use]
    pub fn origin(&self) -> [f64; 3] {
        self.origin
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

/// A take as a matrix.
struct Table {
    columns: Columns,
    values: Array2<f64>,
    mask: Array2<bool>,
}

impl Table {
    fn new(take: &Take, origin: Origin) -> Self {
        let seen = |m: &usize| take.observed().marker(*m).iter().any(|&seen| seen);
        let markers: Vec<usize> = (0..take.marker_count()).filter(seen).collect();
        let shape = (take.frames(), 3 * markers.len());
        let origin = match origin {
            Origin::AsRecorded => [0.0; 3],
            Origin::Centroid => centroid(take),
        };
        let mask = Array2::from_shape_fn(shape, |(t, j)| take.is_observed(t, markers[j / 3]));
        let values = Array2::from_shape_fn(shape, |(t, j)| {
            take.positions()[(t, markers[j / 3], j % 3)] - origin[j % 3]
        });
        Self { columns: Columns { markers, origin }, values, mask }
    }

    fn observations(&self) -> Result<Observations, LdsError> {
        Observations::new(self.values.view(), self.mask.view())
    }

    fn estimates(&self, take: &Take, fit: &Fit) -> Estimates {
        let (frames, markers) = (take.frames(), take.marker_count());
        let mut positions = Array3::from_elem((frames, markers, 3), f64::NAN);
        let mut sigma = Array2::from_elem((frames, markers), f64::NAN);
        for ((t, j), x) in fit.filled.indexed_iter() {
            positions[(t, self.columns.markers[j / 3], j % 3)] = x + self.columns.origin[j % 3];
        }
        let sigma_m = fit.deviation.as_ref().map(|deviation| {
            for (k, &m) in self.columns.markers.iter().enumerate() {
                for t in 0..frames {
                    let axes = (0..3).map(|a| deviation[(t, 3 * k + a)].powi(2));
                    sigma[(t, m)] = axes.sum::<f64>().sqrt();
                }
            }
            sigma
        });
        Estimates { positions, sigma_m }
    }
}

/// The mean of all visible samples; zero where there is none.
fn centroid(take: &Take) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (t, m) in take.observed().iter() {
        (0..3).for_each(|a| sum[a] += take.positions()[(t, m, a)]);
    }
    sum.map(|s| s / take.observed().count().max(1) as f64)
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
