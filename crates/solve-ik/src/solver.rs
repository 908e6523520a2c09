use std::{
    ops::{ControlFlow, Range},
    sync::Arc,
};

use mocap_core::{IterReport, MarkerSet, MotionSolver, Skeleton, SolveError, Solved, Take};
use ndarray::s;

use crate::{
    IkError, IkParams,
    body::Body,
    calibrate::{self, Calibrated},
    choose::diverse,
    grip,
    sight::Sight,
    size,
    track::{self, Scout},
    tree::Tree,
};

mod ready;
mod solution;

pub(crate) use ready::{Outcome, Ready};
pub use solution::{CalibrationRound, Solution};

/// What markers weigh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weights {
    /// Each as much as its misses say.
    Own,
    Alike,
}

/// Solves labelled takes into the motion of a body.
#[derive(Debug, Clone)]
pub struct IkSolver {
    body: Body,
    params: IkParams,
}

impl IkSolver {
    /// A solver for takes of this body.
    ///
    /// # Errors
    /// [`IkError::Parameter`].
    pub fn new(body: Body, params: IkParams) -> Result<Self, IkError> {
        params.check()?;
        Ok(Self { body, params })
    }

    /// The body, as it was given.
    #[must_use]
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &IkParams {
        &self.params
    }

    /// The body fitted to the wearer of a take: lengths of bones, unless they are known, and places of markers.
    ///
    /// # Errors
    /// [`IkError`] where the take does not tell where the body is.
    pub fn calibrate(&self, take: &Take) -> Result<Body, IkError> {
        Ok(self.prepare(take, Weights::Own)?.body)
    }

    /// The body fitted to the wearer on some frames of a take, such as a T-pose or a range of motion.
    ///
    /// # Errors
    /// [`IkError::NoFrames`] for a range without frames or beyond the take, and as [`calibrate`](Self::calibrate).
    pub fn calibrate_on(&self, take: &Take, frames: Range<usize>) -> Result<Body, IkError> {
        if frames.is_empty() || frames.end > take.frames() {
            return Err(IkError::NoFrames);
        }
        let part = take.positions().slice(s![frames, .., ..]).to_owned();
        self.calibrate(&Take::from_positions(Arc::clone(take.markers()), take.rate_hz(), part)?)
    }

    /// Refuses a take with markers that the body's map does not know. Solving leaves them out, and
    /// [`Solution::unmapped`] names them.
    ///
    /// # Errors
    /// [`IkError::Unmapped`] with their labels, and [`IkError::TwoLabels`].
    pub fn check_markers(&self, take: &Take) -> Result<(), IkError> {
        let mapped = self.body.columns(take.markers())?;
        let unknown: Vec<&str> = (0..take.marker_count())
            .filter(|&m| !mapped.contains(&Some(m)))
            .map(|m| take.markers().name(m))
            .collect();
        if unknown.is_empty() {
            return Ok(());
        }
        Err(IkError::Unmapped { body: self.body.name.clone(), labels: listed(unknown) })
    }

    /// Solves every frame and tells `observer` of finished ones, which may stop the work; frames that are left
    /// keep the pose of the nearest frame that was looked at before.
    ///
    /// # Errors
    /// [`IkError`] where the take does not tell where the body is.
    pub fn solve_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Solution, IkError> {
        let ready = self.prepare(take, Weights::Own)?;
        let outcome = ready.poses(&self.params, take.rate_hz(), observer);
        solution::finish(take, ready, &outcome)
    }

    /// Solves every frame.
    ///
    /// # Errors
    /// As [`solve_observed`](Self::solve_observed).
    pub fn solve(&self, take: &Take) -> Result<Solution, IkError> {
        self.solve_observed(take, &mut |_| ControlFlow::Continue(()))
    }

    pub(crate) fn prepare(&self, take: &Take, weights: Weights) -> Result<Ready, IkError> {
        if take.frames() == 0 {
            return Err(IkError::NoFrames);
        }
        let columns = self.columns(take)?;
        let size = size::size(&self.body, &columns, take);
        let mut template = self.body.clone();
        if self.params.calibration_rounds > 0 {
            if template.bone_spread > 0.0 {
                template = template.scaled(size)?;
            } else {
                template.scale_places(size);
            }
        }
        let origin = Tree::new(&template, &columns);
        let sight = Sight::new(take, &origin);
        let mut body = template.clone();
        let mut tree = origin.clone();
        let mut rounds = Vec::new();
        let lost = || IkError::RootNeverSeen { root: self.root().to_owned() };
        let look =
            |tree: &Tree| track::scout(tree, &sight, &self.params, take.rate_hz()).ok_or_else(lost);
        let mut scout = look(&tree)?;
        let weigh = |tree: &mut Tree, scout: &Scout| match weights {
            Weights::Own => grip::weigh(tree, &sight, scout, &self.params),
            Weights::Alike => (),
        };
        if self.params.calibration_rounds == 0 {
            weigh(&mut tree, &scout);
        }
        for _ in 0..self.params.calibration_rounds {
            let mut samples = diverse(&scout, &sight, self.params.calibration_frames);
            let before = tree.clone();
            let Calibrated { cost, steps } =
                calibrate::calibrate(&mut tree, &mut samples, &origin, &template, &self.params);
            body = calibrate::dressed(&body, &before, &tree)?;
            rounds.push(CalibrationRound { frames: samples.len(), steps, cost });
            scout = look(&tree)?;
            weigh(&mut tree, &scout);
        }
        Ok(Ready { body, tree, sight, scout, rounds })
    }

    /// Column of each marker of the body that the take shows.
    pub(crate) fn columns(&self, take: &Take) -> Result<Vec<Option<usize>>, IkError> {
        let columns = self.body.columns(take.markers())?;
        // A marker that is never seen says nothing of its joint.
        let is_seen = |column: usize| (0..take.frames()).any(|t| take.is_observed(t, column));
        let columns: Vec<Option<usize>> =
            columns.into_iter().map(|c| c.filter(|&c| is_seen(c))).collect();
        self.check_root(&columns, take.markers())?;
        Ok(columns)
    }

    pub(crate) fn root(&self) -> &str {
        &self.body.skeleton.joints()[0].name
    }

    fn check_root(&self, columns: &[Option<usize>], markers: &MarkerSet) -> Result<(), IkError> {
        let tree = Tree::new(&self.body, columns);
        let found = tree.anchors.iter().filter(|a| a.is_on_root()).count();
        if found >= 3 {
            return Ok(());
        }
        let all: Vec<Option<usize>> = (0..columns.len()).map(Some).collect();
        let full = Tree::new(&self.body, &all);
        let on_root = full.anchors.iter().filter(|a| a.is_on_root());
        let wanted: Vec<&str> = on_root.map(|a| self.body.sites[a.site].marker.as_str()).collect();
        Err(IkError::RootMarkers {
            body: self.body.name.clone(),
            root: self.root().to_owned(),
            found,
            wanted: wanted.join(", "),
            labels: listed((0..markers.len()).map(|m| markers.name(m))),
        })
    }
}

/// The first labels, and how many more there are.
fn listed<'a>(labels: impl IntoIterator<Item = &'a str>) -> String {
    const LISTED: usize = 8;
    let labels: Vec<&str> = labels.into_iter().collect();
    let first = labels[..labels.len().min(LISTED)].join(", ");
    match labels.len().saturating_sub(LISTED) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

impl MotionSolver for IkSolver {
    fn name(&self) -> &'static str {
        "ik"
    }

    /// Solves with the markers of this solver's body on the given skeleton, whose bone lengths are taken as known.
    fn solve(&self, take: &Take, skeleton: &Skeleton) -> Result<Solved, SolveError> {
        let failed =
            |source: IkError| SolveError::Method { method: "ik", source: Box::new(source) };
        let body = self.body.clone().on(skeleton.clone()).map_err(failed)?;
        let solver = Self { body, params: self.params };
        let solution = Self::solve(&solver, take).map_err(failed)?;
        let Solution { motion, residual_m, termination, .. } = solution;
        Ok(Solved { motion, residual_m, termination })
    }
}
