//! Stays away from the path, and junk beside gaps.

use mocap_core::geometry::{add, norm};

use crate::{Fault, FaultKind, breaks::breaks, detector::Scene, deviation::Deviations};

/// Two steps cancel if less than this share of the larger one is left.
const CANCELLED: f64 = 0.5;

/// Runs between two breaks that cancel.
pub(crate) fn find_jumps(scene: &Scene<'_>) -> Vec<Fault> {
    let longest = scene.frames(scene.params.longest_jump_s);
    let mut found = Vec::new();
    for marker in 0..scene.take.marker_count() {
        let breaks = breaks(scene, marker);
        let mut k = 0;
        while k < breaks.len() {
            let away = &breaks[k];
            let later = breaks[k + 1..].iter().take_while(|b| b.first - away.first <= longest);
            // Not always the next one: in the middle of four equal samples the parabolas miss as well.
            let back = later.enumerate().find(|(_, back)| {
                let left = norm(add(away.step, back.step));
                left <= CANCELLED * norm(away.step).max(norm(back.step))
            });
            k += back.map_or(1, |(at, _)| at + 2);
            found.extend(back.map(|(_, back)| Fault {
                marker,
                frames: away.first..back.last + 1,
                kind: FaultKind::Jump,
                size_m: norm(away.step).max(norm(back.step)),
                limit_m: scene.limit_m(scene.params.step_m),
            }));
        }
    }
    found
}

/// Samples beside a gap that the path behind them does not lead to.
pub(crate) fn find_edges(scene: &Scene<'_>) -> Vec<Fault> {
    let edge = scene.frames(scene.params.edge_s);
    let mut found = Vec::new();
    for marker in 0..scene.take.marker_count() {
        let is_gap = |a: usize, b: usize| (a + 1..b).any(|t| !scene.take.is_observed(t, marker));
        let runs = scene.trusted[marker].chunk_by(|a, b| !is_gap(*a, *b));
        let runs: Vec<&[usize]> = runs.collect();
        for (k, run) in runs.iter().enumerate() {
            // What is too short to have a path has no junk to be told from it.
            let inner = run.len().saturating_sub(3).min(edge);
            let mut flag =
                |junk: Option<Junk>, frames: fn(usize, &[usize]) -> std::ops::Range<usize>| {
                    found.extend(junk.map(|Junk { t, size_m, limit_m }| {
                        let (frames, kind) = (frames(t, run), FaultKind::GapEdge);
                        Fault { marker, frames, kind, size_m, limit_m }
                    }));
                };
            if k > 0 {
                let found =
                    (0..inner).rev().find_map(|at| junk(scene, marker, run[at], |d| &d.after));
                flag(found, |t, run| run[0]..t + 1);
            }
            if k + 1 < runs.len() {
                let found = (run.len() - inner..run.len())
                    .find_map(|at| junk(scene, marker, run[at], |d| &d.before));
                flag(found, |t, run| t..run[run.len() - 1] + 1);
            }
        }
    }
    found
}

struct Junk {
    t: usize,
    size_m: f64,
    limit_m: f64,
}

/// The sample, if the samples on the inner side do not lead to it as they lead to each other.
fn junk(
    scene: &Scene<'_>,
    marker: usize,
    t: usize,
    side: fn(&Deviations) -> &[Option<[f64; 3]>],
) -> Option<Junk> {
    let size_m = scene.size(marker, t, side)?;
    let least = scene.params.step_m;
    if size_m <= least {
        return None;
    }
    let limit_m = scene.limit_around(marker, t, least, side);
    (size_m > limit_m).then_some(Junk { t, size_m, limit_m })
}
