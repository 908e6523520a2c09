use std::{fmt, time::Instant};

use gapfill::{Bones, Options};
use mocap_core::{
    BodyFrame, BodyMarkers, BoneRule, BoneSet, CoreError, Holdout, MarkerKnowledge, Take, UpAxis,
};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::{Motion, ReproError, Trial, VERSION, Variant, motions::hex};

/// Coordinates in which a method is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Coordinates {
    /// Relative to the body's place and heading.
    Body,
    /// As recorded.
    World,
    /// The recording as it is; the method chooses.
    Own,
}

/// What a method is told beside the gappy take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Knowledge {
    /// Bone lengths and body frame of the complete motion, hidden samples included: what the
    /// published evaluation did. No user has it.
    Oracle,
    /// Nothing: bones and frame come from what is visible.
    Visible,
}

impl fmt::Display for Coordinates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Body => "body",
            Self::World => "world",
            Self::Own => "own",
        })
    }
}

impl fmt::Display for Knowledge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Oracle => "oracle",
            Self::Visible => "visible",
        })
    }
}

/// What became of one cell of the matrix.
///
/// Errors are `None` where no hidden sample was filled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Mean square error per hidden coordinate in m², over the samples that were filled.
    pub mse_m2: Option<f64>,
    /// Mean 3-D error in mm.
    pub mean_mm: Option<f64>,
    /// Median 3-D error in mm.
    pub median_mm: Option<f64>,
    /// 95 % quantile of the 3-D error in mm.
    pub p95_mm: Option<f64>,
    /// Mean deviation in mm from the true mean bone lengths, over the bones that touch a hidden sample.
    pub bone_mm: Option<f64>,
    /// Hidden samples.
    pub hidden: usize,
    /// Hidden samples that were left open.
    pub unfilled: usize,
    /// Iterations done.
    pub iterations: usize,
    /// Why the method ended.
    pub termination: String,
    /// Time of the fill in seconds, on one thread.
    pub seconds: f64,
    /// Why the method could not run.
    pub error: Option<String>,
}

impl Outcome {
    /// Whether two outcomes are the same but for the time they took.
    #[must_use]
    pub fn same_result(&self, other: &Self) -> bool {
        Self { seconds: 0.0, ..self.clone() } == Self { seconds: 0.0, ..other.clone() }
    }
}

/// One computation. Two cells that ask for the same one share its key and are computed once.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    pub trial: &'a Trial,
    pub motion: &'a Motion,
    pub variant: &'a Variant,
    pub coordinates: Coordinates,
    pub knowledge: Knowledge,
    pub iterations: Option<usize>,
}

impl Job<'_> {
    fn oracle_bones(&self) -> bool {
        self.knowledge == Knowledge::Oracle && self.variant.reads("bones")
    }

    fn oracle_frame(&self) -> bool {
        self.knowledge == Knowledge::Oracle && self.coordinates == Coordinates::Body
    }

    fn limit(&self) -> Option<usize> {
        self.trial.iterations.or(self.iterations)
    }

    /// A hash of all that the result depends on.
    pub(crate) fn key(&self) -> String {
        let asked = serde_json::json!({
            "version": VERSION,
            "method": self.variant.id(),
            "settings": self.variant.settings(),
            "motion": self.motion.digest(),
            "hidden": self.trial.hidden,
            "seed": self.trial.seed,
            "iterations": self.limit(),
            "coordinates": self.coordinates,
            "oracle": [self.oracle_bones(), self.oracle_frame()],
        });
        hex(&Sha256::digest(asked.to_string().as_bytes())[..12])
    }

    /// Fills and scores.
    ///
    /// # Errors
    /// [`ReproError`] for a trial that does not fit its motion; what the method itself refuses is an
    /// [`Outcome::error`].
    pub(crate) fn compute(&self) -> Result<Outcome, ReproError> {
        let world = self.trial.cut(self.motion.take())?;
        let mut options =
            Options { seed: self.trial.seed, iterations: self.limit(), ..self.variant.options() };
        if self.oracle_bones() {
            options.bones = Bones::Given(true_bones(world.truth(), &options.known)?);
        }
        let holdout = match self.place(&world, &mut options) {
            Ok(local) => local.unwrap_or(world),
            Err(error) => return Ok(failed(&world, 0.0, &error)),
        };
        self.fill(&holdout, &options)
    }

    /// The trial in the coordinates that the method shall see, or the coordinates it is told to take.
    fn place(&self, world: &Holdout, options: &mut Options) -> Result<Option<Holdout>, CoreError> {
        let source = match self.coordinates {
            Coordinates::Own => return Ok(None),
            Coordinates::World => {
                options.coordinates = Some(gapfill::Coordinates::World);
                return Ok(None);
            }
            Coordinates::Body if self.oracle_frame() => world.truth(),
            Coordinates::Body if self.variant.reads("frame") => {
                options.coordinates = Some(gapfill::Coordinates::Body);
                return Ok(None);
            }
            Coordinates::Body => world.visible(),
        };
        options.coordinates = Some(gapfill::Coordinates::World);
        let local = body_frame(source)?.localise(world.truth())?;
        Holdout::new(local, world.hidden()).map(Some)
    }

    fn fill(&self, holdout: &Holdout, options: &Options) -> Result<Outcome, ReproError> {
        let method = gapfill::build(self.variant.id(), options).map_err(|source| {
            ReproError::Method { text: self.variant.label().to_owned(), source }
        })?;
        let start = Instant::now();
        let filled = method.fill(holdout.visible());
        let seconds = start.elapsed().as_secs_f64();
        let filled = match filled {
            Ok(filled) => filled,
            Err(error) => return Ok(failed(holdout, seconds, &error)),
        };
        let (truth, take, hidden) = (holdout.truth(), filled.take(), holdout.hidden());
        let score = match metrics::score(truth, take, hidden) {
            Ok(score) => score,
            Err(error) => return Ok(failed(holdout, seconds, &error)),
        };
        let bones = true_bones(truth, &options.known)?;
        let deviation = metrics::bone_deviation(take, &bones, Some(hidden));
        let finite = |value: f64| value.is_finite().then_some(value);
        Ok(Outcome {
            mse_m2: finite(score.mse_m2),
            mean_mm: finite(score.mean_mm),
            median_mm: finite(score.median_mm),
            p95_mm: finite(score.p95_mm),
            bone_mm: deviation.ok().and_then(|deviation| finite(deviation.mean_mm)),
            hidden: score.hidden_cells,
            unfilled: score.unfilled_cells,
            iterations: filled.report().iterations,
            termination: filled.report().termination.as_str().to_owned(),
            seconds,
            error: None,
        })
    }
}

/// Bones of the complete motion.
fn true_bones(truth: &Take, known: &[MarkerKnowledge]) -> Result<BoneSet, CoreError> {
    BoneSet::estimate(truth, &BoneRule::Known(known.to_vec()))
}

fn body_frame(take: &Take) -> Result<BodyFrame, CoreError> {
    let known = MarkerKnowledge::cmu_41();
    let markers = BodyMarkers::find(take, &known).ok_or(CoreError::NoBodyFrame)?;
    let up = UpAxis::guess(take, &known).ok_or(CoreError::NoBodyFrame)?;
    BodyFrame::estimate(take, &markers, up)
}

fn failed(holdout: &Holdout, seconds: f64, error: &dyn std::error::Error) -> Outcome {
    let hidden = holdout.hidden().count();
    let mut reason = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        reason = format!("{reason}: {cause}");
        source = cause.source();
    }
    Outcome {
        mse_m2: None,
        mean_mm: None,
        median_mm: None,
        p95_mm: None,
        bone_mm: None,
        hidden,
        unfilled: hidden,
        iterations: 0,
        termination: "failed".to_owned(),
        seconds,
        error: Some(reason),
    }
}
