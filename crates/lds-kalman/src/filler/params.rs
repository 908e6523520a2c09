//! How a take is learnt.

use std::sync::Arc;

use mocap_core::{BodyFrame, BodyMarkers, CoreError, FillError, MarkerKnowledge, Take, UpAxis};

use super::fill_error;
use crate::{CovarianceStructure, EStep, EmParams, NoiseStructure, Observations, Start};

/// Hidden dimensions of the published methods, [Li10] §4.
const PUBLISHED_HIDDEN: usize = 16;

/// Hidden dimensions where the user asks for none.
const DEFAULT_HIDDEN: usize = 32;

/// Frames for each hidden dimension beyond the published ones.
const FRAMES_EACH: usize = 9;

/// The coordinates in which a model is learnt.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Coordinates {
    /// Relative to the body where every frame shows reference markers of a marker set that is known, else
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
    pub(super) fn frame(&self, take: &Take) -> Result<Option<BodyFrame>, FillError> {
        match self {
            Self::World => Ok(None),
            Self::Body(known) => body_frame(take, known).map(Some),
            Self::Auto => match body_frame(take, &MarkerKnowledge::for_markers(take.markers())) {
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
    /// So many or fewer, where the take has few markers or is so short that a large model would learn its
    /// noise: at most one for each seen marker, and one in nine frames, but 16 from 32 frames on. In a take with dark
    /// frames (see [`Dark`]) each has its velocity beside it.
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
            Self::AtMost(hidden) => hidden.min(told).min((observations.dimensions() / 3).max(2)),
        }
    }
}

/// What to learn of a take in which some frames show fewer coordinates than there are hidden dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dark {
    /// The first model of [`Start::Subspace`], which moves steadily, as it is. The M-step would
    /// trade the pace, which alone leads through such frames, for a better fit of the others.
    #[default]
    Steady,
    /// As of any other take.
    Learnt,
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
    /// What to learn where frames are dark.
    pub dark: Dark,
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
            dark: Dark::Steady,
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
            dark: Dark::Learnt,
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

    fn steady(&self) -> bool {
        self.dark == Dark::Steady && self.start == Start::Subspace && self.e_step == EStep::Exact
    }

    pub(super) fn em(&self, observations: &Observations) -> EmParams {
        let mut hidden = self.hidden.of(observations);
        let mut iterations = self.iterations;
        if self.steady() && observations.fewest_observed() < hidden {
            iterations = 1;
            if let Hidden::AtMost(_) = self.hidden {
                hidden = (2 * hidden).min(observations.dimensions());
            }
        }
        EmParams {
            hidden,
            iterations,
            tolerance: self.tolerance,
            seed: self.seed,
            start: self.start,
            e_step: self.e_step,
            structure: self.structure,
        }
    }
}
