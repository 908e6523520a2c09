//! Minimisers of the objective of one frame. Neither ever returns a worse point than it was given.

use crate::problem::Problem;

/// How the missing markers of a frame are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Solver {
    /// Newton with Levenberg–Marquardt damping, to convergence. Costs the cube of the number of
    /// unknown coordinates that bones touch in the frame.
    #[default]
    DampedNewton,
    /// Gradient descent whose step doubles when the objective falls and halves when it does not,
    /// for at most this many evaluations of the objective.
    ///
    /// Implements [Li10] Algorithm 2, third step, with all missing markers of the frame moved at
    /// once.
    AdaptiveGradient {
        /// Evaluations of the objective, at least 1 to have an effect. The authors' code: 99.
        evaluations: usize,
    },
}

/// Steps after which the damped iteration gives up; it takes about five.
const STEPS: usize = 100;

/// A step of at most this many metres ends the iteration.
const STEP_M: f64 = 1e-10;

/// Damping beyond which no step makes a difference.
const MOST_DAMPING: f64 = 1e20;

/// Buffers of a solver, reused from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    gradient: Vec<f64>,
    hessian: Vec<f64>,
    factor: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
}

impl Solver {
    /// Moves `y` to a point of lower objective, or leaves it where it is.
    pub(crate) fn minimise(self, problem: &Problem<'_>, y: &mut [f64], scratch: &mut Scratch) {
        match self {
            Self::DampedNewton => damped_newton(problem, y, scratch),
            Self::AdaptiveGradient { evaluations } => descend(problem, y, evaluations, scratch),
        }
    }
}

fn damped_newton(problem: &Problem<'_>, y: &mut [f64], scratch: &mut Scratch) {
    let n = problem.len();
    let Scratch { gradient, hessian, factor, step, trial } = scratch;
    for (buffer, size) in
        [(&mut *gradient, n), (step, n), (trial, n), (&mut *hessian, n * n), (factor, n * n)]
    {
        buffer.clear();
        buffer.resize(size, 0.0);
    }
    let mut objective = problem.objective(y);
    let mut damping = 0.0;
    for _ in 0..STEPS {
        problem.gradient(y, gradient);
        problem.hessian(y, hessian);
        let unit = (0..n).map(|i| hessian[i * n + i]).sum::<f64>() / n as f64;
        // Damping in units of the mean curvature, so that it means the same in every frame.
        let improved = loop {
            if damping > MOST_DAMPING {
                break None;
            }
            if solve_damped(hessian, damping * unit, gradient, factor, step) {
                if step.iter().all(|s| s.abs() <= STEP_M) {
                    break None;
                }
                for ((t, y), s) in trial.iter_mut().zip(&*y).zip(&*step) {
                    *t = y - s;
                }
                let value = problem.objective(trial);
                if value < objective {
                    break Some(value);
                }
            }
            damping = (damping * 10.0).max(1e-3);
        };
        let Some(value) = improved else { return };
        y.copy_from_slice(trial);
        objective = value;
        damping = if damping > 1e-6 { damping * 0.1 } else { 0.0 };
    }
}

/// Solves `(A + δ I) s = g`; `false` when the matrix has no Cholesky factor.
fn solve_damped(a: &[f64], delta: f64, g: &[f64], factor: &mut [f64], step: &mut [f64]) -> bool {
    let n = g.len();
    for i in 0..n {
        for j in 0..=i {
            let (head, tail) = factor.split_at(i * n);
            let done: f64 =
                if j == i { square(&tail[..j]) } else { product(&tail[..j], &head[j * n..]) };
            let rest = a[i * n + j] + if i == j { delta } else { 0.0 } - done;
            if i != j {
                factor[i * n + j] = rest / factor[j * n + j];
            } else if rest > 0.0 && rest.is_finite() {
                factor[i * n + i] = rest.sqrt();
            } else {
                return false;
            }
        }
    }
    for i in 0..n {
        let done = product(&factor[i * n..i * n + i], step);
        step[i] = (g[i] - done) / factor[i * n + i];
    }
    for i in (0..n).rev() {
        let done: f64 = (i + 1..n).map(|k| factor[k * n + i] * step[k]).sum();
        step[i] = (step[i] - done) / factor[i * n + i];
    }
    true
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn square(a: &[f64]) -> f64 {
    product(a, a)
}

fn descend(problem: &Problem<'_>, y: &mut [f64], evaluations: usize, scratch: &mut Scratch) {
    let n = problem.len();
    let Scratch { gradient, trial, .. } = scratch;
    for buffer in [&mut *gradient, trial] {
        buffer.clear();
        buffer.resize(n, 0.0);
    }
    let mut objective = problem.objective(y);
    let mut rate = 1.0;
    problem.gradient(y, gradient);
    for _ in 0..evaluations {
        for ((t, y), g) in trial.iter_mut().zip(&*y).zip(&*gradient) {
            *t = y - rate * g;
        }
        let value = problem.objective(trial);
        if value < objective {
            y.copy_from_slice(trial);
            objective = value;
            problem.gradient(y, gradient);
            rate *= 2.0;
        } else {
            rate *= 0.5;
        }
        if rate <= f64::EPSILON * f64::EPSILON {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::tests::frames;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_objective_never_rises_and_ends_where_the_gradient_vanishes(frame in frames()) {
            let problem = frame.problem();
            let mut scratch = Scratch::default();
            let before = problem.objective(&frame.prediction);
            let mut y = frame.prediction.clone();
            Solver::DampedNewton.minimise(&problem, &mut y, &mut scratch);
            let after = problem.objective(&y);
            prop_assert!(after <= before);
            let (mut gradient, mut hessian) = (vec![0.0; y.len()], vec![0.0; y.len() * y.len()]);
            problem.gradient(&y, &mut gradient);
            problem.hessian(&y, &mut hessian);
            // Within a nanometre of the bottom along any axis, or so close that the objective
            // cannot tell the difference any more.
            let rounding = 64.0 * f64::EPSILON * (1.0 + after);
            for (i, g) in gradient.iter().enumerate() {
                let curvature = hessian[i * y.len() + i].abs();
                let still = 1e-9 * curvature + (rounding * curvature).sqrt();
                prop_assert!(g.abs() <= still, "slope {g}, allowed {still}");
            }

            let mut slow = frame.prediction.clone();
            let solver = Solver::AdaptiveGradient { evaluations: 99 };
            solver.minimise(&problem, &mut slow, &mut scratch);
            prop_assert!(problem.objective(&slow) <= before);
        }
    }

    #[test]
    fn without_bones_the_prediction_stands() {
        let prediction = [0.1, -0.2, 0.3];
        let problem =
            Problem { prediction: &prediction, precision: &[1e6; 3], sticks: &[], lambda: 1e6 };
        let mut y = prediction;
        Solver::default().minimise(&problem, &mut y, &mut Scratch::default());
        assert_eq!(y.map(f64::to_bits), prediction.map(f64::to_bits));
    }
}
