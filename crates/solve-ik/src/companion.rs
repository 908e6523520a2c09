//! What joints do while no marker shows them, learnt from how they turn with the others in the rest of the take.
//!
//! A Gaussian process, [RW06] Eq. (2.25): the turn of a lost joint is a function of how the seen joints are turned now, a
//! little before and a little later, plus a drift in time that ties it to what was seen beside the gap. Similar
//! postures of the seen joints give similar turns; where the take shows nothing similar, what is left is the drift and
//! the mean.

use std::ops::Range;

use mocap_core::Rotation;

use crate::tree::State;

mod aspects;
mod process;

use process::Process;

/// Time between the looks before, at and after a frame, in seconds: turns alone do not tell which way a body moves.
const LAG_S: f64 = 0.08;
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
