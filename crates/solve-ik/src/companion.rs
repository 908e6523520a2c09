//! What joints do while no marker shows them, learnt from how they turn with the others in the rest of the take.
//!
//! A Gaussian process, [RW06] Eq. (2.25): the turn of a lost joint is a function of how the seen joints are turned now, a
//! little before and a little later, plus a drift in time that ties it to what was seen beside the gap. Similar
//! postures of the seen joints give similar turns; where the take shows nothing similar, what is left is the drift and
//! the mean.

use std::ops::Range;

use mocap_core::Rotation;

use crate::{
    dense::{Cholesky, inner},
    tree::State,
};

/// Time between the looks before, at and after a frame, in seconds: turns alone do not tell which way a body moves.
const LAG_S: f64 = 0.08;
/// Length scale of the posture, in root mean square distances of postures from their mean.
const LENGTH: f64 = 0.8;
/// Variance of what depends on the posture linearly, which goes on beyond the postures that were seen.
const LINEAR: f64 = 0.5;
/// Variance of the drift, and its length scale in seconds.
const DRIFT: f64 = 0.1;
const DRIFT_S: f64 = 0.5;
/// Variance of what neither tells.
const NOISE: f64 = 1e-4;
/// Weight of the ridge that finds the part of a posture on which the lost joints depend, over the mean variance.
const RIDGE: f64 = 0.01;
/// Frames to learn from at most, and time beside the gap of which every third frame is one, in seconds.
const EXAMPLES: usize = 250;
const BESIDE_S: f64 = 0.2;
/// Frames and seen joints without which nothing is learnt.
const FEWEST_FRAMES: usize = 40;
const FEWEST_JOINTS: usize = 3;

/// The poses of a take, and which joints its markers tell of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen<'a> {
    pub(crate) states: &'a [State],
    pub(crate) rate_hz: f64,
    /// Whether a joint is lost in a frame, `(joints)` of `(frames)`.
    pub(crate) lost: &'a [Vec<bool>],
}

impl Seen<'_> {
    /// Turns `(run, joints)` of joints that are lost in a run of frames; `None` where too little is seen to learn from.
    pub(crate) fn predict(
        &self,
        joints: &[usize],
        run: &Range<usize>,
    ) -> Option<Vec<Vec<Rotation>>> {
        let lag = self.frames(LAG_S);
        let around = run.start.saturating_sub(lag)..(run.end + lag).min(self.states.len());
        let is_witness = |j: &usize| !self.lost[*j][around.clone()].contains(&true);
        // How the root is turned says where the body faces, and nothing of its posture.
        let witnesses: Vec<usize> = (1..self.lost.len()).filter(is_witness).collect();
        let examples = self.examples(joints, &witnesses, run);
        if witnesses.len() < FEWEST_JOINTS || examples.len() < FEWEST_FRAMES {
            return None;
        }
        let wanted: Vec<Turns> =
            joints.iter().map(|&j| self.turns(j, &examples)).collect::<Option<_>>()?;
        let process = Process::new(self, &witnesses, &examples, &wanted, lag)?;
        let frames = run.clone().map(|frame| process.at(self, frame));
        let turn = |(turns, log): (&Turns, &[f64])| {
            turns.mean.after(Rotation::exp([log[0], log[1], log[2]])).normalized()
        };
        Some(
            frames
                .map(|logs| wanted.iter().zip(logs.chunks_exact(3)).map(turn).collect())
                .collect(),
        )
    }

    fn frames(&self, seconds: f64) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "rates are positive"
        )]
        let frames = (seconds * self.rate_hz).round().max(1.0) as usize;
        frames
    }

    /// Frames that show everything needed: all those beside the run, and some of the others.
    fn examples(&self, joints: &[usize], witnesses: &[usize], run: &Range<usize>) -> Vec<usize> {
        let is_shown = |t: &usize| {
            !run.contains(t) && joints.iter().chain(witnesses).all(|&j| !self.lost[j][*t])
        };
        let shown: Vec<usize> = (0..self.states.len()).filter(is_shown).collect();
        let step = shown.len().div_ceil(EXAMPLES).max(1);
        let beside = self.frames(BESIDE_S);
        let near = |t: usize| {
            let off = if t < run.start { run.start - 1 - t } else { t - run.end.min(t) };
            off < beside && off % 3 == 0
        };
        let chosen = shown.iter().enumerate().filter(|&(k, &t)| k % step == 0 || near(t));
        chosen.map(|(_, &t)| t).collect()
    }

    /// Mean turn of a joint in some frames, and the turns from there.
    fn turns(&self, joint: usize, frames: &[usize]) -> Option<Turns> {
        let mut sum = [[0.0; 3]; 3];
        for &frame in frames {
            let turn = self.states[frame].turns[joint].matrix();
            sum.as_flattened_mut().iter_mut().zip(turn.as_flattened()).for_each(|(s, t)| *s += t);
        }
        let mean = Rotation::nearest(&sum)?;
        let log = |&frame: &usize| mean.inverse().after(self.states[frame].turns[joint]).log();
        Some(Turns { mean, logs: frames.iter().map(log).collect() })
    }
}

struct Turns {
    mean: Rotation,
    logs: Vec<[f64; 3]>,
}

/// A Gaussian process that was shown its examples.
struct Process {
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
    fn new(
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
    fn at(&self, seen: &Seen<'_>, frame: usize) -> Vec<f64> {
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

/// What of a raw posture counts: all of it, and once more the part on which the lost turns depend linearly.
#[derive(Debug, Clone, Default)]
struct Aspects {
    /// Rows of the linear part, one a coordinate of the lost turns.
    linear: Vec<Vec<f64>>,
    /// Scales that make each of the two half of a mean square of one.
    scales: [f64; 2],
}

impl Aspects {
    fn new(raw: &[Vec<f64>], targets: &[Vec<f64>]) -> Option<Self> {
        let (n, d) = (raw.len(), raw[0].len());
        let columns: Vec<Vec<f64>> =
            (0..d).map(|c| raw.iter().map(|row| row[c]).collect()).collect();
        let mut matrix = vec![0.0; d * d];
        for i in 0..d {
            for j in 0..=i {
                matrix[i * d + j] = inner(&columns[i], &columns[j]);
            }
        }
        let trace: f64 = (0..d).map(|i| matrix[i * d + i]).sum();
        (0..d).for_each(|i| matrix[i * d + i] += RIDGE * trace / d as f64);
        let factor = Cholesky::new(matrix, d)?;
        let linear: Vec<Vec<f64>> = targets
            .iter()
            .map(|target| {
                let mut row: Vec<f64> = columns.iter().map(|c| inner(c, target)).collect();
                factor.solve(&mut row);
                row
            })
            .collect();
        let mut aspects = Self { linear, scales: [1.0; 2] };
        let fitted: f64 =
            raw.iter().flat_map(|row| aspects.fitted(row)).map(|z| z * z).sum::<f64>();
        let half = |square: f64| if square > 0.0 { (0.5 * n as f64 / square).sqrt() } else { 0.0 };
        aspects.scales = [half(trace), half(fitted)];
        Some(aspects)
    }

    fn fitted<'a>(&'a self, raw: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.linear.iter().map(move |row| inner(row, raw))
    }

    fn posture(&self, raw: &[f64]) -> Vec<f64> {
        let whole = raw.iter().map(|x| self.scales[0] * x);
        whole.chain(self.fitted(raw).map(|z| self.scales[1] * z)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAMES: usize = 600;
    const RATE_HZ: f64 = 120.0;

    /// A root, three joints that swing in step with an irregular beat, and one that follows them.
    fn states(follower: impl Fn(f64) -> f64) -> Vec<State> {
        let phase = |t: usize| {
            let seconds = t as f64 / RATE_HZ;
            8.0 * seconds + 2.0 * (1.3 * seconds).sin()
        };
        let state = |t: usize| {
            let swing = |k: f64| Rotation::exp([0.0, 0.6 * (phase(t) + k).sin(), 0.0]);
            let root = Rotation::exp([0.0, 0.0, 0.01 * t as f64]);
            let follows = Rotation::exp([follower(phase(t)), 0.0, 0.0]);
            State {
                root_m: [0.0; 3],
                turns: vec![root, swing(0.0), swing(1.0), swing(2.0), follows],
            }
        };
        (0..FRAMES).map(state).collect()
    }

    fn lost(run: &Range<usize>) -> Vec<Vec<bool>> {
        let mut lost = vec![vec![false; FRAMES]; 5];
        lost[4][run.clone()].fill(true);
        lost
    }

    #[test]
    fn a_joint_that_follows_the_others_is_found_while_it_is_lost() {
        // Twice a second and for two seconds: nothing that a curve across the gap could know.
        let states = states(|phase| 0.5 * (2.0 * phase).cos());
        let run = 200..440;
        let lost = lost(&run);
        let seen = Seen { states: &states, rate_hz: RATE_HZ, lost: &lost };
        let turns = seen.predict(&[4], &run).unwrap();
        let off = |(k, turn): (usize, &Vec<Rotation>)| {
            turn[0].inverse().after(states[200 + k].turns[4]).angle()
        };
        let mean = turns.iter().enumerate().map(off).sum::<f64>() / turns.len() as f64;
        // The best constant is off by 0.32 rad on average, and a smooth curve by no less.
        assert!(mean < 0.1, "{mean} rad");
    }

    #[test]
    fn nothing_is_learnt_from_too_little() {
        let states = states(f64::cos);
        let run = 20..590;
        let lost = lost(&run);
        let seen = Seen { states: &states, rate_hz: RATE_HZ, lost: &lost };
        assert!(seen.predict(&[4], &run).is_none(), "thirty frames are no example of a motion");
        let all = vec![vec![true; FRAMES]; 5];
        let seen = Seen { lost: &all, ..seen };
        assert!(seen.predict(&[4], &(100..200)).is_none(), "no joint is seen");
    }
}
