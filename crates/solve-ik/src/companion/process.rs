//! The Gaussian process.

use mocap_core::Rotation;

use super::{Seen, Turns, aspects::Aspects};
use crate::dense::{Cholesky, inner};

/// Length scale of the posture, in root mean square distances of postures from their mean.
const LENGTH: f64 = 0.8;
/// Variance of what depends on the posture linearly, which goes on beyond the postures that were seen.
const LINEAR: f64 = 0.5;
/// Variance of the drift, and its length scale in seconds.
const DRIFT: f64 = 0.1;
const DRIFT_S: f64 = 0.5;
/// Variance of what neither tells.
const NOISE: f64 = 1e-4;

/// A Gaussian process that was shown its examples.
pub(super) struct Process {
    witnesses: Vec<(usize, Rotation)>,
    lag: usize,
    frames: Vec<usize>,
    /// Mean of the raw postures, and their ranges from there.
    mean: Vec<f64>,
    ranges: Vec<[f64; 2]>,
    aspects: Aspects,
    /// One row an example.
    postures: Vec<Vec<f64>>,
    /// Mean of each coordinate of the turns, its range from there, and its weights of the examples.
    offsets: Vec<f64>,
    reaches: Vec<[f64; 2]>,
    weights: Vec<Vec<f64>>,
    rate_hz: f64,
}

impl Process {
    pub(super) fn new(
        seen: &Seen<'_>,
        witnesses: &[usize],
        frames: &[usize],
        wanted: &[Turns],
        lag: usize,
    ) -> Option<Self> {
        let with_mean = |&j: &usize| Some((j, seen.turns(j, frames)?.mean));
        let mut process = Self {
            witnesses: witnesses.iter().map(with_mean).collect::<Option<_>>()?,
            lag,
            frames: frames.to_vec(),
            mean: Vec::new(),
            ranges: Vec::new(),
            aspects: Aspects::default(),
            postures: Vec::new(),
            offsets: Vec::new(),
            reaches: Vec::new(),
            weights: Vec::new(),
            rate_hz: seen.rate_hz,
        };
        let n = frames.len();
        let mut raw: Vec<Vec<f64>> = frames.iter().map(|&t| process.raw(seen, t)).collect();
        process.mean = (0..raw[0].len())
            .map(|c| raw.iter().map(|row| row[c]).sum::<f64>() / n as f64)
            .collect();
        for row in &mut raw {
            row.iter_mut().zip(&process.mean).for_each(|(x, m)| *x -= m);
        }
        process.ranges = (0..raw[0].len()).map(|c| range(raw.iter().map(|row| row[c]))).collect();
        let mut targets: Vec<Vec<f64>> = Vec::new();
        for turns in wanted {
            targets.extend((0..3).map(|a| turns.logs.iter().map(|log| log[a]).collect()));
        }
        for target in &mut targets {
            let mean = target.iter().sum::<f64>() / n as f64;
            for y in target.iter_mut() {
                *y -= mean;
            }
            process.offsets.push(mean);
            process.reaches.push(range(target.iter().copied()));
        }
        process.aspects = Aspects::new(&raw, &targets)?;
        process.postures = raw.iter().map(|row| process.aspects.posture(row)).collect();
        let mut matrix = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                matrix[i * n + j] = process.kernel(i, &process.postures[j], frames[j]);
            }
            matrix[i * n + i] += NOISE;
        }
        let factor = Cholesky::new(matrix, n)?;
        for target in &mut targets {
            factor.solve(target);
        }
        process.weights = targets;
        Some(process)
    }

    /// Turns of the witnesses now, a little before and a little later.
    fn raw(&self, seen: &Seen<'_>, frame: usize) -> Vec<f64> {
        let last = seen.states.len() - 1;
        let looks = [frame.saturating_sub(self.lag), frame, (frame + self.lag).min(last)];
        let logs = looks.iter().flat_map(|&t| {
            let log = move |&(j, mean): &(usize, Rotation)| {
                mean.inverse().after(seen.states[t].turns[j]).log()
            };
            self.witnesses.iter().flat_map(log)
        });
        logs.collect()
    }

    fn kernel(&self, example: usize, posture: &[f64], frame: usize) -> f64 {
        let here = &self.postures[example];
        let square: f64 = here.iter().zip(posture).map(|(a, b)| (a - b) * (a - b)).sum();
        let seconds = self.frames[example].abs_diff(frame) as f64 / self.rate_hz;
        let r = 5.0_f64.sqrt() * seconds / DRIFT_S;
        // Matérn's kernel of order 5/2, [RW06] Eq. (4.17).
        let drift = (1.0 + r + r * r / 3.0) * (-r).exp();
        let nonlinear = (-square / (2.0 * LENGTH * LENGTH)).exp();
        LINEAR * inner(here, posture) + nonlinear + DRIFT * drift
    }

    /// Coordinates of the lost turns in a frame.
    pub(super) fn at(&self, seen: &Seen<'_>, frame: usize) -> Vec<f64> {
        let mut raw = self.raw(seen, frame);
        // Neither postures nor turns go beyond what was seen: a joint that turns by more than half a circle would come out at
        // the other end.
        for ((x, mean), [low, high]) in raw.iter_mut().zip(&self.mean).zip(&self.ranges) {
            *x = (*x - mean).clamp(*low, *high);
        }
        let posture = self.aspects.posture(&raw);
        let kernels: Vec<f64> =
            (0..self.frames.len()).map(|k| self.kernel(k, &posture, frame)).collect();
        let value = |((weights, offset), [low, high]): ((&Vec<f64>, &f64), &[f64; 2])| {
            offset + inner(weights, &kernels).clamp(*low, *high)
        };
        self.weights.iter().zip(&self.offsets).zip(&self.reaches).map(value).collect()
    }
}

/// Least and largest of values whose mean is 0.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([0.0; 2], |[low, high], x| [low.min(x), high.max(x)])
}
