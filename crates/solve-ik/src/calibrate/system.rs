//! The normal equations of the shared unknowns, poses eliminated frame by frame.

use mocap_core::geometry::{add, cross, scale, sub, times, transposed};
use rayon::prelude::*;

use super::{Firmness, Sample, layout::Layout};
use crate::{
    IkParams, calibrate::layout::Matrix, dense::Cholesky, frame::FrameSolver, normal::Normal,
    tree::Tree,
};

const ZERO: Matrix = [[0.0; 3]; 3];
/// Frames that are added up one after the other, whatever the number of threads: the same groups, the same bits.
const GROUP: usize = 4;

/// The solved step of the shared unknowns, and what the frames need to follow.
pub(super) struct System {
    step: Vec<[f64; 3]>,
    frames: Vec<FrameSystem>,
}

/// A frame whose pose was eliminated, with Hpp = L Lᵀ.
struct FrameSystem {
    /// L⁻¹ gp.
    gradient: Vec<[f64; 3]>,
    /// L⁻¹ Hps: rows of a block one after the other, then those of the next.
    coupling: Vec<Matrix>,
    /// L.
    normal: Normal,
}

/// Lower triangle and gradient of the shared unknowns.
struct Sums {
    matrix: Vec<f64>,
    gradient: Vec<f64>,
}

impl Sums {
    fn new(layout: &Layout) -> Self {
        let count = 3 * layout.expected.len();
        Self { matrix: vec![0.0; count * count], gradient: vec![0.0; count] }
    }

    /// Adds to the block of two unknowns, the second no later than the first.
    #[inline]
    fn add(&mut self, high: usize, low: usize, term: &Matrix) {
        let count = self.gradient.len();
        for (r, row) in term.iter().enumerate() {
            let at = (3 * high + r) * count + 3 * low;
            self.matrix[at..at + 3].iter_mut().zip(row).for_each(|(sum, term)| *sum += term);
        }
    }

    #[inline]
    fn pull(&mut self, block: usize, by: [f64; 3]) {
        let at = &mut self.gradient[3 * block..3 * block + 3];
        at.iter_mut().zip(by).for_each(|(sum, term)| *sum += term);
    }
}

impl System {
    /// `None` where the equations have no solution.
    pub(super) fn solved(
        layout: &Layout,
        tree: &Tree,
        samples: &[Sample],
        params: &IkParams,
        damping: f64,
    ) -> Option<Self> {
        let meetings = layout.meetings();
        let eliminate = |samples: &[Sample]| {
            let mut sums = Sums::new(layout);
            let mut frame =
                |sample| eliminate(layout, &meetings, tree, sample, params, damping, &mut sums);
            let frames: Option<Vec<FrameSystem>> = samples.iter().map(&mut frame).collect();
            Some((sums, frames?))
        };
        let groups: Vec<Option<(Sums, Vec<FrameSystem>)>> =
            samples.par_chunks(GROUP).map(eliminate).collect();
        let mut total = Sums::new(layout);
        for (block, (expected, weight)) in layout.expected.iter().enumerate() {
            total.pull(block, times(weight, sub(layout.value(tree, block), *expected)));
            total.add(block, block, weight);
        }
        let mut frames = Vec::with_capacity(samples.len());
        for group in groups {
            let (sums, group) = group?;
            total.matrix.iter_mut().zip(sums.matrix).for_each(|(sum, term)| *sum += term);
            total.gradient.iter_mut().zip(sums.gradient).for_each(|(sum, term)| *sum += term);
            frames.extend(group);
        }
        let Sums { mut matrix, mut gradient } = total;
        let count = gradient.len();
        (0..count).for_each(|at| matrix[at * count + at] *= 1.0 + damping);
        Cholesky::new(matrix, count)?.solve(&mut gradient);
        if gradient.iter().any(|c| !c.is_finite()) {
            return None;
        }
        let step = gradient.chunks_exact(3).map(|c| [-c[0], -c[1], -c[2]]).collect();
        Some(Self { step, frames })
    }

    /// Tree and samples after the step.
    pub(super) fn advance(
        &self,
        layout: &Layout,
        tree: &Tree,
        samples: &[Sample],
    ) -> (Tree, Vec<Sample>) {
        let mut solver = FrameSolver::new(tree, &IkParams::default());
        let moved = samples.iter().zip(&self.frames).map(|(sample, frame)| {
            let mut step = frame.gradient.clone();
            for (block, (rows, by)) in layout.rows.iter().zip(&self.step).enumerate() {
                let coupling = &frame.coupling[layout.starts[block]..];
                for (&row, coupling) in rows.iter().zip(coupling) {
                    step[row] = add(step[row], times(coupling, *by));
                }
            }
            frame.normal.back_solve(&mut step);
            for s in &mut step {
                *s = scale(-1.0, *s);
            }
            tree.place(&sample.state, &mut solver.placed);
            Sample { state: solver.moved(&sample.state, &step), ..sample.clone() }
        });
        (layout.moved(tree, &self.step), moved.collect())
    }
}

/// Adds what a frame says about the shared unknowns once its pose is eliminated.
fn eliminate(
    layout: &Layout,
    meetings: &[Vec<(usize, usize)>],
    tree: &Tree,
    sample: &Sample,
    params: &IkParams,
    damping: f64,
    sums: &mut Sums,
) -> Option<FrameSystem> {
    let weights = Firmness::of(tree);
    let mut solver = FrameSolver::new(tree, params);
    let ties = weights.ties(sample);
    solver.cost(&sample.state, &sample.seen, &ties);
    solver.linearise(&sample.state, &sample.seen, &ties);
    let mut coupling = vec![ZERO; layout.starts[layout.expected.len()]];
    for (&(anchor, at), &miss) in sample.seen.iter().zip(&solver.misses) {
        let weight = solver.weight(&tree.anchors[anchor as usize], miss);
        let slopes = layout.slopes(tree, &solver, anchor as usize);
        let arms = arms(tree, &solver, anchor as usize, add(at, miss));
        for (i, (block, slope)) in slopes.iter().enumerate() {
            let pulled = slope.map(|row| scale(weight, row));
            sums.pull(*block, times(&transposed(&pulled), miss));
            add_to(&mut coupling[layout.at(*block, 0)?], &pulled);
            for (row, arm) in &arms {
                add_to(&mut coupling[layout.at(*block, *row)?], &crossed(*arm, &pulled));
            }
            for (other, slope) in &slopes[..=i] {
                let (high, low) = if block >= other {
                    (*block, (*other, inner(&pulled, slope)))
                } else {
                    (*other, (*block, inner(slope, &pulled)))
                };
                sums.add(high, low.0, &low.1);
            }
        }
    }
    solver.normal.factor(damping).ok()?;
    let mut gradient = solver.normal.gradient.clone();
    solver.normal.half_solve(&mut gradient);
    for (block, rows) in layout.rows.iter().enumerate() {
        let part = &mut coupling[layout.starts[block]..layout.starts[block + 1]];
        solver.normal.half_solve_blocks(rows, part);
        for (&row, part) in rows.iter().zip(part.iter()) {
            sums.pull(block, scale(-1.0, times(&transposed(part), gradient[row])));
        }
    }
    let pairs = (0..layout.expected.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
    for ((i, j), meetings) in pairs.zip(meetings) {
        let mut sum = ZERO;
        for &(p, q) in meetings {
            let term = inner(&coupling[p], &coupling[q]);
            (0..3).for_each(|r| sum[r] = sub(sum[r], term[r]));
        }
        sums.add(i, j, &sum);
    }
    Some(FrameSystem { gradient, coupling, normal: solver.normal })
}

/// `aᵀ b`.
#[inline]
fn inner(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|r| {
        std::array::from_fn(|c| a[0][r] * b[0][c] + a[1][r] * b[1][c] + a[2][r] * b[2][c])
    })
}

#[inline]
fn add_to(sum: &mut Matrix, term: &Matrix) {
    sum.iter_mut().zip(term).for_each(|(sum, term)| *sum = add(*sum, *term));
}

/// The cross products of an arm and each column.
fn crossed(arm: [f64; 3], columns: &Matrix) -> Matrix {
    transposed(&transposed(columns).map(|column| cross(arm, column)))
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
