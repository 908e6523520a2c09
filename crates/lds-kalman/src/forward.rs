//! The covariance half of the Kalman filter, which depends on the mask but not on the values.
//!
//! Consecutive frames with the same pattern of missing entries drive the covariances to a fixed
//! point. Once it is reached they share one step, so that a long take costs as many covariance
//! steps as it has transients, not frames.

use crate::{dynamics::Dynamics, kernel};

/// A covariance counts as stationary when no entry will change by more than this times its largest
/// entry, to go by the pace at which the last changes fell. Results with and without stopping
/// agree to about 1e-10, since a mean passes through as many gains as the filter remembers.
pub(crate) const STATIONARY: f64 = 1e-11;

/// Changes as small as this share of those still allowed are rounding, whatever their pace.
const ROUNDING: f64 = 1e-2;

/// Watches a recursion come to its fixed point, which it approaches by a constant factor a step.
#[derive(Debug)]
pub(crate) struct Settling {
    tolerance: f64,
    change: f64,
}

impl Settling {
    pub(crate) fn new(tolerance: f64) -> Self {
        Self { tolerance, change: f64::INFINITY }
    }

    /// Whether the changes to come add up to no more than the tolerance, after a step from `before`
    /// to `now`.
    pub(crate) fn step(&mut self, before: &[f64], now: &[f64]) -> bool {
        let (size, change) = kernel::magnitude_and_change(now, before);
        let pace = if self.change.is_finite() { change / self.change } else { 1.0 };
        self.change = change;
        let to_come = if pace < 1.0 { change * pace / (1.0 - pace) } else { f64::INFINITY };
        to_come.min(change / ROUNDING) <= self.tolerance * size
    }
}

const BLOCKS: usize = 5;

/// The covariance steps of one forward pass.
#[derive(Debug, Default)]
pub(crate) struct Forward {
    n: usize,
    blocks: Vec<f64>,
    log_determinants: Vec<f64>,
    step_of: Vec<usize>,
    scratch: [Vec<f64>; 4],
}

impl Forward {
    fn block(&self, step: usize, which: usize) -> &[f64] {
        let size = self.n * self.n;
        &self.blocks[(step * BLOCKS + which) * size..][..size]
    }

    /// Covariance of the state given the frames up to this one, `V`.
    pub(crate) fn filtered(&self, step: usize) -> &[f64] {
        self.block(step, 0)
    }

    /// Covariance of the next state given the frames up to this one, `P`.
    fn predicted(&self, step: usize) -> &[f64] {
        self.block(step, 1)
    }

    fn predicted_factor(&self, step: usize) -> &[f64] {
        self.block(step, 2)
    }

    /// Transposed smoother gain, `Jᵀ = P⁻¹ F V`.
    pub(crate) fn gain_transposed(&self, step: usize) -> &[f64] {
        self.block(step, 3)
    }

    /// Covariance of the state given the frames up to this one and the next state.
    pub(crate) fn conditional(&self, step: usize) -> &[f64] {
        self.block(step, 4)
    }

    /// `ln det(Σ + G P Gᵀ) − ln det Σ` over the entries the step observes.
    pub(crate) fn log_determinant(&self, step: usize) -> f64 {
        self.log_determinants[step]
    }

    pub(crate) fn step_of(&self) -> &[usize] {
        &self.step_of
    }

    /// Runs the recursion over frames whose information matrices are the blocks `pattern_of` of
    /// `information`; `false` when a covariance is not positive definite.
    ///
    /// Implements [Li10] Eq. (15), (16), (18), (20), (22) and (25) in the information form, whose
    /// size is the hidden dimension.
    pub(crate) fn run(
        &mut self,
        dynamics: &Dynamics,
        information: &[f64],
        pattern_of: &[usize],
        tolerance: f64,
    ) -> bool {
        let size = dynamics.n * dynamics.n;
        self.n = dynamics.n;
        self.blocks.clear();
        self.log_determinants.clear();
        self.step_of.clear();
        self.scratch.iter_mut().for_each(|s| s.resize(size, 0.0));
        let mut settling = Settling::new(tolerance);
        let mut settled = false;
        for (t, &pattern) in pattern_of.iter().enumerate() {
            let previous = self.step_of.last().copied();
            let same_pattern = t > 0 && pattern_of[t - 1] == pattern;
            if settled && same_pattern {
                self.step_of.extend(previous);
                continue;
            }
            let information = &information[pattern * size..][..size];
            let next = NextStep { forward: self, dynamics, information, previous };
            let Some(step) = kernel::fast(dynamics.n, next) else { return false };
            settled = false;
            if let Some(previous) = previous.filter(|_| same_pattern) {
                settled = settling.step(self.filtered(previous), self.filtered(step));
            } else {
                settling = Settling::new(tolerance);
            }
            self.step_of.push(step);
        }
        true
    }

    /// Covariance of the state of `frame` given the frames before it.
    pub(crate) fn predicted_at<'a>(&'a self, frame: usize, dynamics: &'a Dynamics) -> &'a [f64] {
        match frame.checked_sub(1) {
            Some(before) => self.predicted(self.step_of[before]),
            None => &dynamics.initial_covariance,
        }
    }
}

/// Appends the step that follows `previous`.
struct NextStep<'a> {
    forward: &'a mut Forward,
    dynamics: &'a Dynamics,
    information: &'a [f64],
    previous: Option<usize>,
}

impl kernel::Job for NextStep<'_> {
    type Output = Option<usize>;

    #[allow(clippy::inline_always, reason = "the job takes on the vectors of its caller")]
    #[inline(always)]
    fn run(self, n: usize) -> Option<usize> {
        let Self { forward, dynamics, information, previous } = self;
        let mut scratch = std::mem::take(&mut forward.scratch);
        let [a, b, c, d] = &mut scratch;
        match previous {
            Some(p) => a.copy_from_slice(forward.predicted_factor(p)),
            None => kernel::cholesky(&dynamics.initial_covariance, a, n).then_some(())?,
        }
        // With P = Uᵀ U: V = (P⁻¹ + S)⁻¹ = Uᵀ (I + U S Uᵀ)⁻¹ U, whose inner matrix is never worse
        // conditioned than one plus the signal-to-noise ratio.
        kernel::transpose(a, d, n);
        kernel::multiply(information, d, b, n);
        kernel::multiply(a, b, c, n);
        kernel::symmetrize(c, n);
        (0..n).for_each(|i| c[i * n + i] += 1.0);
        kernel::cholesky(c, b, n).then_some(())?;
        let log_determinant = kernel::log_determinant(b, n);
        c.copy_from_slice(a);
        kernel::solve_lower(b, c, n, n);
        kernel::multiply_transposed(c, c, a, n);
        forward.blocks.extend_from_slice(a);

        kernel::multiply(&dynamics.transition, a, b, n);
        kernel::multiply(b, &dynamics.transition_transposed, c, n);
        c.iter_mut().zip(&dynamics.state_noise).for_each(|(x, q)| *x += q);
        kernel::symmetrize(c, n);
        kernel::cholesky(c, d, n).then_some(())?;
        forward.blocks.extend_from_slice(c);
        forward.blocks.extend_from_slice(d);

        c.copy_from_slice(b);
        kernel::solve_cholesky(d, c, n, n);
        forward.blocks.extend_from_slice(c);
        kernel::multiply_transposed(c, b, d, n);
        d.iter_mut().zip(a.iter()).for_each(|(x, v)| *x = v - *x);
        kernel::symmetrize(d, n);
        forward.blocks.extend_from_slice(d);

        forward.scratch = scratch;
        forward.log_determinants.push(log_determinant);
        Some(forward.log_determinants.len() - 1)
    }
}
