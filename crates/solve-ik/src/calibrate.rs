//! Bone lengths and marker places of one body, from frames that differ.
//!
//! All of it is one least-squares problem: the shared unknowns s (a place a joint, a place a marker) and the poses p of some
//! frames. Given s, frames do not know of each other, so their normal equations are eliminated frame by frame,
//!
//! ```text
//! (Hss − Σ Hpsᵀ Hpp⁻¹ Hps) Δs = −gs + Σ Hpsᵀ Hpp⁻¹ gp
//! ```
//!
//! which moves bones, markers and poses together. Alternating between them crawls, because a joint that lies
//! wrong is made up for by turned poses.

use std::sync::Arc;

use mocap_core::{
    Skeleton,
    geometry::{add, cross, dot, scale, sub, times, transposed},
};
use rayon::prelude::*;

use crate::{
    IkError, IkParams,
    body::Body,
    dense::Cholesky,
    frame::{FrameSolver, Seen, Ties},
    tree::{State, Tree},
};

type Matrix = [[f64; 3]; 3];

/// Frames that say as much as one about where a joint or a marker is: skin slides with the pose, and so the markers of
/// many frames miss in the same way.
const ALIKE: f64 = 20.0;
/// Spread of a joint's place across its bone over that along it: people differ in lengths rather than in directions.
const ACROSS: f64 = 0.25;
/// Steps at most, and the share of the cost below which a step is the last.
const STEPS: usize = 25;
const ENOUGH: f64 = 1e-5;

/// A frame to calibrate on.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    pub(crate) seen: Vec<Seen>,
    pub(crate) state: State,
}

/// How a calibration ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Calibrated {
    pub(crate) cost: f64,
    pub(crate) steps: usize,
}

/// Adjusts the joints and markers of a tree, and the poses of the samples, to fit together; `template` is
/// where they are expected.
pub(crate) fn calibrate(
    tree: &mut Tree,
    samples: &mut [Sample],
    template: &Tree,
    body: &Body,
    params: &IkParams,
) -> Calibrated {
    let layout = Layout::new(tree, template, body);
    let mut cost = layout.cost(tree, samples, params);
    let mut damping = 1e-3;
    for step in 0..STEPS {
        let system = layout.system(tree, samples, params, damping);
        let next = system.and_then(|system| layout.advance(tree, samples, &system)).map(
            |(tree, samples)| {
                let cost = layout.cost(&tree, &samples, params);
                (tree, samples, cost)
            },
        );
        match next {
            Some((new_tree, new_samples, next)) if next < cost => {
                let gain = (cost - next) / cost;
                *tree = new_tree;
                samples.clone_from_slice(&new_samples);
                cost = next;
                damping = (damping * 0.1_f64).max(1e-9);
                if gain < ENOUGH {
                    return Calibrated { cost, steps: step + 1 };
                }
            }
            _ if damping > 1e3 => return Calibrated { cost, steps: step + 1 },
            _ => damping *= 10.0,
        }
    }
    Calibrated { cost, steps: STEPS }
}

/// Which shared unknown is what: three numbers a block.
struct Layout {
    /// Block of each joint's offset.
    offsets: Vec<Option<usize>>,
    /// First block of the markers' places.
    places: usize,
    /// Expected value and weights of each block.
    expected: Vec<([f64; 3], Matrix)>,
}

/// Reduced equations of the shared unknowns, solved, and what the frames need to follow.
struct System {
    shared: Vec<f64>,
    frames: Vec<FrameSystem>,
}

/// Lower triangle and gradient of the shared unknowns, once the pose is eliminated, and the way back to the pose.
type Eliminated = (Vec<f64>, Vec<f64>, FrameSystem);

struct FrameSystem {
    step: Vec<[f64; 3]>,
    /// Hpp⁻¹ Hps, one column of rows for each shared unknown.
    columns: Vec<Vec<[f64; 3]>>,
}

impl Layout {
    fn new(tree: &Tree, template: &Tree, body: &Body) -> Self {
        let mut expected = Vec::new();
        let mut offsets = vec![None; tree.len()];
        if body.bone_spread > 0.0 {
            let along = ALIKE * body.bone_spread.powi(-2);
            let across = ALIKE * (ACROSS * body.bone_spread).powi(-2);
            // The root's own offset is part of its translation.
            for (j, offset) in offsets.iter_mut().enumerate().skip(1) {
                *offset = Some(expected.len());
                let bone = template.offsets[j];
                expected.push((bone, weights(bone, along, across)));
            }
        }
        let places = expected.len();
        let site = |a: &crate::tree::Anchor| {
            let weight = ALIKE * body.sites[a.site].spread.powi(-2);
            (a.place, weights(a.place, weight, weight))
        };
        expected.extend(template.anchors.iter().map(site));
        Self { offsets, places, expected }
    }

    fn value(&self, tree: &Tree, block: usize) -> [f64; 3] {
        if block >= self.places {
            return tree.anchors[block - self.places].place;
        }
        // Joints come in order, the root left out.
        tree.offsets[block + 1]
    }

    fn cost(&self, tree: &Tree, samples: &[Sample], params: &IkParams) -> f64 {
        let prior: f64 = (0..self.expected.len())
            .map(|block| {
                let off = sub(self.value(tree, block), self.expected[block].0);
                dot(off, times(&self.expected[block].1, off))
            })
            .sum();
        let free = vec![0.0; tree.len()];
        let costs: Vec<f64> = samples
            .par_iter()
            .map_init(
                || FrameSolver::new(tree, params),
                |solver, sample| {
                    let ties = Ties { target: &sample.state, shift: 0.0, turns: &free };
                    solver.cost(&sample.state, &sample.seen, &ties)
                },
            )
            .collect();
        prior + costs.iter().sum::<f64>()
    }

    /// The solved step of the shared unknowns; `None` where the equations have no solution.
    fn system(
        &self,
        tree: &Tree,
        samples: &[Sample],
        params: &IkParams,
        damping: f64,
    ) -> Option<System> {
        let count = 3 * self.expected.len();
        let parts: Vec<Option<Eliminated>> = samples
            .par_iter()
            .map(|sample| self.eliminate(tree, sample, params, damping))
            .collect();
        let mut matrix = vec![0.0; count * count];
        let mut right = vec![0.0; count];
        for (block, (expected, weight)) in self.expected.iter().enumerate() {
            let off = sub(self.value(tree, block), *expected);
            let pull = times(weight, off);
            for r in 0..3 {
                right[3 * block + r] = -pull[r];
                for c in 0..=r {
                    matrix[(3 * block + r) * count + 3 * block + c] = weight[r][c];
                }
            }
        }
        let mut frames = Vec::with_capacity(samples.len());
        for part in parts {
            let (part, gradient, frame) = part?;
            matrix.iter_mut().zip(part).for_each(|(sum, term)| *sum += term);
            right.iter_mut().zip(gradient).for_each(|(sum, term)| *sum -= term);
            frames.push(frame);
        }
        for at in 0..count {
            matrix[at * count + at] *= 1.0 + damping;
        }
        Cholesky::new(matrix, count)?.solve(&mut right);
        Some(System { shared: right, frames })
    }

    /// What a frame says about the shared unknowns once its pose is eliminated: lower triangle and gradient.
    fn eliminate(
        &self,
        tree: &Tree,
        sample: &Sample,
        params: &IkParams,
        damping: f64,
    ) -> Option<Eliminated> {
        let count = 3 * self.expected.len();
        let free = vec![0.0; tree.len()];
        let mut solver = FrameSolver::new(tree, params);
        let ties = Ties { target: &sample.state, shift: 0.0, turns: &free };
        solver.cost(&sample.state, &sample.seen, &ties);
        solver.linearise(&sample.state, &sample.seen, &ties);
        let mut matrix = vec![0.0; count * count];
        let mut gradient = vec![0.0; count];
        let mut columns = vec![vec![[0.0; 3]; solver.normal.rows()]; count];
        for (&(anchor, at), &miss) in sample.seen.iter().zip(&solver.misses) {
            let weight = solver.weight(miss);
            let slopes = self.slopes(tree, &solver, anchor as usize);
            let arms = arms(tree, &solver, anchor as usize, add(at, miss));
            for (i, (block, slope)) in slopes.iter().enumerate() {
                for (a, column) in transposed(slope).into_iter().enumerate() {
                    let at = 3 * block + a;
                    gradient[at] += weight * dot(column, miss);
                    columns[at][0] = add(columns[at][0], scale(weight, column));
                    for (row, arm) in &arms {
                        columns[at][*row] =
                            add(columns[at][*row], scale(weight, cross(*arm, column)));
                    }
                    for (other, slope) in &slopes[..=i] {
                        for (b, across) in transposed(slope).into_iter().enumerate() {
                            let (low, high) = (3 * other + b, at);
                            let (low, high) = if low <= high { (low, high) } else { (high, low) };
                            // Within one block both orders come by; the lower triangle takes one.
                            if other != block || b <= a {
                                matrix[high * count + low] += weight * dot(column, across);
                            }
                        }
                    }
                }
            }
        }
        solver.normal.factor(damping).ok()?;
        let mut step: Vec<[f64; 3]> = solver.normal.gradient.clone();
        let mut half_gradient = step.clone();
        solver.normal.half_solve(&mut half_gradient);
        let mut halves = columns.clone();
        for column in &mut halves {
            solver.normal.half_solve(column);
        }
        // A marker moves with the joints above it alone, and elimination towards the root keeps that so.
        for (i, half) in halves.iter().enumerate() {
            let rows: Vec<usize> =
                (0..half.len()).filter(|&r| half[r].iter().any(|c| *c != 0.0)).collect();
            let inner =
                |other: &[[f64; 3]]| -> f64 { rows.iter().map(|&r| dot(half[r], other[r])).sum() };
            gradient[i] -= inner(&half_gradient);
            for (j, other) in halves[..=i].iter().enumerate() {
                matrix[i * count + j] -= inner(other);
            }
        }
        solver.normal.solve(&mut step);
        for column in &mut columns {
            solver.normal.solve(column);
        }
        Some((matrix, gradient, FrameSystem { step, columns }))
    }

    /// How a marker moves with each shared unknown that it depends on.
    fn slopes(&self, tree: &Tree, solver: &FrameSolver<'_>, anchor: usize) -> Vec<(usize, Matrix)> {
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

    /// Tree and samples after a step.
    fn advance(
        &self,
        tree: &Tree,
        samples: &[Sample],
        system: &System,
    ) -> Option<(Tree, Vec<Sample>)> {
        let three = |block: usize| {
            [system.shared[3 * block], system.shared[3 * block + 1], system.shared[3 * block + 2]]
        };
        if system.shared.iter().any(|c| !c.is_finite()) {
            return None;
        }
        let mut next = tree.clone();
        for (j, block) in self.offsets.iter().enumerate() {
            if let Some(block) = *block {
                next.offsets[j] = add(next.offsets[j], three(block));
            }
        }
        for (a, anchor) in next.anchors.iter_mut().enumerate() {
            anchor.place = add(anchor.place, three(self.places + a));
        }
        let mut solver = FrameSolver::new(tree, &IkParams::default());
        let moved = samples.iter().zip(&system.frames).map(|(sample, frame)| {
            let mut step: Vec<[f64; 3]> = frame.step.iter().map(|s| scale(-1.0, *s)).collect();
            for (column, by) in frame.columns.iter().zip(&system.shared) {
                for (sum, term) in step.iter_mut().zip(column) {
                    *sum = sub(*sum, scale(*by, *term));
                }
            }
            tree.place(&sample.state, &mut solver.placed);
            Sample { seen: sample.seen.clone(), state: solver.moved(&sample.state, &step) }
        });
        Some((next, moved.collect()))
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

/// Rows of the joints that move a marker, and from where they do.
fn arms(
    tree: &Tree,
    solver: &FrameSolver<'_>,
    anchor: usize,
    at: [f64; 3],
) -> Vec<(usize, [f64; 3])> {
    let marker = &tree.anchors[anchor];
    let mut arms = Vec::new();
    if let Some((far, share)) = marker.far {
        let local = sub(marker.place, tree.offsets[far]);
        arms.push((far + 1, scale(share, times(&solver.placed[far].axes, local))));
    }
    let chain = solver.normal.chain(marker.near + 1);
    arms.extend(
        chain[..chain.len() - 1].iter().map(|&row| (row, sub(at, solver.placed[row - 1].origin))),
    );
    arms
}

/// The body with the joints and markers of a calibrated tree, which started as `before`.
pub(crate) fn dressed(body: &Body, before: &Tree, after: &Tree) -> Result<Body, IkError> {
    let mut joints = body.skeleton.joints().to_vec();
    for j in 0..before.len() {
        let moved = sub(after.offsets[j], before.offsets[j]);
        let joint = &mut joints[before.joints[j]];
        joint.offset_m = add(joint.offset_m, moved);
    }
    let mut sites = body.sites.clone();
    for (old, new) in before.anchors.iter().zip(&after.anchors) {
        let site = &mut sites[old.site];
        site.place = add(site.place, sub(new.place, old.place));
    }
    Ok(Body { skeleton: Arc::new(Skeleton::new(joints)?), sites, ..body.clone() })
}
