use std::{fmt, time::Instant};

use gapfill::{Bones, Options};
use mocap_core::{
    BodyFrame, BodyMarkers, BoneRule, BoneSet, CoreError, Filled, GapFiller, Holdout,
    MarkerKnowledge, Take, UpAxis,
};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::{Motion, Outcome, ReproError, Trial, VERSION, Variant, motions::hex};

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

/// A fill and the time it took, on one thread.
pub(crate) struct Filling {
    pub filled: Filled,
    pub seconds: f64,
}

/// Why there is no fill, and the time it took to find out.
pub(crate) struct Failure {
    pub error: Box<dyn std::error::Error + Send + Sync>,
    pub seconds: f64,
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

    /// Iterations at most, if it is not the method's own number.
    pub(crate) fn limit(&self) -> Option<usize> {
        self.trial.iterations.or(self.iterations)
    }

    fn options(&self) -> Options {
        let told = self.variant.settings().session;
        let session = if told { self.motion.session() } else { Vec::new() };
        let (seed, iterations) = (self.trial.seed, self.limit());
        Options { seed, iterations, session, ..self.variant.options() }
    }

    /// Refuses options that the method refuses.
    ///
    /// # Errors
    /// [`ReproError::Method`].
    pub(crate) fn check(&self) -> Result<(), ReproError> {
        self.method(&self.options()).map(drop)
    }

    fn method(&self, options: &Options) -> Result<Box<dyn GapFiller>, ReproError> {
        gapfill::build(self.variant.id(), options)
            .map_err(|source| ReproError::Method { text: self.variant.label().to_owned(), source })
    }

    /// A hash of all that the result depends on.
    pub(crate) fn key(&self) -> String {
        let asked = serde_json::json!({
            "version": VERSION,
            "method": self.variant.id(),
            "settings": self.variant.settings(),
            "motion": self.motion.digest(),
            "session": self.variant.settings().session.then(|| self.motion.session_digests()),
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
        let (holdout, result) = self.fill()?;
        let Filling { filled, seconds } = match result {
            Ok(filling) => filling,
            Err(Failure { error, seconds }) => {
                return Ok(Outcome::failed(&holdout, seconds, error.as_ref()));
            }
        };
        let bones = true_bones(holdout.truth(), &self.variant.options().known)?;
        Ok(Outcome::of(&holdout, &filled, &bones, seconds)
            .unwrap_or_else(|error| Outcome::failed(&holdout, seconds, &error)))
    }

    /// Hides and fills; the take is in the coordinates of the job.
    ///
    /// # Errors
    /// As [`compute`](Self::compute).
    pub(crate) fn fill(&self) -> Result<(Holdout, Result<Filling, Failure>), ReproError> {
        let world = self.trial.cut(self.motion.take())?;
        let mut options = self.options();
        if self.oracle_bones() {
            options.bones = Bones::Given(true_bones(world.truth(), &options.known)?);
        }
        let holdout = match self.place(&world, &mut options) {
            Ok(local) => local.unwrap_or(world),
            Err(error) => return Ok((world, Err(Failure { error: error.into(), seconds: 0.0 }))),
        };
        let method = self.method(&options)?;
        let start = Instant::now();
        let filled = method.fill(holdout.visible());
        let seconds = start.elapsed().as_secs_f64();
        let result = match filled {
            Ok(filled) => Ok(Filling { filled, seconds }),
            Err(error) => Err(Failure { error: error.into(), seconds }),
        };
        Ok((holdout, result))
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
}

/// Bones of the complete motion.
pub(crate) fn true_bones(truth: &Take, known: &[MarkerKnowledge]) -> Result<BoneSet, CoreError> {
    BoneSet::estimate(truth, &BoneRule::Known(known.to_vec()))
}

fn body_frame(take: &Take) -> Result<BodyFrame, CoreError> {
    let known = MarkerKnowledge::cmu_41();
    let markers = BodyMarkers::find(take, &known).ok_or(CoreError::NoBodyFrame)?;
    let up = UpAxis::guess(take, &known).ok_or(CoreError::NoBodyFrame)?;
    BodyFrame::estimate(take, &markers, up)
}
