//! Labels that two markers exchange.

use std::{collections::BTreeMap, ops::Range};

use mocap_core::geometry::{add, distance, norm, sub};

use crate::{
    Fault, FaultKind,
    breaks::{Break, breaks},
    detector::Scene,
    neighbours::Neighbour,
};

/// With labels exchanged, the step has to shrink to this share.
const HEALED: f64 = 0.5;
/// Share of the difference between two markers' usual distances that decides which labels fit better.
const DECISIVE: f64 = 0.25;

/// Pairs that break in the same frame, each to where the other was heading.
///
/// Such frames cut the take into stretches in which the labels are right and stretches in which they are
/// exchanged. Which are which, the distances to the neighbours of both tell; where they do not, the exchanged ones are taken to be
/// the shorter ones.
pub(crate) fn find(scene: &Scene<'_>) -> Vec<Fault> {
    let mut at_frame: BTreeMap<usize, Vec<(usize, Break)>> = BTreeMap::new();
    for marker in 0..scene.take.marker_count() {
        for found in breaks(scene, marker) {
            at_frame.entry(found.first).or_default().push((marker, found));
        }
    }
    let mut exchanges: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (&frame, breaking) in &at_frame {
        for (k, (a, one)) in breaking.iter().enumerate() {
            for (b, other) in &breaking[k + 1..] {
                if exchanged(scene, frame, (*a, one), (*b, other)) {
                    exchanges.entry((*a, *b)).or_default().push(frame);
                }
            }
        }
    }
    exchanges.into_iter().flat_map(|(pair, frames)| of_pair(scene, pair, &frames)).collect()
}

/// Whether each marker goes on where the other was heading.
fn exchanged(
    scene: &Scene<'_>,
    frame: usize,
    (a, one): (usize, &Break),
    (b, other): (usize, &Break),
) -> bool {
    let at = |m| scene.take.position(frame, m);
    let (Some(p), Some(q)) = (at(a), at(b)) else { return false };
    let (left_a, left_b) = (add(one.step, sub(q, p)), add(other.step, sub(p, q)));
    norm(left_a) <= HEALED * norm(one.step) && norm(left_b) <= HEALED * norm(other.step)
}

fn of_pair(scene: &Scene<'_>, (a, b): (usize, usize), frames: &[usize]) -> Vec<Fault> {
    let ends = [0].into_iter().chain(frames.iter().copied()).chain([scene.take.frames()]);
    let ends: Vec<usize> = ends.collect();
    let stretches: Vec<Range<usize>> = ends.windows(2).map(|w| w[0]..w[1]).collect();
    let signature = Signature::of(scene, a, b);
    // How many frames say that odd stretches are exchanged, less those that say even ones are.
    let mut odd_frames = 0.0;
    for (k, stretch) in stretches.iter().enumerate() {
        let vote = signature.vote(scene, stretch) * stretch.len() as f64;
        odd_frames += if k % 2 == 1 { vote } else { -vote };
    }
    let length = |parity: usize| -> usize {
        stretches.iter().skip(parity).step_by(2).map(ExactSizeIterator::len).sum()
    };
    let parity = if odd_frames.abs() > f64::MIN_POSITIVE {
        usize::from(odd_frames > 0.0)
    } else {
        usize::from(length(1) <= length(0))
    };
    let chosen = stretches.iter().skip(parity).step_by(2).filter(|s| !s.is_empty());
    chosen.flat_map(|stretch| both(scene, (a, b), stretch)).collect()
}

fn both(scene: &Scene<'_>, (a, b): (usize, usize), frames: &Range<usize>) -> [Fault; 2] {
    let apart = frames.clone().filter_map(|t| scene.take.distance(t, a, b));
    let (n, sum) = apart.fold((0_usize, 0.0), |(n, sum), d| (n + 1, sum + d));
    let size_m = if n == 0 { 0.0 } else { sum / n as f64 };
    let limit_m = scene.limit_m(scene.params.step_m);
    let fault = |marker, with| Fault {
        marker,
        frames: frames.clone(),
        kind: FaultKind::Swap { with },
        size_m,
        limit_m,
    };
    [fault(a, b), fault(b, a)]
}

/// The distances by which two markers can be told apart.
struct Signature {
    pair: (usize, usize),
    /// A neighbour of both, with the usual distance to either in metres.
    around: Vec<(usize, [f64; 2])>,
}

impl Signature {
    fn of(scene: &Scene<'_>, a: usize, b: usize) -> Self {
        let usual =
            |of: &[Neighbour], m: usize| of.iter().find(|n| n.marker == m).map(|n| n.median_m);
        let near_a = scene.neighbours[a].iter().filter(|n| n.marker != b);
        let around = near_a
            .filter_map(|n| Some((n.marker, [n.median_m, usual(&scene.neighbours[b], n.marker)?])))
            .collect();
        Self { pair: (a, b), around }
    }

    /// 1 where the exchanged labels fit better, −1 where the given ones do, 0 where it cannot be told.
    fn vote(&self, scene: &Scene<'_>, frames: &Range<usize>) -> f64 {
        let difference: f64 = self.around.iter().map(|(_, [x, y])| (x - y).abs()).sum();
        // The votes of a few dozen frames decide as well as those of thousands.
        let step = (frames.len() / 64).max(1);
        let mut balance: Vec<f64> =
            frames.clone().step_by(step).filter_map(|t| self.balance(scene, t)).collect();
        if balance.is_empty() {
            return 0.0;
        }
        balance.sort_by(f64::total_cmp);
        let middle = balance[balance.len() / 2];
        if middle.abs() < (DECISIVE * difference).max(scene.params.size_m) {
            0.0
        } else {
            middle.signum()
        }
    }

    /// Misfit of the given labels less misfit of the exchanged ones, in metres.
    fn balance(&self, scene: &Scene<'_>, t: usize) -> Option<f64> {
        let (p, q) = (scene.take.position(t, self.pair.0)?, scene.take.position(t, self.pair.1)?);
        let mut seen = false;
        let mut balance = 0.0;
        for (m, [to_a, to_b]) in &self.around {
            let Some(place) = scene.take.position(t, *m) else { continue };
            seen = true;
            let (x, y) = (distance(p, place), distance(q, place));
            balance += (x - to_a).abs() + (y - to_b).abs() - (y - to_a).abs() - (x - to_b).abs();
        }
        seen.then_some(balance)
    }
}

/// The faults found, in which spikes of two markers in the same frames that exchanging them heals are swaps.
pub(crate) fn pair_up(scene: &Scene<'_>) -> Vec<Fault> {
    let mut faults = scene.found.clone();
    let short = |fault: &Fault| matches!(fault.kind, FaultKind::Spike);
    let mut by_frames: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (k, fault) in faults.iter().enumerate().filter(|(_, fault)| short(fault)) {
        by_frames.entry((fault.frames.start, fault.frames.end)).or_default().push(k);
    }
    for together in by_frames.into_values().filter(|together| together.len() > 1) {
        for (k, &i) in together.iter().enumerate() {
            for &j in &together[k + 1..] {
                let (a, b) = (faults[i].marker, faults[j].marker);
                if short(&faults[i]) && short(&faults[j]) && heals(scene, (a, b), &faults[i].frames)
                {
                    let [one, other] = both(scene, (a, b), &faults[i].frames.clone());
                    (faults[i], faults[j]) = (one, other);
                }
            }
        }
    }
    faults
}

/// Whether exchanged labels bring both markers back to the straight line across the frames.
fn heals(scene: &Scene<'_>, (a, b): (usize, usize), frames: &Range<usize>) -> bool {
    let (Some(before), after) = (frames.start.checked_sub(1), frames.end) else { return false };
    if after >= scene.take.frames() {
        return false;
    }
    let at = |t, m| scene.take.position(t, m);
    frames.clone().all(|t| {
        let share = (t - before) as f64 / (after - before) as f64;
        let line = |m: usize| {
            let (p, q) = (at(before, m)?, at(after, m)?);
            Some(std::array::from_fn(|axis| p[axis] + share * (q[axis] - p[axis])))
        };
        let healed = |m: usize, other: usize| {
            let line: [f64; 3] = line(m)?;
            Some(distance(at(t, other)?, line) <= HEALED * distance(at(t, m)?, line))
        };
        healed(a, b) == Some(true) && healed(b, a) == Some(true)
    })
}
