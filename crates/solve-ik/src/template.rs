//! A body from a pose whose joint angles are known.

use std::ops::Range;

use mocap_core::{
    Rotation, Take,
    geometry::{add, distance, scale, sub, times, transposed},
};

use crate::{
    Body, IkError, IkSolver,
    calibrate::{self, Sample},
    frame::Seen,
    size,
    start::root_fit,
    tree::{Placed, State, Tree},
};

/// A marker that moves by more is not still, in metres.
const STILL_M: f64 = 0.03;
/// A marker farther from where the pose of a body of the wearer's size has it is not in the pose, in metres.
const IN_POSE_M: f64 = 0.25;
/// Standard deviation of the places that a pose gives, in metres.
const TOLD_M: f64 = 0.01;

impl IkSolver {
    /// The body of a wearer who stands still in a T-pose in these frames: legs straight, arms straight out to the sides.
    ///
    /// With the turns of the joints known, a frame tells lengths of bones and places of markers, where any other frame
    /// leaves open whether a joint is turned or a marker moved. The places count as good to a centimetre: calibration on a
    /// motion goes on from there.
    ///
    /// # Errors
    /// [`IkError::NoFrames`], [`IkError::NotStill`] and [`IkError::NotTPose`] for frames that do not show such a pose, and as
    /// [`calibrate`](Self::calibrate).
    pub fn calibrate_in_t_pose(&self, take: &Take, frames: Range<usize>) -> Result<Body, IkError> {
        if frames.is_empty() || frames.end > take.frames() {
            return Err(IkError::NoFrames);
        }
        let columns = self.columns(take)?;
        let mut places = Vec::with_capacity(columns.len());
        for column in &columns {
            places.push(match *column {
                Some(column) => still(take, column, &frames)?,
                None => None,
            });
        }
        let columns: Vec<Option<usize>> = columns
            .iter()
            .zip(&places)
            .map(|(column, place)| column.filter(|_| place.is_some()))
            .collect();
        let mut template = self.body().clone();
        let size = size::size(&template, &columns, take);
        if template.bone_spread > 0.0 {
            template = template.scaled(size)?;
        } else {
            template.scale_places(size);
        }
        let origin = Tree::new(&template, &columns);
        let seen: Vec<Seen> = (0..)
            .zip(&origin.anchors)
            .filter_map(|(index, anchor)| Some((index, places[anchor.site]?)))
            .collect();
        let lost = || IkError::RootNeverSeen { root: self.root().to_owned() };
        let state = in_pose(&origin, root_fit(&origin, &seen).ok_or_else(lost)?);
        let sample = Sample { seen, pose: Some(state.clone()), state };
        check(&origin, &sample, &template)?;
        let mut samples = [sample];
        let mut tree = origin.clone();
        calibrate::calibrate(&mut tree, &mut samples, &origin, &template, self.params());
        settle(&mut tree, &samples[0]);
        let mut body = calibrate::dressed(&template, &origin, &tree)?;
        for anchor in &tree.anchors {
            body.sites[anchor.site].spread = TOLD_M;
        }
        Ok(body)
    }
}

/// Mean place of a marker over frames in which it stands still; `None` if they do not show it.
fn still(take: &Take, column: usize, frames: &Range<usize>) -> Result<Option<[f64; 3]>, IkError> {
    let seen: Vec<[f64; 3]> = frames.clone().filter_map(|t| take.position(t, column)).collect();
    if seen.is_empty() {
        return Ok(None);
    }
    let share = 1.0 / seen.len() as f64;
    let mean = scale(share, seen.iter().copied().fold([0.0; 3], add));
    let square: f64 = seen.iter().map(|p| distance(*p, mean).powi(2)).sum();
    let moves_m = (share * square).sqrt();
    if moves_m > STILL_M {
        let marker = take.markers().name(column).to_owned();
        return Err(IkError::NotStill { marker, moves_m });
    }
    Ok(Some(mean))
}

fn in_pose(tree: &Tree, mut state: State) -> State {
    for (turn, habit) in state.turns.iter_mut().zip(&tree.habits).skip(1) {
        *turn = Rotation::exp(habit.t_pose);
    }
    state
}

/// Puts each marker exactly where it is seen.
fn settle(tree: &mut Tree, sample: &Sample) {
    let mut placed = vec![Placed::NOWHERE; tree.len()];
    tree.place(&sample.state, &mut placed);
    for &(index, at) in &sample.seen {
        let anchor = tree.anchors[index as usize];
        let miss = sub(at, tree.marker(&anchor, &placed));
        // A marker between two joints follows the first one nearly as much as both in a pose that hardly bends them.
        let local = times(&transposed(&placed[anchor.near].axes), miss);
        tree.anchors[index as usize].place = add(anchor.place, local);
    }
}

/// Refuses frames in which a marker is nowhere near where the pose would have it.
fn check(tree: &Tree, sample: &Sample, body: &Body) -> Result<(), IkError> {
    let mut placed = vec![Placed::NOWHERE; tree.len()];
    tree.place(&sample.state, &mut placed);
    let off = |&(index, at): &Seen| {
        let anchor = &tree.anchors[index as usize];
        (anchor.site, distance(at, tree.marker(anchor, &placed)))
    };
    match sample.seen.iter().map(off).max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((site, off_m)) if off_m > IN_POSE_M => {
            Err(IkError::NotTPose { marker: body.sites[site].marker.clone(), off_m })
        }
        _ => Ok(()),
    }
}
