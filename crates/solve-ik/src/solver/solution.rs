use std::sync::Arc;

use mocap_core::{Motion, Take, Termination, geometry::dot};
use ndarray::Array3;

use super::{Outcome, Ready};
use crate::{
    IkError,
    body::Body,
    tree::{Placed, State, Tree},
};

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

pub(super) fn finish(take: &Take, ready: Ready, outcome: &Outcome) -> Result<Solution, IkError> {
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

/// Expected markers `(T, M, 3)` in metres, NaN for those that no anchor has.
fn expected(tree: &Tree, states: &[State], markers: usize) -> Array3<f64> {
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
