//! What a take shows of a body, frame by frame.

use mocap_core::Take;

use crate::{frame::Seen, tree::Tree};

/// The mapped markers that each frame shows.
#[derive(Debug)]
pub(crate) struct Sight {
    starts: Vec<usize>,
    seen: Vec<Seen>,
    /// Markers of the root that each frame shows.
    roots: Vec<u32>,
    /// Whether a frame shows a marker that a joint moves, `(frames, joints)` row by row.
    shown: Vec<bool>,
    joints: usize,
}

impl Sight {
    pub(crate) fn new(take: &Take, tree: &Tree) -> Self {
        let joints = tree.len();
        let mut sight = Self {
            starts: vec![0],
            seen: Vec::new(),
            roots: Vec::new(),
            shown: vec![false; take.frames() * joints],
            joints,
        };
        for frame in 0..take.frames() {
            let mut roots = 0;
            for (index, anchor) in (0..).zip(&tree.anchors) {
                let Some(at) = take.position(frame, anchor.column) else { continue };
                sight.seen.push((index, at));
                roots += u32::from(anchor.is_on_root());
                let shown = &mut sight.shown[frame * joints..(frame + 1) * joints];
                tree.movers(anchor).for_each(|joint| shown[joint] = true);
            }
            sight.starts.push(sight.seen.len());
            sight.roots.push(roots);
        }
        sight
    }

    pub(crate) fn frames(&self) -> usize {
        self.roots.len()
    }

    pub(crate) fn at(&self, frame: usize) -> &[Seen] {
        &self.seen[self.starts[frame]..self.starts[frame + 1]]
    }

    /// Whether a frame tells by itself where the body is.
    pub(crate) fn finds_root(&self, frame: usize) -> bool {
        self.roots[frame] >= 3
    }

    /// Joints that a frame shows and another one does not.
    pub(crate) fn newly_shown(
        &self,
        frame: usize,
        than: usize,
    ) -> impl Iterator<Item = usize> + '_ {
        let row = |frame: usize| &self.shown[frame * self.joints..(frame + 1) * self.joints];
        let pairs = row(frame).iter().zip(row(than)).enumerate();
        pairs.filter(|(_, (here, there))| **here && !**there).map(|(joint, _)| joint)
    }

    /// The earliest of the frames that show most, among those that tell where the body is.
    pub(crate) fn clearest(&self) -> Option<usize> {
        (0..self.frames())
            .filter(|&frame| self.finds_root(frame))
            .max_by_key(|&frame| (self.at(frame).len(), std::cmp::Reverse(frame)))
    }
}
