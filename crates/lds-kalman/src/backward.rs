//! The covariance half of the Rauch–Tung–Striebel smoother.

use crate::{
    forward::{Forward, Settling},
    kernel,
};

/// Smoothed covariances of one backward pass, shared between frames once they are stationary.
#[derive(Debug, Default)]
pub(crate) struct Backward {
    n: usize,
    /// Per block: `Cov(z[t])`, then `Cov(z[t+1], z[t])`.
    blocks: Vec<f64>,
    block_of: Vec<usize>,
}

impl Backward {
    fn half(&self, frame: usize, which: usize) -> &[f64] {
        let size = self.n * self.n;
        &self.blocks[(2 * self.block_of[frame] + which) * size..][..size]
    }

    /// Covariance of the state of a frame given all frames.
    pub(crate) fn covariance(&self, frame: usize) -> &[f64] {
        self.half(frame, 0)
    }

    /// Covariance of the state of the next frame with that of this one, given all frames.
    pub(crate) fn lag_one(&self, frame: usize) -> &[f64] {
        self.half(frame, 1)
    }

    /// Runs the recursion.
    ///
    /// Implements [Li10] Eq. (27); the lag-one part deviates from [Li10] Eq. (29), which prints
    /// the transposed product.
    pub(crate) fn run(&mut self, n: usize, forward: &Forward, tolerance: f64) {
        let (size, steps) = (n * n, forward.step_of());
        self.n = n;
        self.blocks.clear();
        self.block_of.clear();
        self.block_of.resize(steps.len(), 0);
        let Some(last) = steps.len().checked_sub(1) else { return };
        self.blocks.extend_from_slice(forward.filtered(steps[last]));
        self.blocks.resize(2 * size, 0.0);
        let mut settling = Settling::new(tolerance);
        let mut settled = false;
        for t in (0..last).rev() {
            let same_step = steps[t] == steps[t + 1];
            let next = self.block_of[t + 1];
            if settled && same_step {
                self.block_of[t] = next;
                continue;
            }
            let start = self.blocks.len();
            self.blocks.resize(start + 2 * size, 0.0);
            let (done, new) = self.blocks.split_at_mut(start);
            let later = &done[2 * next * size..][..size];
            let step = EarlierStep { forward, step: steps[t], later, new: &mut *new };
            kernel::fast(n, step);
            settled = same_step && settling.step(later, &new[..size]);
            if !same_step {
                settling = Settling::new(tolerance);
            }
            self.block_of[t] = start / (2 * size);
        }
    }

    /// Adds the covariances of the given frames, in order, to `out`.
    pub(crate) fn add_covariances(&self, frames: impl Iterator<Item = usize>, out: &mut [f64]) {
        self.add(frames, 0, out);
    }

    /// Adds the lag-one covariances of the given frames, in order, to `out`.
    pub(crate) fn add_lag_ones(&self, frames: impl Iterator<Item = usize>, out: &mut [f64]) {
        self.add(frames, 1, out);
    }

    /// Adds runs of frames that share a block in one go.
    fn add(&self, frames: impl Iterator<Item = usize>, which: usize, out: &mut [f64]) {
        let mut run: Option<(usize, usize)> = None;
        for frame in frames {
            run = match run {
                Some((first, count)) if self.block_of[first] == self.block_of[frame] => {
                    Some((first, count + 1))
                }
                previous => {
                    self.flush(previous, which, out);
                    Some((frame, 1))
                }
            };
        }
        self.flush(run, which, out);
    }

    fn flush(&self, run: Option<(usize, usize)>, which: usize, out: &mut [f64]) {
        if let Some((first, count)) = run {
            kernel::add_scaled(out, count as f64, self.half(first, which));
        }
    }
}

/// Computes the covariances of a frame from that of the next.
struct EarlierStep<'a> {
    forward: &'a Forward,
    step: usize,
    later: &'a [f64],
    new: &'a mut [f64],
}

impl kernel::Job for EarlierStep<'_> {
    type Output = ();

    #[allow(clippy::inline_always, reason = "the job takes on the vectors of its caller")]
    #[inline(always)]
    fn run(self, n: usize) {
        let Self { forward, step, later, new } = self;
        let (covariance, lag) = new.split_at_mut(n * n);
        let gain = forward.gain_transposed(step);
        kernel::multiply(later, gain, lag, n);
        kernel::multiply_transposed(gain, lag, covariance, n);
        kernel::add_scaled(covariance, 1.0, forward.conditional(step));
        kernel::symmetrize(covariance, n);
    }
}
