//! Which shared unknown is what, what is expected of it, and which rows of a frame's equations it appears in.

use mocap_core::geometry::{add, dot, scale, sub, times};
use rayon::prelude::*;

use super::{Firmness, Sample};
use crate::{
    IkParams,
    body::Body,
    frame::FrameSolver,
    tree::{Anchor, Tree},
};

pub(super) type Matrix = [[f64; 3]; 3];

/// Frames that say as much as one about where a joint or a marker is, if there are so many: skin slides with the pose, and so
/// the markers of many frames miss in the same way.
const ALIKE: f64 = 20.0;
/// Spread of a joint's place across its bone over that along it: people differ in lengths rather than in directions.
const ACROSS: f64 = 0.25;

/// The shared unknowns in blocks of three numbers: places of joints, then places of markers.
pub(super) struct Layout {
    /// Block of each joint's offset.
    offsets: Vec<Option<usize>>,
    /// First block of the markers' places.
    places: usize,
    /// Expected value and weights of each block.
    pub(super) expected: Vec<([f64; 3], Matrix)>,
    /// Rows of a frame's equations that each block appears in, from the leaves to the root.
    pub(super) rows: Vec<Vec<usize>>,
    /// Where a block's rows start if those of all blocks are written one after the other; one more than blocks.
    pub(super) starts: Vec<usize>,
    /// For each block and row, which one of the block's rows that is.
    slots: Vec<Option<usize>>,
    row_count: usize,
}

impl Layout {
    pub(super) fn new(tree: &Tree, template: &Tree, body: &Body, samples: usize) -> Self {
        let alike = ALIKE.min(samples as f64);
        let mut expected = Vec::new();
        let mut offsets = vec![None; tree.len()];
        if body.bone_spread > 0.0 {
            let along = alike * body.bone_spread.powi(-2);
            let across = alike * (ACROSS * body.bone_spread).powi(-2);
            // The root's own offset is part of its translation.
            for (j, offset) in offsets.iter_mut().enumerate().skip(1) {
                *offset = Some(expected.len());
                let bone = template.offsets[j];
                expected.push((bone, weights(bone, along, across)));
            }
        }
        let places = expected.len();
        let site = |a: &Anchor| {
            let weight = alike * body.sites[a.site].spread.powi(-2);
            (a.place, weights(a.place, weight, weight))
        };
        expected.extend(template.anchors.iter().map(site));
        let row_count = tree.len() + 1;
        let mut layout = Self {
            offsets,
            places,
            rows: Vec::new(),
            starts: vec![0],
            slots: vec![None; expected.len() * row_count],
            row_count,
            expected,
        };
        layout.find_rows(tree);
        layout
    }

    /// A marker moves with the root's shift, row 0, and the turns of the joints above it; so does each unknown it depends on.
    fn find_rows(&mut self, tree: &Tree) {
        let mut is_used = vec![false; self.slots.len()];
        for (index, anchor) in tree.anchors.iter().enumerate() {
            let turns = tree.movers(anchor).map(|joint| joint + 1);
            let rows: Vec<usize> = turns.chain([0]).collect();
            for block in self.blocks(tree, index) {
                for row in &rows {
                    is_used[block * self.row_count + row] = true;
                }
            }
        }
        for block in 0..self.expected.len() {
            let first = block * self.row_count;
            let rows = (0..self.row_count).rev().filter(|row| is_used[first + row]);
            let rows: Vec<usize> = rows.collect();
            rows.iter().enumerate().for_each(|(k, row)| self.slots[first + row] = Some(k));
            self.starts.push(self.starts[block] + rows.len());
            self.rows.push(rows);
        }
    }

    /// Blocks that a marker depends on: its own last.
    fn blocks(&self, tree: &Tree, anchor: usize) -> Vec<usize> {
        let joints = tree.movers(&tree.anchors[anchor]);
        joints.filter_map(|joint| self.offsets[joint]).chain([self.places + anchor]).collect()
    }

    /// Where a row of a block stands if all rows of all blocks are written one after the other.
    #[inline]
    pub(super) fn at(&self, block: usize, row: usize) -> Option<usize> {
        Some(self.starts[block] + self.slots[block * self.row_count + row]?)
    }

    /// Pairs of places at which two blocks have the same row, for each pair of blocks `(i, j ≤ i)`, row by row.
    pub(super) fn meetings(&self) -> Vec<Vec<(usize, usize)>> {
        let pairs = (0..self.expected.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
        let meet = |(i, j): (usize, usize)| {
            let both = |&row: &usize| Some((self.at(i, row)?, self.at(j, row)?));
            self.rows[i].iter().filter_map(both).collect()
        };
        pairs.map(meet).collect()
    }

    pub(super) fn value(&self, tree: &Tree, block: usize) -> [f64; 3] {
        if block >= self.places {
            return tree.anchors[block - self.places].place;
        }
        // Joints come in order, the root left out.
        tree.offsets[block + 1]
    }

    /// The tree after a step of the shared unknowns.
    pub(super) fn moved(&self, tree: &Tree, by: &[[f64; 3]]) -> Tree {
        let mut next = tree.clone();
        for (offset, block) in next.offsets.iter_mut().zip(&self.offsets) {
            if let Some(block) = *block {
                *offset = add(*offset, by[block]);
            }
        }
        for (anchor, by) in next.anchors.iter_mut().zip(&by[self.places..]) {
            anchor.place = add(anchor.place, *by);
        }
        next
    }

    pub(super) fn cost(&self, tree: &Tree, samples: &[Sample], params: &IkParams) -> f64 {
        let prior: f64 = (0..self.expected.len())
            .map(|block| {
                let off = sub(self.value(tree, block), self.expected[block].0);
                dot(off, times(&self.expected[block].1, off))
            })
            .sum();
        let weights = Firmness::of(tree);
        let costs: Vec<f64> = samples
            .par_iter()
            .map_init(
                || FrameSolver::new(tree, params),
                |solver, sample| solver.cost(&sample.state, &sample.seen, &weights.ties(sample)),
            )
            .collect();
        prior + costs.iter().sum::<f64>()
    }

    /// How a marker moves with each shared unknown that it depends on.
    pub(super) fn slopes(
        &self,
        tree: &Tree,
        solver: &FrameSolver<'_>,
        anchor: usize,
    ) -> Vec<(usize, Matrix)> {
        let placed = &solver.placed;
        let marker = &tree.anchors[anchor];
        let near = placed[marker.near].axes;
        let mut slopes = Vec::new();
        let mut own = near;
        if let Some((far, share)) = marker.far {
            let pulled = placed[far].axes;
            own = std::array::from_fn(|r| add(near[r], scale(share, sub(pulled[r], near[r]))));
            if let Some(block) = self.offsets[far] {
                slopes.push((block, std::array::from_fn(|r| sub(near[r], own[r]))));
            }
        }
        let mut j = marker.near;
        while j > 0 {
            if let Some(block) = self.offsets[j] {
                slopes.push((block, placed[tree.parents[j]].axes));
            }
            j = tree.parents[j];
        }
        slopes.push((self.places + anchor, own));
        slopes
    }
}

/// Weights of a vector along a direction and across it.
fn weights(direction: [f64; 3], along: f64, across: f64) -> Matrix {
    let square = dot(direction, direction).max(f64::MIN_POSITIVE);
    std::array::from_fn(|r| {
        std::array::from_fn(|c| {
            let both = if r == c { across } else { 0.0 };
            both + (along - across) * direction[r] * direction[c] / square
        })
    })
}
