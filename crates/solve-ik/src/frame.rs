//! The pose of one frame, by Levenberg and Marquardt.

use mocap_core::{
    Rotation,
    geometry::{add, dot, log_jacobian, norm, product, scale, sub, times, transposed},
};

use crate::{
    IkParams,
    normal::{Normal, largest},
    tree::{Anchor, Placed, State, Tree},
};

/// A joint that leaves its limits by this angle costs as much as a marker that misses by its spread.
const LIMIT_SPREAD: f64 = 0.035;
/// Step below which a frame is solved, in radians and metres: far below what markers resolve.
const STILL: f64 = 1e-4;
/// A change of the cost, as a share, that is rounding and no change.
const ROUNDING: f64 = 1e-12;

/// A marker that a frame shows: its anchor and place in metres.
pub(crate) type Seen = (u32, [f64; 3]);

/// What a pose is held to besides its markers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ties<'a> {
    pub(crate) target: &'a State,
    /// Weight of the root's shift, per m².
    pub(crate) shift: f64,
    /// Weight of each joint's turn, per rad², `(joints,)`.
    pub(crate) turns: &'a [f64],
}

/// How a frame came out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fit {
    pub(crate) cost: f64,
    pub(crate) iterations: usize,
    pub(crate) converged: bool,
}

/// Everything a frame needs, made once.
#[derive(Debug, Clone)]
pub(crate) struct FrameSolver<'a> {
    pub(crate) tree: &'a Tree,
    pub(crate) normal: Normal,
    pub(crate) placed: Vec<Placed>,
    /// Predicted less measured, one a marker seen.
    pub(crate) misses: Vec<[f64; 3]>,
    step: Vec<[f64; 3]>,
    trial: State,
    weight: f64,
    reach: f64,
}

impl<'a> FrameSolver<'a> {
    pub(crate) fn new(tree: &'a Tree, params: &IkParams) -> Self {
        let normal = Normal::new(tree);
        Self {
            step: vec![[0.0; 3]; normal.rows()],
            normal,
            placed: vec![Placed::NOWHERE; tree.len()],
            misses: Vec::new(),
            trial: tree.rest(),
            weight: params.marker_m.powi(-2),
            reach: params.robust_m,
            tree,
        }
    }

    /// Improves a pose until it stands still, or for `limit` steps.
    pub(crate) fn solve(
        &mut self,
        state: &mut State,
        seen: &[Seen],
        ties: &Ties<'_>,
        limit: usize,
    ) -> Fit {
        let mut cost = self.cost(state, seen, ties);
        let mut damping = 1e-5;
        for iteration in 0..limit {
            self.linearise(state, seen, ties);
            let (next, length) = loop {
                let trial = self.normal.factor(damping).is_ok().then(|| {
                    self.advance(state);
                    // The step and the trial are set aside while the cost of the trial is taken.
                    let trial = std::mem::replace(
                        &mut self.trial,
                        State { root_m: [0.0; 3], turns: Vec::new() },
                    );
                    let next = self.cost(&trial, seen, ties);
                    self.trial = trial;
                    next
                });
                match trial {
                    Some(next) if next <= cost * (1.0 + ROUNDING) => {
                        break (next, largest(&self.step));
                    }
                    _ if damping > 1e6 => {
                        // No way down is left; the pose stays.
                        self.cost(state, seen, ties);
                        return Fit { cost, iterations: iteration + 1, converged: false };
                    }
                    _ => damping = (damping * 10.0).max(1e-3),
                }
            };
            std::mem::swap(state, &mut self.trial);
            damping *= 0.1;
            cost = next;
            if length < STILL {
                return Fit { cost, iterations: iteration + 1, converged: true };
            }
        }
        Fit { cost, iterations: limit, converged: false }
    }

    /// Cost of a pose; leaves behind where its joints are and by how much its markers miss.
    pub(crate) fn cost(&mut self, state: &State, seen: &[Seen], ties: &Ties<'_>) -> f64 {
        self.tree.place(state, &mut self.placed);
        self.misses.clear();
        let mut cost = 0.0;
        for &(anchor, at) in seen {
            let anchor = &self.tree.anchors[anchor as usize];
            let miss = sub(self.tree.marker(anchor, &self.placed), at);
            let square = anchor.grip * dot(miss, miss);
            let reach = self.reach;
            cost += if square <= reach * reach {
                square
            } else {
                reach * (2.0 * square.sqrt() - reach)
            };
            self.misses.push(miss);
        }
        cost *= self.weight;
        let off = sub(state.root_m, ties.target.root_m);
        cost += ties.shift * dot(off, off);
        for (j, &turn) in state.turns.iter().enumerate() {
            if ties.turns[j] > 0.0 {
                let angle = turn.after(ties.target.turns[j].inverse()).angle();
                cost += ties.turns[j] * angle * angle;
            }
            if j > 0 {
                let (angles, weights, excess) = self.habit(j, turn.log());
                cost += (0..3).map(|a| weights[a] * angles[a] * angles[a]).sum::<f64>();
                cost += excess * excess / (LIMIT_SPREAD * LIMIT_SPREAD);
            }
        }
        cost
    }

    /// Angles of a joint about its own axes, their weights, and how far the first leaves its limits.
    #[inline]
    fn habit(&self, joint: usize, log: [f64; 3]) -> ([f64; 3], [f64; 3], f64) {
        let habit = &self.tree.habits[joint];
        let angles = times(&habit.axes, log);
        let weights = habit.spread.map(|s| 1.0 / (s * s));
        (angles, weights, angles[0] - angles[0].clamp(habit.limits[0], habit.limits[1]))
    }

    /// Weight of a marker that misses by this.
    #[inline]
    pub(crate) fn weight(&self, anchor: &Anchor, miss: [f64; 3]) -> f64 {
        let weight = self.weight * anchor.grip;
        let length = anchor.grip.sqrt() * norm(miss);
        if length <= self.reach { weight } else { weight * self.reach / length }
    }

    /// The normal equations at a pose whose cost was just taken.
    pub(crate) fn linearise(&mut self, state: &State, seen: &[Seen], ties: &Ties<'_>) {
        self.normal.clear(self.placed[0].origin);
        for (&(anchor, at), &miss) in seen.iter().zip(&self.misses) {
            let anchor = &self.tree.anchors[anchor as usize];
            let weight = self.weight(anchor, miss);
            let here = add(at, miss);
            self.normal.add(anchor.near, weight, here, miss);
            if let Some((far, share)) = anchor.far {
                let local = sub(anchor.place, self.tree.offsets[far]);
                let arm = scale(share, times(&self.placed[far].axes, local));
                self.normal.add_shared(far, weight, here, arm, miss);
            }
        }
        self.normal.assemble(&self.placed);
        let shift = ties.shift;
        let off = scale(shift, sub(state.root_m, ties.target.root_m));
        self.normal.add_own(0, &diagonal(shift), off);
        for (j, &turn) in state.turns.iter().enumerate() {
            let parent =
                if j == 0 { Placed::NOWHERE.axes } else { self.placed[self.tree.parents[j]].axes };
            let tie = ties.turns[j];
            if tie > 0.0 {
                let log = turn.after(ties.target.turns[j].inverse()).log();
                self.normal.add_own(j + 1, &diagonal(tie), scale(tie, times(&parent, log)));
            }
            if j > 0 {
                self.add_habit(j, turn, &parent);
            }
        }
    }

    /// Adds the rest pose and the limits of a joint.
    fn add_habit(&mut self, joint: usize, turn: Rotation, parent: &[[f64; 3]; 3]) {
        let log = turn.log();
        let (angles, mut weights, excess) = self.habit(joint, log);
        let mut pull: [f64; 3] = std::array::from_fn(|a| weights[a] * angles[a]);
        if excess != 0.0 {
            let weight = 1.0 / (LIMIT_SPREAD * LIMIT_SPREAD);
            weights[0] += weight;
            pull[0] += weight * excess;
        }
        // A turn along the world's axes changes the angles by axes · log' · parentᵀ.
        let slope = product(
            &self.tree.habits[joint].axes,
            &product(&log_jacobian(log), &transposed(parent)),
        );
        let mut block = [[0.0; 3]; 3];
        for (row, weight) in slope.iter().zip(weights) {
            for r in 0..3 {
                block[r] = add(block[r], scale(weight * row[r], *row));
            }
        }
        self.normal.add_own(joint + 1, &block, times(&transposed(&slope), pull));
    }

    /// The step of the factored equations, and the pose it leads to.
    fn advance(&mut self, state: &State) {
        for (step, gradient) in self.step.iter_mut().zip(&self.normal.gradient) {
            *step = scale(-1.0, *gradient);
        }
        self.normal.solve(&mut self.step);
        // The joints in the world are those of the trial before, if it was refused.
        self.tree.place(state, &mut self.placed);
        let step = std::mem::take(&mut self.step);
        self.trial = self.moved(state, &step);
        self.step = step;
    }

    /// The pose after a step, for joints that are placed where the pose has them.
    pub(crate) fn moved(&self, state: &State, step: &[[f64; 3]]) -> State {
        let turn = |(j, &turn): (usize, &Rotation)| {
            let by = step[j + 1];
            let by = if j == 0 {
                by
            } else {
                times(&transposed(&self.placed[self.tree.parents[j]].axes), by)
            };
            Rotation::exp(by).after(turn).normalized()
        };
        State {
            root_m: add(state.root_m, step[0]),
            turns: state.turns.iter().enumerate().map(turn).collect(),
        }
    }
}

fn diagonal(value: f64) -> [[f64; 3]; 3] {
    [[value, 0.0, 0.0], [0.0, value, 0.0], [0.0, 0.0, value]]
}

#[cfg(test)]
mod tests;
