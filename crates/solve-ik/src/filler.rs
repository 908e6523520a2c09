use std::ops::ControlFlow;

use mocap_core::{
    Estimates, FillError, FillReport, Filled, Gap, GapFiller, IterReport, Refusal, Take,
    Termination,
    geometry::{add, scale, sub, times, transposed},
};
use ndarray::Array3;

use crate::{
    Body, IkError, IkParams, IkSolver,
    solver::{Outcome, Ready, Weights},
    tree::{Anchor, Placed},
};

/// Fills gaps with the markers that the solved body would show: the kinematic fill.
///
/// Joints that no marker shows turn as they did in similar postures of the seen ones elsewhere in the take.
///
/// By how much a marker misses its expected place beside a gap, seen from its bone, is carried across the gap, so that
/// fills join the measured samples. Markers that the body's map does not know ride on the joint from which they look
/// steadiest.
#[derive(Debug, Clone)]
pub struct IkFiller {
    bodies: Vec<Body>,
    params: IkParams,
}

impl IkFiller {
    /// A filler for takes of any of these bodies: the one that knows most markers of a take and whose root it shows.
    ///
    /// # Errors
    /// [`IkError::Parameter`].
    pub fn new(bodies: Vec<Body>, params: IkParams) -> Result<Self, IkError> {
        params.check()?;
        Ok(Self { bodies, params })
    }

    fn solve(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<(Ready, Outcome), IkError> {
        let mut first = None;
        for body in Body::for_markers(self.bodies.clone(), take.markers()) {
            let solver = IkSolver::new(body, self.params)?;
            // Where a limb is gone, the joints it hung on are found as well without.
            match solver.prepare(take, Weights::Alike) {
                Ok(ready) => {
                    let outcome = ready.poses(&self.params, take.rate_hz(), observer);
                    return Ok((ready, outcome));
                }
                Err(error) => first = first.or(Some(error)),
            }
        }
        Err(first.unwrap_or(IkError::NoBody))
    }
}

impl GapFiller for IkFiller {
    fn name(&self) -> &'static str {
        "ik"
    }

    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        if take.observed().count() == 0 {
            return Err(FillError::NothingObserved);
        }
        let gaps = take.gaps();
        if gaps.is_empty() {
            let report = FillReport::new(self.name(), Termination::NothingToFill);
            return Ok(Filled::unchanged(take, report)?);
        }
        let failed = |source: IkError| FillError::Method { method: "ik", source: Box::new(source) };
        let (ready, outcome) = self.solve(take, observer).map_err(failed)?;
        let riders = Riders::new(take, &ready, &outcome);
        let mut positions = Array3::from_elem(take.positions().dim(), f64::NAN);
        let mut refused = Vec::new();
        for gap in gaps {
            if !riders.fill(take, &gap, &mut positions) {
                refused.push(gap);
            }
        }
        let mut report = FillReport::new(self.name(), outcome.termination);
        report.iterations = outcome.steps();
        let mut filled = Filled::merge(take, Estimates { positions, sigma_m: None }, report)?;
        for gap in refused {
            filled = filled.refuse(gap, Refusal::NeverSeen)?;
        }
        Ok(filled)
    }
}

/// The joints over time, and the markers on them.
struct Riders {
    /// One row of joints a frame.
    placed: Vec<Vec<Placed>>,
    /// By column of the take.
    anchors: Vec<Option<Anchor>>,
    tree: crate::tree::Tree,
}

impl Riders {
    fn new(take: &Take, ready: &Ready, outcome: &Outcome) -> Self {
        let tree = ready.tree.clone();
        let place = |state| {
            let mut placed = vec![Placed::NOWHERE; tree.len()];
            tree.place(state, &mut placed);
            placed
        };
        let placed: Vec<Vec<Placed>> = outcome.track.states.iter().map(place).collect();
        let mut anchors = vec![None; take.marker_count()];
        for anchor in &tree.anchors {
            anchors[anchor.column] = Some(*anchor);
        }
        for (column, anchor) in anchors.iter_mut().enumerate() {
            if anchor.is_none() {
                *anchor = steadiest(take, column, &placed);
            }
        }
        Self { placed, anchors, tree }
    }

    /// Fills a gap; `false` if its marker is never seen.
    fn fill(&self, take: &Take, gap: &Gap, positions: &mut Array3<f64>) -> bool {
        let Some(anchor) = self.anchors[gap.marker] else { return false };
        let axes = |frame: usize| &self.placed[frame][anchor.near].axes;
        // How far the marker is from its expected place, seen from its bone.
        let off = |frame: Option<usize>| {
            let frame = frame.filter(|&t| t < take.frames())?;
            let at = take.position(frame, gap.marker)?;
            let miss = sub(at, self.tree.marker(&anchor, &self.placed[frame]));
            Some(times(&transposed(axes(frame)), miss))
        };
        let (before, after) = (off(gap.frames.start.checked_sub(1)), off(Some(gap.frames.end)));
        for frame in gap.frames.clone() {
            let share = (frame + 1 - gap.frames.start) as f64 / (gap.len() + 1) as f64;
            let off = match (before, after) {
                (Some(p), Some(q)) => add(scale(1.0 - share, p), scale(share, q)),
                (Some(only), None) | (None, Some(only)) => only,
                (None, None) => [0.0; 3],
            };
            let at = add(self.tree.marker(&anchor, &self.placed[frame]), times(axes(frame), off));
            (0..3).for_each(|a| positions[(frame, gap.marker, a)] = at[a]);
        }
        true
    }
}

/// Puts a marker that the map does not know on the joint from which its place varies least.
fn steadiest(take: &Take, column: usize, placed: &[Vec<Placed>]) -> Option<Anchor> {
    let seen: Vec<(usize, [f64; 3])> =
        (0..take.frames()).filter_map(|t| Some((t, take.position(t, column)?))).collect();
    let share = 1.0 / seen.len() as f64;
    let on = |joint: usize| {
        let local = |&(t, at): &(usize, [f64; 3])| {
            let joint = &placed[t][joint];
            times(&transposed(&joint.axes), sub(at, joint.origin))
        };
        let mean = scale(share, seen.iter().map(local).fold([0.0; 3], add));
        let spread =
            seen.iter().map(|s| sub(local(s), mean)).map(|d| d.iter().map(|c| c * c).sum::<f64>());
        (spread.sum::<f64>(), mean)
    };
    let joints = placed.first().filter(|_| !seen.is_empty())?.len();
    let best = (0..joints).map(|j| (j, on(j))).min_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    let (near, (_, place)) = best;
    Some(Anchor { column, site: usize::MAX, near, far: None, place, grip: 1.0 })
}
