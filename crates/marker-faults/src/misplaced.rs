//! Runs at distances that the marker never keeps elsewhere.

use crate::{Fault, FaultKind, detector::Scene, deviation::reach_frames};

/// A run is misplaced if so many of its frames are.
const SHARE_OF_FRAMES: f64 = 0.8;
/// Samples that bounds are taken from, and how many that takes.
const SAMPLED: usize = 400;
const LEAST: usize = 20;

/// Runs between gaps, or between a gap and an end of the take, that keep strange distances to more than half of the
/// marker's neighbours in nearly all of their frames.
///
/// Implements the outlier rule of [Holden18] Sec. 5 for runs. Deviates from [Holden18]: bounds come from the take itself, as
/// quantiles; whole runs are judged, and by most neighbours, so that a marker is not blamed for its neighbour.
pub(crate) fn find(scene: &Scene<'_>) -> Vec<Fault> {
    let reach = reach_frames(scene.take.rate_hz());
    let mut found = Vec::new();
    for marker in 0..scene.take.marker_count() {
        let trusted = &scene.trusted[marker];
        for run in trusted.chunk_by(|a, b| b - a <= reach) {
            // A run that is most of the marker is what the marker is.
            if 2 * run.len() >= trusted.len() {
                continue;
            }
            let usual: Vec<Usual> = scene.neighbours[marker]
                .iter()
                .filter_map(|n| Usual::outside(scene, marker, n.marker, run))
                .collect();
            let excesses: Vec<f64> =
                run.iter().filter_map(|&t| excess_m(scene, marker, t, &usual)).collect();
            if excesses.len() as f64 >= SHARE_OF_FRAMES * run.len() as f64 {
                let size_m = excesses.iter().copied().fold(0.0, f64::max);
                let frames = run[0]..run[run.len() - 1] + 1;
                let (kind, limit_m) = (FaultKind::Misplaced, scene.params.slack_m);
                found.push(Fault { marker, frames, kind, size_m, limit_m });
            }
        }
    }
    found
}

/// The distances to a neighbour outside of a run: nine tenths of them lie between the two, in metres.
struct Usual {
    neighbour: usize,
    low_m: f64,
    high_m: f64,
}

impl Usual {
    fn outside(scene: &Scene<'_>, marker: usize, neighbour: usize, run: &[usize]) -> Option<Self> {
        let trusted = &scene.trusted[marker];
        let step = trusted.len().div_ceil(SAMPLED).max(1);
        let inside = run[0]..run[run.len() - 1] + 1;
        let others = trusted.iter().step_by(step).filter(|t| !inside.contains(t));
        let mut distances: Vec<f64> =
            others.filter_map(|&t| scene.take.distance(t, marker, neighbour)).collect();
        distances.sort_by(f64::total_cmp);
        let last = distances.len().checked_sub(LEAST)? + LEAST - 1;
        let (low_m, high_m) = (distances[last / 20], distances[last - last / 20]);
        Some(Self { neighbour, low_m, high_m })
    }
}

/// By how much the distances to most neighbours leave their bounds: the smallest excess of the strange ones.
fn excess_m(scene: &Scene<'_>, marker: usize, t: usize, usual: &[Usual]) -> Option<f64> {
    let (mut seen, mut strange, mut least) = (0_usize, 0_usize, f64::INFINITY);
    for Usual { neighbour, low_m, high_m } in usual {
        let Some(d) = scene.take.distance(t, marker, *neighbour) else { continue };
        seen += 1;
        let room = scene.params.delta * (high_m - low_m) + scene.params.slack_m;
        let excess = (d - high_m - room).max(low_m - room - d);
        if excess > 0.0 {
            strange += 1;
            least = least.min(excess);
        }
    }
    (seen >= 2 && 2 * strange > seen).then_some(least)
}
