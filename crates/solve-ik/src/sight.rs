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
}

impl Sight {
    pub(crate) fn new(take: &Take, tree: &Tree) -> Self {
        let mut sight = Self { starts: vec![0], seen: Vec::new(), roots: Vec::new() };
        for frame in 0..take.frames() {
            let mut roots = 0;
            for (index, anchor) in (0..).zip(&tree.anchors) {
                let Some(at) = take.position(frame, anchor.column) else { continue };
                sight.seen.push((index, at));
                roots += u32::from(anchor.is_on_root());
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

    /// The earliest of the frames that show most, among those that tell where the body is.
    pub(crate) fn clearest(&self) -> Option<usize> {
        (0..self.frames())
            .filter(|&frame| self.finds_root(frame))
            .max_by_key(|&frame| (self.at(frame).len(), std::cmp::Reverse(frame)))
    }
}
