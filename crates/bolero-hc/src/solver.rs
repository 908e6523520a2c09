//! Newton on the conditions of Karush, Kuhn and Tucker, made to converge.

use crate::{cholesky, problem::Problem};

/// Bones within this of their length count as kept while solving, metres. A tenth of what is
/// promised, so that turning back into world coordinates cannot break the promise.
const KEPT_M: f64 = 1e-7;

/// Bones are solved to this share of the longest one.
const PRECISION: f64 = 1e-11;

/// Where the zero block of the Newton matrix starts and how it falls. One tenth lets the
/// prediction and the bones settle together.
const FIRST_ALPHA: f64 = 0.1;
const NEXT_ALPHA: f64 = 1e-3;
const RESTORED_ALPHA: f64 = 1e-7;
const ALPHA_FALL: f64 = 0.01;
const LAST_ALPHA: f64 = 1e-9;

/// Weight of the prediction where the bones contradict each other: it picks one of the points that
/// fit them equally well.
const COMPROMISE_ALPHA: f64 = 1e-6;

/// Damping where the prediction has no weight: it keeps free directions from drifting.
const RESTORING_DAMPING: f64 = 1e-9;

/// Updates of the multipliers; contradicting bones are given up earlier, others take about four.
const OUTER_STEPS: usize = 20;

/// Newton steps for one set of multipliers; about four are taken.
const INNER_STEPS: usize = 60;

/// Beyond this damping, a step is too short to matter.
const MOST_DAMPING: f64 = 1e9;

/// Starts around the first solution in a wide search. With half as many, an independent search
/// came closer in one of some four thousand random frames; with these, in none of eight thousand.
pub(crate) const WIDE: usize = 24;

/// A place for each unknown marker of a frame.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Solution {
    /// The unknown coordinates, metres.
    pub(crate) places: Vec<f64>,
    /// Multipliers of the constraints as the problem measures them, metres; nothing where they
    /// grew without bound.
    pub(crate) multipliers: Option<Vec<f64>>,
    /// Largest deviation of a bone, metres.
    pub(crate) residual_m: f64,
    merit: f64,
}

impl Solution {
    /// All bones are kept.
    pub(crate) fn keeps(&self) -> bool {
        self.residual_m < KEPT_M
    }

    /// A point that keeps the bones beats one that does not; the merit decides the rest, and a tie
    /// within rounding stays with what was found first.
    fn beats(&self, other: &Self) -> bool {
        if self.keeps() != other.keeps() {
            return self.keeps();
        }
        self.merit < other.merit * (1.0 - 1e-9)
    }
}

/// Solves a problem from the prediction and, where that is not proven best, from `others` and
/// from some `nudges` around what was found.
///
/// A solution is proven best when the Lagrangian is convex at its multipliers: it then lies below
/// the objective wherever the bones are kept, and touches it at the solution.
pub(crate) fn solve(problem: &Problem<'_>, others: &[Vec<f64>], nudges: usize) -> Solution {
    let mut newton = Newton::new(problem);
    let mut best = newton.solve(problem.centre.to_vec(), FIRST_ALPHA);
    if newton.is_closest(&best) {
        return best;
    }
    let nudged = (0..nudges).map(|attempt| nudge(problem, &best.places, attempt));
    let starts: Vec<Vec<f64>> = others.iter().cloned().chain(nudged).collect();
    for start in starts {
        let found = if best.keeps() {
            newton.solve(start, NEXT_ALPHA)
        } else {
            newton.restore_and_solve(start)
        };
        if found.beats(&best) {
            best = found;
            if newton.is_closest(&best) {
                break;
            }
        }
    }
    best
}

/// A place moved by about the length of the longest bone along fractions of the golden ratio,
/// which leave no symmetry; every other attempt goes the opposite way, to the other side of
/// whatever plane mirrors the bones.
fn nudge(problem: &Problem<'_>, from: &[f64], attempt: usize) -> Vec<f64> {
    let direction = attempt / 2 + 1;
    let sign = if attempt.is_multiple_of(2) { 1.0 } else { -1.0 };
    let size = sign * 0.4 * (1 + direction % 3) as f64 * problem.size();
    let shift = |i: usize| {
        2.0 * (0.618_033_988_749_895 * ((i + 1) * direction + i * i) as f64).fract() - 1.0
    };
    from.iter().enumerate().map(|(i, y)| y + size * shift(i)).collect()
}

struct Newton<'a> {
    problem: &'a Problem<'a>,
    constraints: Vec<f64>,
    tension: Vec<f64>,
    gradient: Vec<f64>,
    hessian: Vec<f64>,
    factor: Vec<f64>,
    trial: Vec<f64>,
}

impl<'a> Newton<'a> {
    fn new(problem: &'a Problem<'a>) -> Self {
        let (n, bones) = (problem.len(), problem.sticks.len());
        Self {
            problem,
            constraints: vec![0.0; bones],
            tension: vec![0.0; bones],
            gradient: vec![0.0; n],
            hessian: vec![0.0; n * n],
            factor: vec![0.0; n * n],
            trial: vec![0.0; n],
        }
    }

    /// Newton steps on the stationary point of the Lagrangian from `y`.
    ///
    /// The step solves
    ///
    /// ```text
    /// ⎛ w + Σ η ∇²c   ∇cᵀ ⎞ ⎛ Δy ⎞     ⎛ w (y − ŷ) + Σ η ∇c ⎞
    /// ⎝ ∇c            −α  ⎠ ⎝ Δη ⎠ = − ⎝ c − α (η − η₀)      ⎠
    /// ```
    ///
    /// with `Δη` eliminated. `α` makes it a least-squares step where constraints depend on each
    /// other; it falls while the multipliers `η₀` settle, so that the solution is that of the
    /// system with a zero in its place. Solving to the end for each `η₀` minimises
    /// `½ α Σ w (y − ŷ)² + ½ ‖c + α η₀‖²`, which is the merit function.
    ///
    /// Deviates from [Li10] Eq. (7): the block `−α`, which is zero in (38), and a step size that is
    /// chosen by the merit function through the damping, not fixed at ½.
    fn solve(&mut self, mut y: Vec<f64>, first_alpha: f64) -> Solution {
        let target = PRECISION * self.problem.size();
        let bones = self.problem.sticks.len();
        let mut shift = vec![0.0; bones];
        let mut alpha = first_alpha;
        let mut before = f64::INFINITY;
        let mut multipliers = vec![0.0; bones];
        for _ in 0..OUTER_STEPS {
            let last = alpha <= LAST_ALPHA;
            let settled = self.minimise(&mut y, alpha, &shift);
            self.problem.constraints(&y, &mut self.constraints);
            for ((m, c), s) in multipliers.iter_mut().zip(&self.constraints).zip(&shift) {
                *m = (c + s) / alpha;
            }
            let worst = self.constraints.iter().fold(0.0, |a: f64, c| a.max(c.abs()));
            if worst <= target && settled {
                return self.finish(y, Some(multipliers));
            }
            if last && worst > 0.5 * before {
                break;
            }
            before = worst;
            alpha = (alpha * ALPHA_FALL).max(LAST_ALPHA);
            shift.iter_mut().zip(&multipliers).for_each(|(s, m)| *s = alpha * m);
        }
        self.compromise(y)
    }

    /// The bones first: the prediction only chooses among places that keep them.
    fn restore_and_solve(&mut self, mut y: Vec<f64>) -> Solution {
        self.restore(&mut y);
        if self.problem.residual(&y) >= KEPT_M {
            return self.compromise(y);
        }
        let found = self.solve(y.clone(), NEXT_ALPHA);
        if found.keeps() { found } else { self.solve(y, RESTORED_ALPHA) }
    }

    /// The bones as well as they go, the prediction second.
    fn compromise(&mut self, mut y: Vec<f64>) -> Solution {
        self.minimise(&mut y, COMPROMISE_ALPHA, &vec![0.0; self.problem.sticks.len()]);
        self.restore(&mut y);
        self.finish(y, None)
    }

    /// The least squares of the bones, near `y`.
    fn restore(&mut self, y: &mut [f64]) {
        self.minimise(y, 0.0, &vec![0.0; self.problem.sticks.len()]);
    }

    fn finish(&mut self, places: Vec<f64>, multipliers: Option<Vec<f64>>) -> Solution {
        let residual_m = self.problem.residual(&places);
        let none = vec![0.0; self.problem.sticks.len()];
        let merit = self.merit(&places, COMPROMISE_ALPHA, &none);
        Solution { places, multipliers, residual_m, merit }
    }

    /// No other point that keeps the bones is closer to the prediction: the Lagrangian is convex.
    fn is_closest(&mut self, solution: &Solution) -> bool {
        let Some(multipliers) = &solution.multipliers else { return false };
        let Problem { weight, lowest, .. } = *self.problem;
        self.problem.hessian(&solution.places, 1.0, multipliers, false, &mut self.hessian);
        cholesky::factor(&self.hessian, 0.0, weight, lowest, &mut self.factor)
    }

    fn merit(&mut self, y: &[f64], alpha: f64, shift: &[f64]) -> f64 {
        self.problem.constraints(y, &mut self.constraints);
        let bones: f64 = self.constraints.iter().zip(shift).map(|(c, s)| (c + s) * (c + s)).sum();
        alpha * self.problem.objective(y) + 0.5 * bones
    }

    /// Moves `y` to a lower merit until it stands still; `false` where the steps run out first.
    fn minimise(&mut self, y: &mut [f64], alpha: f64, shift: &[f64]) -> bool {
        let Problem { weight, lowest, .. } = *self.problem;
        let least = if alpha > 0.0 { 0.0 } else { RESTORING_DAMPING };
        let still = 0.1 * PRECISION * self.problem.size();
        let mut damping = least;
        let mut last_step = f64::INFINITY;
        let mut merit = self.merit(y, alpha, shift);
        for _ in 0..INNER_STEPS {
            self.problem.constraints(y, &mut self.constraints);
            for ((t, c), s) in self.tension.iter_mut().zip(&self.constraints).zip(shift) {
                *t = c + s;
            }
            self.problem.gradient(y, alpha, &self.tension, &mut self.gradient);
            self.problem.hessian(y, alpha, &self.tension, true, &mut self.hessian);
            let accepted = loop {
                if damping > MOST_DAMPING {
                    return true;
                }
                if cholesky::factor(&self.hessian, damping, weight, lowest, &mut self.factor) {
                    self.trial.copy_from_slice(&self.gradient);
                    cholesky::solve(&self.factor, lowest, &mut self.trial);
                    let step = self.trial.iter().fold(0.0, |a: f64, s| a.max(s.abs()));
                    self.trial.iter_mut().zip(&*y).for_each(|(s, y)| *s = y - *s);
                    if step <= still {
                        // Too short for the merit to see, and it still improves the multipliers.
                        y.copy_from_slice(&self.trial);
                        return true;
                    }
                    let trial = std::mem::take(&mut self.trial);
                    let value = self.merit(&trial, alpha, shift);
                    self.trial = trial;
                    // Where the merit cannot tell any more, shrinking steps can.
                    let level = value <= merit * (1.0 + 8.0 * f64::EPSILON);
                    if value < merit || (level && step < 0.5 * last_step) {
                        break (value, step);
                    }
                }
                damping = (10.0 * damping).max(alpha).max(RESTORING_DAMPING);
            };
            y.copy_from_slice(&self.trial);
            (merit, last_step) = accepted;
            damping = if damping > alpha { (0.1 * damping).max(least) } else { least };
        }
        false
    }
}

#[cfg(test)]
mod tests;
