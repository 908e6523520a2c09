//! The normal equations of one frame, and their solution along the tree.
//!
//! Unknowns are the coordinates of [`Skeleton::moved`](mocap_core::Skeleton::moved): a shift of the root, then a turn of each
//! joint along the world's axes. A turn ω of joint j moves a marker at x, anywhere below j, by ω × (x − oⱼ). So
//! the block of an ancestor i and a joint j needs the markers only through Σw, Σw x and Σw x xᵀ over those below j,
//! which add up along the tree like masses and inertias of a chain of bodies: assembling costs the number of
//! joints times their depth, whatever the number of markers. Blocks of joints on different branches are zero, and
//! elimination from the leaves to the root keeps them so.

use mocap_core::geometry::{add, cross, dot, scale, sub};

use crate::tree::{Placed, Tree};

mod solve;

type Matrix = [[f64; 3]; 3];
const ZERO: Matrix = [[0.0; 3]; 3];

/// Markers below a joint, added up. Places are relative to the root, whose size keeps digits.
#[derive(Debug, Clone, Copy)]
struct Moments {
    weight: f64,
    first: [f64; 3],
    /// xx, xy, xz, yy, yz, zz.
    second: [f64; 6],
    force: [f64; 3],
    torque: [f64; 3],
}

const NO_MOMENTS: Moments =
    Moments { weight: 0.0, first: [0.0; 3], second: [0.0; 6], force: [0.0; 3], torque: [0.0; 3] };

/// Markers that follow a joint by a share: what its own blocks need on top. The arm v is that share of the way from
/// the joint to the marker.
#[derive(Debug, Clone, Copy)]
struct Shared {
    arm: [f64; 3],
    /// Σ w x vᵀ.
    mixed: Matrix,
    /// Σ w v vᵀ.
    own: Matrix,
    torque: [f64; 3],
}

const NOTHING_SHARED: Shared = Shared { arm: [0.0; 3], mixed: ZERO, own: ZERO, torque: [0.0; 3] };

/// Symmetric blocks along the tree, and a right-hand side. Row 0 is the root's shift, row j + 1 the turn of joint j.
#[derive(Debug, Clone)]
pub(crate) struct Normal {
    /// For each row, itself and then its ancestors up to row 0.
    chains: Vec<Vec<usize>>,
    /// First block of each row; block k of a row couples it to entry k of its chain.
    starts: Vec<usize>,
    blocks: Vec<Matrix>,
    factor: Vec<Matrix>,
    pub(crate) gradient: Vec<[f64; 3]>,
    moments: Vec<Moments>,
    shared: Vec<Shared>,
    origin: [f64; 3],
}

impl Normal {
    pub(crate) fn new(tree: &Tree) -> Self {
        let mut chains = vec![vec![0]];
        for (j, &parent) in tree.parents.iter().enumerate() {
            let above = if j == 0 { 0 } else { parent + 1 };
            let chain = std::iter::once(j + 1).chain(chains[above].iter().copied()).collect();
            chains.push(chain);
        }
        let mut starts = Vec::with_capacity(chains.len());
        let mut count = 0;
        for chain in &chains {
            starts.push(count);
            count += chain.len();
        }
        Self {
            blocks: vec![ZERO; count],
            factor: vec![ZERO; count],
            gradient: vec![[0.0; 3]; chains.len()],
            moments: vec![NO_MOMENTS; chains.len()],
            shared: vec![NOTHING_SHARED; chains.len()],
            origin: [0.0; 3],
            chains,
            starts,
        }
    }

    /// Rows: one more than joints.
    pub(crate) fn rows(&self) -> usize {
        self.chains.len()
    }

    /// The row and its ancestors, row 0 last.
    pub(crate) fn chain(&self, row: usize) -> &[usize] {
        &self.chains[row]
    }

    /// Starts anew, with places counted from `origin`.
    pub(crate) fn clear(&mut self, origin: [f64; 3]) {
        self.moments.fill(NO_MOMENTS);
        self.shared.fill(NOTHING_SHARED);
        self.origin = origin;
    }

    /// Adds a marker that rides on a joint: where it is, and by how much it misses its target.
    #[inline]
    pub(crate) fn add(&mut self, joint: usize, weight: f64, at: [f64; 3], miss: [f64; 3]) {
        let p = sub(at, self.origin);
        let wp = scale(weight, p);
        let pull = scale(weight, miss);
        let m = &mut self.moments[joint + 1];
        m.weight += weight;
        m.first = add(m.first, wp);
        let [x, y, z] = p;
        for (sum, term) in m.second.iter_mut().zip([
            wp[0] * x,
            wp[0] * y,
            wp[0] * z,
            wp[1] * y,
            wp[1] * z,
            wp[2] * z,
        ]) {
            *sum += term;
        }
        m.force = add(m.force, pull);
        m.torque = add(m.torque, cross(p, pull));
    }

    /// Adds what such a marker means to a second joint, from which it lies by `arm` times its share.
    #[inline]
    pub(crate) fn add_shared(
        &mut self,
        joint: usize,
        weight: f64,
        at: [f64; 3],
        arm: [f64; 3],
        miss: [f64; 3],
    ) {
        let p = sub(at, self.origin);
        let s = &mut self.shared[joint + 1];
        let wv = scale(weight, arm);
        s.arm = add(s.arm, wv);
        for r in 0..3 {
            s.mixed[r] = add(s.mixed[r], scale(p[r], wv));
            s.own[r] = add(s.own[r], scale(arm[r], wv));
        }
        s.torque = add(s.torque, cross(wv, miss));
    }

    /// Sums up along the tree and writes the blocks and the gradient.
    pub(crate) fn assemble(&mut self, placed: &[Placed]) {
        for row in (1..self.rows()).rev() {
            let below = self.moments[row];
            let above = &mut self.moments[self.chains[row][1]];
            above.weight += below.weight;
            above.first = add(above.first, below.first);
            for (sum, term) in above.second.iter_mut().zip(below.second) {
                *sum += term;
            }
            above.force = add(above.force, below.force);
            above.torque = add(above.torque, below.torque);
        }
        let w = self.moments[0].weight;
        self.blocks[0] = [[w, 0.0, 0.0], [0.0, w, 0.0], [0.0, 0.0, w]];
        self.gradient[0] = self.moments[0].force;
        for row in 1..self.rows() {
            self.assemble_row(row, placed);
        }
    }

    fn assemble_row(&mut self, row: usize, placed: &[Placed]) {
        let m = self.moments[row];
        let shared = self.shared[row];
        let here = sub(placed[row - 1].origin, self.origin);
        self.gradient[row] = add(sub(m.torque, cross(here, m.force)), shared.torque);
        // Σ w (x − o) over the markers below, as the translation sees it.
        let arm = sub(m.first, scale(m.weight, here));
        let start = self.starts[row];
        let chain = &self.chains[row];
        let last = chain.len() - 1;
        for (at, &other) in chain[..last].iter().enumerate() {
            let there = sub(placed[other - 1].origin, self.origin);
            // Σ w (x − oᵢ)(x − oⱼ)ᵀ, and the same for the shared markers.
            let [xx, xy, xz, yy, yz, zz] = m.second;
            let second = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            let mut outer: Matrix = std::array::from_fn(|r| {
                std::array::from_fn(|c| second[r][c] - there[r] * arm[c] - m.first[r] * here[c])
            });
            for (r, sums) in outer.iter_mut().enumerate() {
                let term = if at == 0 {
                    shared.own[r]
                } else {
                    sub(shared.mixed[r], scale(there[r], shared.arm))
                };
                *sums = add(*sums, term);
            }
            let trace = outer[0][0] + outer[1][1] + outer[2][2];
            // [u]ᵀ[v] = (u·v) 1 − v uᵀ with u the arm of this row and v that of the other.
            self.blocks[start + at] = std::array::from_fn(|r| {
                std::array::from_fn(|c| if r == c { trace - outer[r][c] } else { -outer[r][c] })
            });
        }
        let [x, y, z] = add(arm, shared.arm);
        self.blocks[start + last] = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    }

    /// Adds a term of one row alone: its part of the matrix and of the gradient.
    #[inline]
    pub(crate) fn add_own(&mut self, row: usize, block: &Matrix, gradient: [f64; 3]) {
        let at = &mut self.blocks[self.starts[row]];
        for (sums, terms) in at.iter_mut().zip(block) {
            *sums = add(*sums, *terms);
        }
        self.gradient[row] = add(self.gradient[row], gradient);
    }

    /// The matrix `(3 · rows, 3 · rows)` in full, for tests.
    #[cfg(test)]
    pub(crate) fn dense(&self) -> Vec<Vec<f64>> {
        let n = 3 * self.rows();
        let mut full = vec![vec![0.0; n]; n];
        for row in 0..self.rows() {
            for (at, &other) in self.chains[row].iter().enumerate() {
                for r in 0..3 {
                    for c in 0..3 {
                        let value = self.blocks[self.starts[row] + at][r][c];
                        full[3 * row + r][3 * other + c] = value;
                        full[3 * other + c][3 * row + r] = value;
                    }
                }
            }
        }
        full
    }
}

/// Length of a step's largest entry.
pub(crate) fn largest(step: &[[f64; 3]]) -> f64 {
    step.iter().map(|s| dot(*s, *s)).fold(0.0, f64::max).sqrt()
}
