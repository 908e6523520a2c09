//! Samples off their own path.

use crate::{
    Fault, FaultKind,
    detector::Scene,
    deviation::{Deviations, from_either_side, part_local},
};
use mocap_core::geometry::norm;

/// Rounds at most: each takes the worst sample of every cluster away.
const ROUNDS: usize = 200;
/// Samples this many frames away share an error, so only the worst of them is believed at once.
const CLUSTER: usize = 3;

/// Samples that deviate from the cubic through their neighbours in time, and from the continuation of either side.
///
/// The last condition spares the samples beside a step, which the cubic misses as well.
pub(crate) fn find(scene: &Scene<'_>) -> Vec<Fault> {
    let mut found = Vec::new();
    for marker in 0..scene.take.marker_count() {
        let mut trusted = scene.trusted[marker].clone();
        let mut spikes: Vec<(usize, f64)> = Vec::new();
        for round in 0..ROUNDS {
            let worst = if round == 0 {
                worst_of_clusters(scene, marker, &scene.deviations[marker])
            } else {
                let own = scene.deviations_without(marker, &trusted);
                worst_of_clusters(scene, marker, &own)
            };
            if worst.is_empty() {
                break;
            }
            trusted.retain(|t| worst.binary_search_by_key(t, |(t, _)| *t).is_err());
            spikes.extend(worst);
        }
        spikes.sort_by_key(|(t, _)| *t);
        spikes.retain(|&(t, _)| !acquitted(scene, marker, t, &mut trusted));
        found.extend(merge(scene, marker, &spikes));
    }
    found
}

/// Takes a sample back that lies where the trusted samples around it lead: between two spikes a good sample looks worst
/// of the three.
fn acquitted(scene: &Scene<'_>, marker: usize, t: usize, trusted: &mut Vec<usize>) -> bool {
    let allowance = scene.params.allowance(scene.take.rate_hz());
    let own = from_either_side(scene.take, marker, t, trusted, allowance);
    let is_good = own.is_some_and(|own| {
        let theirs = |m: usize| scene.deviations[m].within[t];
        let size = norm(part_local(own, &scene.neighbours[marker], theirs));
        size <= scene.limit_m(scene.params.size_m)
    });
    if is_good {
        trusted.insert(trusted.partition_point(|&s| s < t), t);
    }
    is_good
}

fn worst_of_clusters(scene: &Scene<'_>, marker: usize, own: &Deviations) -> Vec<(usize, f64)> {
    let limit = scene.limit_m(scene.params.size_m);
    let step = scene.limit_m(scene.params.step_m);
    let local = |t: usize, which: fn(&Deviations) -> &[Option<[f64; 3]>]| {
        let theirs = |m: usize| which(&scene.deviations[m])[t];
        which(own)[t].map(|d| norm(part_local(d, &scene.neighbours[marker], theirs)))
    };
    let excess: Vec<f64> = (0..scene.take.frames())
        .map(|t| {
            let size = own.within[t].map(norm).filter(|size| *size > limit);
            let size = size.and_then(|_| local(t, |d| &d.within)).filter(|size| {
                *size > limit && *size > scene.limit_around(marker, t, limit, |d| &d.within)
            });
            // Beside a gap there is junk, which is looked for later; beside an end of the take one side has to do.
            let at_end = t < 3 || t + 3 >= scene.take.frames();
            let aside = |side: Option<f64>| side.map_or(at_end, |d| d > step);
            let off_both = || aside(local(t, |d| &d.before)) && aside(local(t, |d| &d.after));
            size.filter(|_| off_both()).unwrap_or(0.0)
        })
        .collect();
    let is_worst = |t: &usize| {
        let around = t.saturating_sub(CLUSTER)..(t + CLUSTER + 1).min(excess.len());
        // Of two equal ones the first.
        excess[*t] > 0.0
            && around
                .clone()
                .all(|s| excess[s] < excess[*t] || (excess[s] <= excess[*t] && s >= *t))
    };
    (0..excess.len()).filter(is_worst).map(|t| (t, excess[t])).collect()
}

/// Spikes in a row as one fault.
fn merge(scene: &Scene<'_>, marker: usize, spikes: &[(usize, f64)]) -> Vec<Fault> {
    let runs = spikes.chunk_by(|a, b| a.0 + 1 == b.0);
    let fault = |run: &[(usize, f64)]| Fault {
        marker,
        frames: run[0].0..run[run.len() - 1].0 + 1,
        kind: FaultKind::Spike,
        size_m: run.iter().map(|(_, size)| *size).fold(0.0, f64::max),
        limit_m: scene.limit_m(scene.params.size_m),
    };
    runs.map(fault).collect()
}
