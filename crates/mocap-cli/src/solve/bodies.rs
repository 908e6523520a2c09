//! The body that a take is solved for.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use anyhow::{Context, Result, bail};
use clap::Args;
use mocap_core::{Motion, RigidTransform, Take};
use mocap_io::{Format, MarkerFile, MotionFile};
use solve_ik::{Body, IkError, IkParams, IkSolver};

use super::to_y_up;
use crate::files::{ReadArgs, frames};

/// Which body, and how it comes to fit the wearer.
#[derive(Debug, Args)]
#[command(next_help_heading = "Body")]
pub(crate) struct BodyArgs {
    /// Body to solve for: `generic` (the built-in one that knows most of the markers), cmu-41, front_waist-53,
    /// production-57, a body file (.body), or a skeleton (.asf, .amc, .bvh) whose bones are known
    #[arg(long, value_name = "FILE|NAME", default_value = GENERIC)]
    pub(super) skeleton: String,
    /// Learn bones and places of markers from another take of the wearer whose motion is known
    #[arg(long, value_name = "TAKE", requires = "motion")]
    learn_from: Option<PathBuf>,
    /// The motion of that take (.amc, .bvh); the skeleton of an .amc is the .asf beside it, or --skeleton
    #[arg(long, value_name = "FILE", requires = "learn_from")]
    motion: Option<PathBuf>,
    /// Fit the body on these frames alone, both included, as the file counts them: a range of motion (`1..600`); poses
    /// that differ tell where joints are
    #[arg(long, value_name = "A..B", conflicts_with_all = ["learn_from", "no_calibration"])]
    calibrate_on: Option<String>,
    /// Fit the body on these frames alone, in which the wearer stands still with legs straight and arms straight out to the
    /// sides (`t-pose` lines of a body file say how joints are turned then)
    #[arg(
        long, value_name = "A..B",
        conflicts_with_all = ["learn_from", "no_calibration", "calibrate_on"]
    )]
    t_pose: Option<String>,
    /// Take the body as it is, without fitting it to the wearer
    #[arg(long)]
    no_calibration: bool,
}

const GENERIC: &str = "generic";

impl BodyArgs {
    /// Files that outputs must not replace.
    pub(super) fn inputs(&self) -> impl Iterator<Item = &Path> {
        let named = [self.learn_from.as_deref(), self.motion.as_deref()];
        named.into_iter().flatten().chain([Path::new(&self.skeleton)])
    }

    /// The solver for a take, with the body that the options ask for.
    pub(super) fn solver(&self, file: &MarkerFile, read: &ReadArgs) -> Result<IkSolver> {
        let as_it_is = IkParams { calibration_rounds: 0, ..IkParams::default() };
        let take = file.take();
        if let (Some(learn_from), Some(motion)) = (&self.learn_from, &self.motion) {
            let body = self.learnt(learn_from, motion, read)?;
            return Ok(IkSolver::new(body, as_it_is)?);
        }
        let body = self.named(take, read)?;
        if self.no_calibration {
            return Ok(IkSolver::new(body, as_it_is)?);
        }
        let solver = IkSolver::new(body, IkParams::default())?;
        let Some(range) = self.calibrate_on.as_ref().or(self.t_pose.as_ref()) else {
            return Ok(solver);
        };
        let range = if range.contains("..") { range.clone() } else { format!("{range}..{range}") };
        let chosen = frames(&range, file.info().first_frame, take)?;
        let body = if self.t_pose.is_some() {
            solver.calibrate_in_t_pose(take, chosen)
        } else {
            solver.calibrate_on(take, chosen)
        };
        let body = body.with_context(|| format!("cannot fit the body on frames {range}"))?;
        Ok(IkSolver::new(body, as_it_is)?)
    }

    /// The body that `--skeleton` names.
    fn named(&self, take: &Take, read: &ReadArgs) -> Result<Body> {
        let name = &self.skeleton;
        if let Some(body) = built_in(name, take) {
            return Ok(body);
        }
        let path = Path::new(name);
        match Format::of(path) {
            Some(format) if !format.holds_markers() => {
                let file = MotionFile::read(path, None, &read.options())?;
                let skeleton = file.motion().skeleton();
                first_that_fits(take, |body| body.on(Arc::clone(skeleton)))
                    .with_context(|| format!("{name} fits no built-in body"))
            }
            Some(_) => {
                bail!("{name} holds markers; a skeleton is an .asf, .amc, .bvh or .body file")
            }
            None => {
                let text = std::fs::read_to_string(path).with_context(|| {
                    let names: Vec<String> =
                        Body::built_in().iter().map(|b| b.name().to_owned()).collect();
                    format!("cannot read the body {name}; built-in ones are {}", names.join(", "))
                })?;
                Ok(Body::parse(&text, name)?)
            }
        }
    }

    /// The body that a take and its motion show.
    fn learnt(&self, learn_from: &Path, motion: &Path, read: &ReadArgs) -> Result<Body> {
        let file = read.read(learn_from)?;
        let take = file.take();
        let is_skeleton = Format::of(Path::new(&self.skeleton)) == Some(Format::Asf);
        let asf = is_skeleton.then(|| Path::new(&self.skeleton));
        let moved = MotionFile::read(motion, asf, &read.options())?;
        let motions = [from_y_up(moved.motion())?, moved.motion().clone()];
        let worn = |body: Body| {
            // Motion files have y up, and recordings often z.
            let [first, second] = &motions;
            body.clone().worn(take, first).or_else(|error| match error {
                IkError::Apart { .. } => body.worn(take, second),
                other => Err(other),
            })
        };
        let learnt = if is_skeleton || self.skeleton == GENERIC {
            first_that_fits(take, worn)
        } else {
            Ok(worn(self.named(take, read)?)?)
        };
        learnt.with_context(|| {
            format!("{} and {} teach no body", learn_from.display(), motion.display())
        })
    }
}

/// The built-in body of a name.
fn built_in(name: &str, take: &Take) -> Option<Body> {
    let mut bodies = Body::for_markers(Body::built_in(), take.markers()).into_iter();
    if name == GENERIC { bodies.next() } else { bodies.find(|body| body.name() == name) }
}

/// The first built-in body that can be changed so, those that know most of the markers before others.
fn first_that_fits(take: &Take, change: impl Fn(Body) -> Result<Body, IkError>) -> Result<Body> {
    let mut refused = None;
    for body in Body::for_markers(Body::built_in(), take.markers()) {
        match change(body) {
            Ok(body) => return Ok(body),
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    Err(refused.context("there are built-in bodies")?.into())
}

/// The motion with y up turned to z up.
fn from_y_up(motion: &Motion) -> Result<Motion> {
    let rotation = to_y_up()?.inverse();
    Ok(motion.transformed(&RigidTransform { rotation, translation: [0.0; 3] })?)
}
