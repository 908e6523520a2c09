//! Poses over time.

use std::ops::Range;

use mocap_core::Rotation;
use rayon::prelude::*;

use crate::{
    IkParams,
    frame::{Fit, FrameSolver, Seen, Ties},
    sight::Sight,
    start::cold_start,
    tree::{State, Tree},
};

/// Frames a chunk, whatever the number of threads: the same chunks, the same bits.
const CHUNK: usize = 256;
/// Frames between two looks at the clock.
pub(crate) const BATCH: usize = 16 * CHUNK;
/// Time between the frames of the scout, in seconds.
const SCOUT_S: f64 = 1.0 / 15.0;
/// Further steps of a frame that is still moving.
const HARD_STEPS: usize = 60;
/// Poses of other frames from which a joint that comes back into view is looked for.
const GUESSES: usize = 12;
/// Steps a frame of the scout.
const SCOUT_STEPS: usize = 20;

/// Poses of every n-th frame, which the others start from.
#[derive(Debug)]
pub(crate) struct Scout {
    /// Frames between two of them.
    pub(crate) stride: usize,
    pub(crate) states: Vec<State>,
}

/// How far a joint turns by itself between two frames, as a weight per rad².
fn tie(params: &IkParams, seconds: f64) -> f64 {
    1.0 / (params.turn_rad_s * params.turn_rad_s * seconds)
}

/// Weight per m² of the root's rest between frames: a metre a second, which only counts where no marker is seen.
const SHIFT_M_S: f64 = 10.0;

fn shift_tie(seconds: f64) -> f64 {
    1.0 / (SHIFT_M_S * SHIFT_M_S * seconds)
}

/// Solves every n-th frame one after the other, from the clearest frame on to both ends.
///
/// Every frame of the take counts for finding the clearest; `None` if no frame tells where the body is.
pub(crate) fn scout(tree: &Tree, sight: &Sight, params: &IkParams, rate_hz: f64) -> Option<Scout> {
    // The rate is positive, and a stride of more frames than there are is one of all.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the take"
    )]
    let stride = (rate_hz * SCOUT_S).round().clamp(1.0, CHUNK as f64) as usize;
    let clearest = sight.clearest()?;
    let mut solver = FrameSolver::new(tree, params);
    let first = cold_start(&mut solver, sight.at(clearest))?;
    let count = sight.frames().div_ceil(stride);
    let start = (clearest / stride).min(count - 1);
    let turns = vec![tie(params, stride as f64 / rate_hz); tree.len()];
    let shift = shift_tie(stride as f64 / rate_hz);
    let mut states: Vec<Option<State>> = vec![None; count];
    let mut walk = |from: &State, order: &mut dyn Iterator<Item = usize>| {
        let mut state = from.clone();
        let mut before = clearest;
        for k in order {
            let frame = k * stride;
            let target = state.clone();
            let ties = Ties { target: &target, shift, turns: &turns };
            solver.solve(&mut state, sight.at(frame), &ties, SCOUT_STEPS);
            let returned: Vec<usize> = sight.newly_shown(frame, before).collect();
            if !returned.is_empty() {
                let known: Vec<&State> = states.iter().flatten().collect();
                let step = known.len().div_ceil(GUESSES).max(1);
                let mut guesses: Vec<State> = known
                    .iter()
                    .step_by(step)
                    .map(|known| with_turns(&state, known, &returned))
                    .collect();
                guesses.extend(cold_start(&mut solver, sight.at(frame)));
                find_again(&mut solver, &mut state, sight.at(frame), &ties, guesses);
            }
            states[k] = Some(state.clone());
            before = frame;
        }
    };
    walk(&first, &mut (start..count));
    walk(&first, &mut (0..start).rev());
    Some(Scout { stride, states: states.into_iter().flatten().collect() })
}

/// A joint that was out of sight is not where it was held, and from there the way to its markers may end elsewhere. The guess
/// that explains the frame best is taken, if it does so better than the pose.
fn find_again(
    solver: &mut FrameSolver<'_>,
    state: &mut State,
    seen: &[Seen],
    ties: &Ties<'_>,
    guesses: impl IntoIterator<Item = State>,
) -> Option<Fit> {
    let mut best = solver.cost(state, seen, ties);
    let mut found = None;
    for mut guess in guesses {
        let fit = solver.solve(&mut guess, seen, ties, HARD_STEPS);
        if fit.cost < best {
            best = fit.cost;
            *state = guess;
            found = Some(fit);
        }
    }
    found
}

/// A pose with the turns of some joints from another one.
fn with_turns(state: &State, other: &State, joints: &[usize]) -> State {
    let mut state = state.clone();
    for &joint in joints {
        state.turns[joint] = other.turns[joint];
    }
    state
}

/// Poses of every frame, and how they came out.
#[derive(Debug)]
pub(crate) struct Track {
    pub(crate) states: Vec<State>,
    pub(crate) fits: Vec<Fit>,
}

/// What the frames of a joint are held to where its markers are gone: `(frames)` of each joint, as poses with weights.
pub(crate) trait Guide: Sync {
    /// Target and weights of a frame, given the pose before it.
    fn ties(&self, frame: usize, before: &State, target: &mut State, turns: &mut [f64]) -> f64;

    /// Whether a frame is held to anything but the one before it.
    fn is_bridged(&self, _: usize) -> bool {
        false
    }
}

/// Holds each frame to the one before it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inertia {
    pub(crate) turn: f64,
    pub(crate) shift: f64,
}

impl Inertia {
    pub(crate) fn new(params: &IkParams, rate_hz: f64) -> Self {
        Self { turn: tie(params, 1.0 / rate_hz), shift: shift_tie(1.0 / rate_hz) }
    }
}

impl Guide for Inertia {
    fn ties(&self, _: usize, before: &State, target: &mut State, turns: &mut [f64]) -> f64 {
        target.root_m = before.root_m;
        target.turns.copy_from_slice(&before.turns);
        turns.fill(self.turn);
        self.shift
    }
}

/// Solves some frames, from a first one that is a multiple of the chunk, chunk by chunk from the scout's poses.
pub(crate) fn track(
    tree: &Tree,
    sight: &Sight,
    params: &IkParams,
    scout: &Scout,
    guide: &dyn Guide,
    frames: Range<usize>,
) -> Track {
    let chunks: Vec<usize> = frames.clone().step_by(CHUNK).collect();
    let solve = |&start: &usize| {
        chunk(tree, sight, params, scout, guide, start..(start + CHUNK).min(frames.end))
    };
    let parts: Vec<Vec<(State, Fit)>> = chunks.par_iter().map(solve).collect();
    let (states, fits) = parts.into_iter().flatten().unzip();
    Track { states, fits }
}

fn chunk(
    tree: &Tree,
    sight: &Sight,
    params: &IkParams,
    scout: &Scout,
    guide: &dyn Guide,
    frames: Range<usize>,
) -> Vec<(State, Fit)> {
    let mut solver = FrameSolver::new(tree, params);
    // One scouted frame earlier, so that the chunk joins the one before it as if it had been solved with it.
    let scouted = (frames.start / scout.stride).saturating_sub(1).min(scout.states.len() - 1);
    let mut before = scout.states[scouted].clone();
    let mut last: Option<State> = None;
    let mut target = tree.rest();
    let mut turns = vec![0.0; tree.len()];
    let mut solved = Vec::with_capacity(frames.len());
    for frame in scouted * scout.stride..frames.end {
        let shift = guide.ties(frame, &before, &mut target, &mut turns);
        let ties = Ties { target: &target, shift, turns: &turns };
        // A body moves on as it did.
        let mut state = last.as_ref().map_or_else(|| before.clone(), |last| ahead(last, &before));
        let mut fit = solver.solve(&mut state, sight.at(frame), &ties, params.iterations);
        if !fit.converged {
            // A limb that comes back into view is far from where it was held.
            fit = solver.solve(&mut state, sight.at(frame), &ties, HARD_STEPS);
            fit.iterations += params.iterations;
        }
        let returned: Vec<usize> = match frame.checked_sub(1) {
            Some(before) => sight.newly_shown(frame, before).collect(),
            None => Vec::new(),
        };
        if !returned.is_empty() {
            let scouted = frame.div_ceil(scout.stride).min(scout.states.len() - 1);
            let guess = with_turns(&state, &scout.states[scouted], &returned);
            let found = find_again(&mut solver, &mut state, sight.at(frame), &ties, [guess]);
            fit = found.unwrap_or(fit);
        }
        if frame >= frames.start {
            solved.push((state.clone(), fit));
        }
        let passed = std::mem::replace(&mut before, state);
        // From where a joint was held to where it is found is no movement to go on with.
        last = returned.is_empty().then_some(passed);
    }
    solved
}

/// Solves the bridged frames once more, run by run, each from the pose before it.
pub(crate) fn retrack(
    tree: &Tree,
    sight: &Sight,
    params: &IkParams,
    track: &Track,
    bridges: &dyn Guide,
) -> Vec<(usize, State, Fit)> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for frame in (0..sight.frames()).filter(|&frame| bridges.is_bridged(frame)) {
        match runs.last_mut() {
            // Long runs are cut, so that there is work for every thread.
            Some(run) if run.end == frame && run.len() < CHUNK => run.end += 1,
            _ => runs.push(frame..frame + 1),
        }
    }
    let solve = |run: &Range<usize>| {
        let mut solver = FrameSolver::new(tree, params);
        let mut before = track.states[run.start.saturating_sub(1)].clone();
        let mut target = tree.rest();
        let mut turns = vec![0.0; tree.len()];
        let mut solved = Vec::with_capacity(run.len());
        for frame in run.clone() {
            let shift = bridges.ties(frame, &before, &mut target, &mut turns);
            let mut state = target.clone();
            let ties = Ties { target: &target, shift, turns: &turns };
            let fit = solver.solve(&mut state, sight.at(frame), &ties, params.iterations);
            before.clone_from(&state);
            solved.push((frame, state, fit));
        }
        solved
    };
    let parts: Vec<Vec<(usize, State, Fit)>> = runs.par_iter().map(solve).collect();
    parts.into_iter().flatten().collect()
}

/// The pose as far again from `before` as that is from `last`.
fn ahead(last: &State, before: &State) -> State {
    let turn = |(p, q): (&Rotation, &Rotation)| q.after(p.inverse()).after(*q).normalized();
    State {
        root_m: std::array::from_fn(|a| 2.0 * before.root_m[a] - last.root_m[a]),
        turns: last.turns.iter().zip(&before.turns).map(turn).collect(),
    }
}
