//! What joints do while no marker shows them: they pass smoothly from where they were to where they are seen next.

use std::{collections::BTreeMap, ops::Range};

use mocap_core::{
    Rotation,
    geometry::{add, scale},
};
use rayon::prelude::*;

use crate::{
    companion::Seen,
    sight::Sight,
    track::{Guide, Inertia},
    tree::{State, Tree},
};

/// How far a bridge may be wrong, in radians and metres: firm where no marker is left below a joint, soft where one is. Beside
/// a firm one nothing pulls but what joints do usually, and that was known when the bridge was learnt.
const FIRM_RAD: f64 = 0.005;
const SOFT_RAD: f64 = 0.3;
const FIRM_M: f64 = 0.02;
/// Time over which speeds at the ends of a bridge are taken, and for which they last at most, in seconds.
const SPEED_S: f64 = 0.05;
const LASTING_S: f64 = 0.1;

/// Shorter runs are crossed smoothly; there is nothing to gain from the rest of the take.
const SHORT_S: f64 = 0.15;

/// A run of frames in which a joint is not seen well.
#[derive(Debug, Clone)]
struct Span {
    frames: Range<usize>,
    weight: f64,
    /// Turns learnt from the rest of the take, one a frame; empty where none were.
    learnt: Vec<Rotation>,
}

/// Guides the second pass over a take by the poses of the first.
#[derive(Debug)]
pub(crate) struct Bridges<'a> {
    inertia: Inertia,
    states: &'a [State],
    rate_hz: f64,
    /// Spans of each joint, in order of time.
    spans: Vec<Vec<Span>>,
}

impl<'a> Bridges<'a> {
    /// Finds what has to be bridged; `None` if every joint is seen in every frame.
    pub(crate) fn new(
        tree: &Tree,
        sight: &Sight,
        states: &'a [State],
        inertia: Inertia,
        rate_hz: f64,
    ) -> Option<Self> {
        let below = below(tree);
        let mut spans: Vec<Vec<Span>> = (0..tree.len()).map(|j| spans(&below[j], sight)).collect();
        if spans.iter().all(Vec::is_empty) {
            return None;
        }
        learn(&mut spans, states, rate_hz);
        Some(Self { inertia, states, rate_hz, spans })
    }

    fn span(&self, joint: usize, frame: usize) -> Option<&Span> {
        let spans = &self.spans[joint];
        let at = spans.partition_point(|s| s.frames.end <= frame);
        spans.get(at).filter(|s| s.frames.contains(&frame))
    }

    /// Shares of the way, of the speed at the start and of that at the end, by Hermite's cubic; the frames beside the span.
    fn shares(&self, span: &Span, frame: usize) -> (Option<usize>, Option<usize>, [f64; 3]) {
        let first = span.frames.start.checked_sub(1);
        let last = (span.frames.end < self.states.len()).then_some(span.frames.end);
        let length = (span.frames.len() + 1) as f64;
        let u = (frame + 1 - span.frames.start) as f64 / length;
        let lasting = (length / self.rate_hz).min(LASTING_S);
        let way = u * u * (3.0 - 2.0 * u);
        (first, last, [way, lasting * u * (1.0 - u).powi(2), -lasting * u * u * (1.0 - u)])
    }

    /// The frame some time before or after one, for speeds.
    fn aside(&self, frame: usize, forward: bool) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "rates are positive"
        )]
        let by = (SPEED_S * self.rate_hz).round().max(1.0) as usize;
        if forward { (frame + by).min(self.states.len() - 1) } else { frame.saturating_sub(by) }
    }

    fn turn(&self, joint: usize, span: &Span, frame: usize) -> Option<Rotation> {
        if let Some(turn) = span.learnt.get(frame - span.frames.start) {
            return Some(*turn);
        }
        let at = |frame: usize| self.states[frame].turns[joint];
        let (first, last, [way, out, into]) = self.shares(span, frame);
        let (Some(a), Some(b)) = (first, last) else { return first.or(last).map(at) };
        let speed = |p: usize, q: usize| {
            let frames = (q - p).max(1) as f64;
            scale(self.rate_hz / frames, at(p).inverse().after(at(q)).log())
        };
        let from = at(a);
        // Velocities are in the joint's frame at either end; the one at the end is carried to the start's.
        let whole = from.inverse().after(at(b));
        let (start, end) =
            (speed(self.aside(a, false), a), whole.apply(speed(b, self.aside(b, true))));
        let path = add(scale(way, whole.log()), add(scale(out, start), scale(into, end)));
        Some(from.after(Rotation::exp(path)).normalized())
    }

    fn root(&self, span: &Span, frame: usize) -> Option<[f64; 3]> {
        let at = |frame: usize| self.states[frame].root_m;
        let (first, last, [way, out, into]) = self.shares(span, frame);
        let (Some(a), Some(b)) = (first, last) else { return first.or(last).map(at) };
        let speed = |p: usize, q: usize| {
            let frames = (q - p).max(1) as f64;
            scale(self.rate_hz / frames, std::array::from_fn(|c| at(q)[c] - at(p)[c]))
        };
        let (start, end) = (speed(self.aside(a, false), a), speed(b, self.aside(b, true)));
        let whole = std::array::from_fn(|c| at(b)[c] - at(a)[c]);
        Some(add(at(a), add(scale(way, whole), add(scale(out, start), scale(into, end)))))
    }
}

impl Guide for Bridges<'_> {
    fn ties(&self, frame: usize, before: &State, target: &mut State, turns: &mut [f64]) -> f64 {
        let mut shift = self.inertia.ties(frame, before, target, turns);
        for (joint, weight) in turns.iter_mut().enumerate() {
            let Some(span) = self.span(joint, frame) else { continue };
            if let Some(turn) = self.turn(joint, span, frame) {
                target.turns[joint] = turn;
                *weight = span.weight;
            }
            if joint == 0
                && let Some(root_m) = self.root(span, frame)
            {
                target.root_m = root_m;
                shift = 1.0 / (FIRM_M * FIRM_M);
            }
        }
        shift
    }

    fn is_bridged(&self, frame: usize) -> bool {
        (0..self.spans.len()).any(|joint| self.span(joint, frame).is_some())
    }
}

/// Learns the turns of the longer spans from the rest of the take, those of joints that are lost together at once.
fn learn(spans: &mut [Vec<Span>], states: &[State], rate_hz: f64) {
    let mut lost = vec![vec![false; states.len()]; spans.len()];
    let mut together: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (joint, spans) in spans.iter().enumerate() {
        for Range { start, end } in spans.iter().map(|s| s.frames.clone()) {
            lost[joint][start..end].fill(true);
            if joint > 0 && (end - start) as f64 >= SHORT_S * rate_hz {
                together.entry((start, end)).or_default().push(joint);
            }
        }
    }
    let seen = Seen { states, rate_hz, lost: &lost };
    let learnt: Vec<_> = together
        .par_iter()
        .filter_map(|(&(start, end), joints)| {
            Some((start, joints, seen.predict(joints, &(start..end))?))
        })
        .collect();
    for (start, joints, turns) in learnt {
        for (k, &joint) in joints.iter().enumerate() {
            let span = spans[joint].iter_mut().find(|span| span.frames.start == start);
            if let Some(span) = span {
                span.learnt = turns.iter().map(|frame| frame[k]).collect();
            }
        }
    }
}

/// Markers that each joint moves, as anchors.
fn below(tree: &Tree) -> Vec<Vec<u32>> {
    let mut below = vec![Vec::new(); tree.len()];
    for (index, anchor) in (0..).zip(&tree.anchors) {
        tree.movers(anchor).for_each(|joint| below[joint].push(index));
    }
    below
}

fn spans(markers: &[u32], sight: &Sight) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for frame in 0..sight.frames() {
        let seen = sight
            .at(frame)
            .iter()
            .filter(|(anchor, _)| markers.binary_search(anchor).is_ok())
            .count();
        let weight = match seen {
            0 => 1.0 / (FIRM_RAD * FIRM_RAD),
            1 if markers.len() > 1 => 1.0 / (SOFT_RAD * SOFT_RAD),
            _ => continue,
        };
        match spans.last_mut() {
            // One bridge over frames that show one marker and frames that show none, as firm as those.
            Some(span) if span.frames.end == frame => {
                span.frames.end += 1;
                span.weight = span.weight.max(weight);
            }
            _ => spans.push(Span { frames: frame..frame + 1, weight, learnt: Vec::new() }),
        }
    }
    // A joint that is never seen has no ends to bridge from.
    spans.retain(|span| span.frames.len() < sight.frames());
    spans
}
