//! Points that stand still while the body moves.

use mocap_core::geometry::distance;

use crate::{Fault, FaultKind, detector::Scene, deviation::reach_frames};

/// A run shorter than this may stand still by chance, in seconds.
const LEAST_S: f64 = 0.5;
/// Frames of a run that are looked at.
const SAMPLED: usize = 200;

/// Runs that stay where they are, while the distance to every marker that moves changes a lot.
///
/// A foot on the floor stands still as well, but its distance to the shank does not change.
pub(crate) fn find(scene: &Scene<'_>) -> Vec<Fault> {
    let reach = reach_frames(scene.take.rate_hz());
    let least = scene.frames(LEAST_S);
    let mut found = Vec::new();
    for marker in 0..scene.take.marker_count() {
        for run in scene.trusted[marker].chunk_by(|a, b| b - a <= reach) {
            if run.len() < least || range_of_motion(scene, marker, run) > scene.params.still_m {
                continue;
            }
            if let Some(change) = least_change(scene, marker, run)
                && change > scene.params.strange_m
            {
                found.push(Fault {
                    marker,
                    frames: run[0]..run[run.len() - 1] + 1,
                    kind: FaultKind::Ghost,
                    size_m: change,
                    limit_m: scene.params.strange_m,
                });
            }
        }
    }
    found
}

fn sampled(run: &[usize]) -> impl Iterator<Item = usize> + '_ {
    run.iter().copied().step_by(run.len().div_ceil(SAMPLED).max(1))
}

/// The largest distance from the run's first sample, in metres. Leaves early, as most runs move.
fn range_of_motion(scene: &Scene<'_>, marker: usize, run: &[usize]) -> f64 {
    let Some(start) = scene.take.position(run[0], marker) else { return f64::INFINITY };
    let mut most = 0.0_f64;
    for p in run.iter().filter_map(|&t| scene.take.position(t, marker)) {
        most = most.max(distance(start, p));
        if most > scene.params.still_m {
            break;
        }
    }
    most
}

/// The smallest change of the distance to any marker that moves during the run; `None` if none does.
fn least_change(scene: &Scene<'_>, marker: usize, run: &[usize]) -> Option<f64> {
    let others = (0..scene.take.marker_count()).filter(|&m| m != marker);
    let changes = others.filter_map(|m| {
        let mut range: Option<(f64, f64, usize)> = None;
        for d in sampled(run).filter_map(|t| scene.take.distance(t, marker, m)) {
            let (low, high, n) = range.unwrap_or((d, d, 0));
            range = Some((low.min(d), high.max(d), n + 1));
        }
        let (low, high, n) = range?;
        // Other points that stand still, or that are seldom seen, say nothing.
        (2 * n >= sampled(run).count() && high - low > scene.params.still_m).then_some(high - low)
    });
    changes.min_by(f64::total_cmp)
}
