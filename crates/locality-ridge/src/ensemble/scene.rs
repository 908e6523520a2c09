//! The frames of a gap in one view: features of the neighbours, and the target, in a local frame.

use std::rc::Rc;

use mocap_core::Take;

use super::{
    features::groups, frames::Frames, kernel::Side, session::Session, tile::Panel, variant::View,
};
use crate::frame::LocalFrame;

/// What to learn from, and for which frames.
#[derive(Clone, Copy)]
pub(super) struct Sample<'a> {
    pub take: &'a Take,
    /// Whose joined takes `take` is, if it is.
    pub session: Option<&'a Session>,
    pub target: usize,
    /// Neighbours seen in all frames below, steadiest first, with the spread of their distance in metres.
    pub neighbours: &'a [(usize, f64)],
    /// Frames that show the target and its neighbours.
    pub rows: &'a [usize],
    /// The row whose pose local frames refer to.
    pub reference: usize,
    /// Frames to predict.
    pub wanted: &'a [usize],
}

/// Features of the neighbours in local frames.
pub(super) struct Scene {
    pub frames: Rc<Frames>,
    rows: Features,
    wanted: Features,
    /// Inner products of the rows' features.
    within: Panel,
    /// Those of wanted frames with rows.
    between: Panel,
}

/// Frames with the squared lengths of their features.
struct Features {
    frames: Vec<usize>,
    squares: Vec<f64>,
}

impl Features {
    fn of(frames: &[usize], session: Option<&Session>, x: &Panel) -> Self {
        let square = |i: usize| x.row(i).iter().map(|c| c * c).sum();
        let time = |&t: &usize| session.map_or(t, |session| session.clock(t));
        Self {
            frames: frames.iter().map(time).collect(),
            squares: (0..frames.len()).map(square).collect(),
        }
    }

    fn side(&self) -> Side<'_> {
        Side { frames: &self.frames, squares: &self.squares }
    }
}

impl Scene {
    pub fn new(sample: &Sample<'_>, frames: Rc<Frames>, view: View) -> Self {
        let regressors = &sample.neighbours[..view.regressors.min(sample.neighbours.len())];
        let groups = groups(regressors, view);
        let columns = groups.last().map_or(0, |group| group.columns.end);
        let features = |of: &[usize], local: &[LocalFrame]| {
            let mut x = Panel::zeros(of.len(), columns);
            for (i, (&t, frame)) in of.iter().zip(local).enumerate() {
                for group in &groups {
                    let cells = x.row_mut(i)[group.columns.clone()].chunks_exact_mut(3);
                    group.what.write(cells, sample.take, regressors, &frames.core, t, *frame);
                }
            }
            x
        };
        let mut x = features(sample.rows, &frames.rows);
        let mut z = features(sample.wanted, &frames.wanted);
        for group in &groups {
            group.standardise(&mut x, &mut z, sample.reference);
        }
        Self {
            within: x.products(&x, true),
            between: z.products(&x, false),
            rows: Features::of(sample.rows, sample.session, &x),
            wanted: Features::of(sample.wanted, sample.session, &z),
            frames,
        }
    }

    pub fn rows(&self) -> Side<'_> {
        self.rows.side()
    }

    pub fn wanted(&self) -> Side<'_> {
        self.wanted.side()
    }

    /// Inner products of rows with rows: the lower triangle.
    pub fn within(&self) -> &Panel {
        &self.within
    }

    /// Inner products of wanted frames with rows.
    pub fn between(&self) -> &Panel {
        &self.between
    }

    /// No two frames are so many frames apart.
    pub fn lags(&self) -> usize {
        let frames = || self.rows.frames.iter().chain(&self.wanted.frames);
        let (first, last) = (frames().min(), frames().max());
        first.zip(last).map_or(0, |(first, last)| last - first + 1)
    }
}
