use std::{
    ops::{ControlFlow, Range},
    sync::Arc,
};

use mocap_core::{
    IterReport, MarkerSet, Motion, MotionSolver, Skeleton, SolveError, Solved, Take, Termination,
    geometry::dot,
};
use ndarray::{Array3, s};

use crate::{
    IkError, IkParams,
    body::Body,
    bridge::Bridges,
    calibrate::{self, Calibrated},
    choose::diverse,
    frame::Fit,
    sight::Sight,
    size,
    track::{self, Inertia, Scout, Track},
    tree::{Placed, State, Tree},
};

/// Solves labelled takes into the motion of a body.
#[derive(Debug, Clone)]
pub struct IkSolver {
    body: Body,
    params: IkParams,
}

/// A solved take.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The body as calibrated for this take.
    pub body: Body,
    /// Its motion.
    pub motion: Motion,
    /// Where the mapped markers should be, `(T, M, 3)` in metres by the take's columns: clean, without gaps. NaN for
    /// markers that the map does not know or the take never shows.
    pub markers: Array3<f64>,
    /// Root mean square distance between measured and expected markers in metres, one a frame; NaN where a frame
    /// shows none.
    pub residual_m: Vec<f64>,
    /// Frames that were still moving after their last step.
    pub unconverged: usize,
    /// Steps of all frames together.
    pub steps: usize,
    /// Labels of the take that the map does not know.
    pub unmapped: Vec<String>,
    /// Rounds of calibration with their frames and steps.
    pub calibration: Vec<CalibrationRound>,
    /// Why the work ended.
    pub termination: Termination,
}

/// A round of calibration.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CalibrationRound {
    /// Frames used.
    pub frames: usize,
    /// Steps made.
    pub steps: usize,
    /// Cost in the end: squared misses over the spreads.
    pub cost: f64,
}

/// A body on a take, ready to be tracked.
pub(crate) struct Ready {
    pub(crate) body: Body,
    pub(crate) tree: Tree,
    pub(crate) sight: Sight,
    pub(crate) scout: Scout,
    pub(crate) rounds: Vec<CalibrationRound>,
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
        Ok(self.prepare(take)?.body)
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
        let ready = self.prepare(take)?;
        let outcome = ready.poses(&self.params, take.rate_hz(), observer);
        finish(take, ready, &outcome)
    }

    /// Solves every frame.
    ///
    /// # Errors
    /// As [`solve_observed`](Self::solve_observed).
    pub fn solve(&self, take: &Take) -> Result<Solution, IkError> {
        self.solve_observed(take, &mut |_| ControlFlow::Continue(()))
    }

    pub(crate) fn prepare(&self, take: &Take) -> Result<Ready, IkError> {
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
        for _ in 0..self.params.calibration_rounds {
            let mut samples = diverse(&scout, &sight, self.params.calibration_frames);
            let before = tree.clone();
            let Calibrated { cost, steps } =
                calibrate::calibrate(&mut tree, &mut samples, &origin, &template, &self.params);
            body = calibrate::dressed(&body, &before, &tree)?;
            rounds.push(CalibrationRound { frames: samples.len(), steps, cost });
            scout = look(&tree)?;
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

fn finish(take: &Take, ready: Ready, outcome: &Outcome) -> Result<Solution, IkError> {
    let Outcome { track, termination } = outcome;
    let Ready { body, tree, sight, rounds, .. } = ready;
    let skeleton = Arc::clone(&body.skeleton);
    let poses = track.states.iter().map(|state| tree.pose(state, &skeleton)).collect();
    let motion = Motion::new(skeleton, take.rate_hz(), poses)?;
    let markers = expected(&tree, &track.states, take.marker_count());
    let residual_m = (0..take.frames())
        .map(|frame| {
            let seen = sight.at(frame);
            let square = |&(anchor, at): &(u32, [f64; 3])| {
                let column = tree.anchors[anchor as usize].column;
                let off: [f64; 3] = std::array::from_fn(|a| markers[(frame, column, a)] - at[a]);
                dot(off, off)
            };
            (seen.iter().map(square).sum::<f64>() / seen.len() as f64).sqrt()
        })
        .collect();
    let mapped: Vec<usize> = tree.anchors.iter().map(|a| a.column).collect();
    let unmapped = (0..take.marker_count()).filter(|m| !mapped.contains(m));
    Ok(Solution {
        motion,
        markers,
        residual_m,
        unconverged: track.fits.iter().filter(|fit| !fit.converged).count(),
        steps: outcome.steps(),
        unmapped: unmapped.map(|m| take.markers().name(m).to_owned()).collect(),
        calibration: rounds,
        termination: *termination,
        body,
    })
}

/// Poses of a take, and why they ended.
pub(crate) struct Outcome {
    pub(crate) track: Track,
    pub(crate) termination: Termination,
}

impl Outcome {
    pub(crate) fn steps(&self) -> usize {
        self.track.fits.iter().map(|fit| fit.iterations).sum()
    }
}

impl Ready {
    /// Tracks every frame, and again those in which a joint is not seen, this time bridged.
    pub(crate) fn poses(
        &self,
        params: &IkParams,
        rate_hz: f64,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Outcome {
        let inertia = Inertia::new(params, rate_hz);
        let mut outcome = self.track(params, &inertia, observer);
        if outcome.termination == Termination::Stopped {
            return outcome;
        }
        let bridges =
            Bridges::new(&self.tree, &self.sight, &outcome.track.states, inertia, rate_hz);
        if let Some(bridges) = bridges {
            let redone = track::retrack(&self.tree, &self.sight, params, &outcome.track, &bridges);
            for (frame, state, fit) in redone {
                outcome.track.states[frame] = state;
                outcome.track.fits[frame] = fit;
            }
        }
        outcome
    }

    /// Tracks a batch of chunks at a time, so that the observer is asked in between.
    fn track(
        &self,
        params: &IkParams,
        inertia: &Inertia,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Outcome {
        let frames = self.sight.frames();
        let mut track =
            Track { states: Vec::with_capacity(frames), fits: Vec::with_capacity(frames) };
        let mut objective = 0.0;
        let mut termination = Termination::Converged;
        while track.states.len() < frames {
            let start = track.states.len();
            let end = (start + track::BATCH).min(frames);
            let part =
                track::track(&self.tree, &self.sight, params, &self.scout, inertia, start..end);
            objective += part.fits.iter().map(|fit| fit.cost).sum::<f64>();
            track.states.extend(part.states);
            track.fits.extend(part.fits);
            let report = IterReport { iteration: end, limit: frames, objective };
            if observer(&report).is_break() {
                termination = Termination::Stopped;
                break;
            }
        }
        let held = Fit { cost: f64::NAN, iterations: 0, converged: false };
        for frame in track.states.len()..frames {
            track.states.push(self.scout.states[frame / self.scout.stride].clone());
            track.fits.push(held);
        }
        Outcome { track, termination }
    }
}

/// Expected markers `(T, M, 3)` in metres, NaN for those that no anchor has.
pub(crate) fn expected(tree: &Tree, states: &[State], markers: usize) -> Array3<f64> {
    let mut expected = Array3::from_elem((states.len(), markers, 3), f64::NAN);
    let mut placed = vec![Placed::NOWHERE; tree.len()];
    for (frame, state) in states.iter().enumerate() {
        tree.place(state, &mut placed);
        for anchor in &tree.anchors {
            let at = tree.marker(anchor, &placed);
            (0..3).for_each(|a| expected[(frame, anchor.column, a)] = at[a]);
        }
    }
    expected
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
