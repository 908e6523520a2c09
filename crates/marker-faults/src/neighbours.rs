//! The markers around each marker, and the distances they usually keep.

use mocap_core::Take;

/// Neighbours of a marker.
const NEIGHBOURS: usize = 6;
/// Frames that distances are judged by.
const SAMPLED: usize = 200;
/// Frames in which two markers must be seen together.
const LEAST: usize = 20;

/// A marker beside another one, and the usual distance of the two in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Neighbour {
    pub marker: usize,
    pub median_m: f64,
}

/// For each marker the six at the steadiest distances, by the range of the middle half.
///
/// Quantiles, because single wrong samples must not decide; evenly spread frames, so that the cost
/// does not grow with the length of the take.
pub(crate) fn steadiest(take: &Take) -> Vec<Vec<Neighbour>> {
    let markers = take.marker_count();
    let step = take.frames().div_ceil(SAMPLED).max(1);
    let frames: Vec<usize> = (0..take.frames()).step_by(step).collect();
    let mut ranked: Vec<Vec<(f64, Neighbour)>> = vec![Vec::new(); markers];
    let mut distances = Vec::with_capacity(frames.len());
    for a in 0..markers {
        for b in a + 1..markers {
            distances.clear();
            distances.extend(frames.iter().filter_map(|&t| take.distance(t, a, b)));
            if distances.len() < LEAST.min(frames.len()).max(3) {
                continue;
            }
            let last = distances.len() - 1;
            let (low, &mut median_m, high) =
                distances.select_nth_unstable_by(last / 2, f64::total_cmp);
            let first_quarter = *low.select_nth_unstable_by(last / 4, f64::total_cmp).1;
            let third_quarter = *high.select_nth_unstable_by(last / 4, f64::total_cmp).1;
            let spread = third_quarter - first_quarter;
            let between = |marker| Neighbour { marker, median_m };
            ranked[a].push((spread, between(b)));
            ranked[b].push((spread, between(a)));
        }
    }
    let by_spread = |x: &(f64, Neighbour), y: &(f64, Neighbour)| {
        x.0.total_cmp(&y.0)
            .then(x.1.median_m.total_cmp(&y.1.median_m))
            .then(x.1.marker.cmp(&y.1.marker))
    };
    let keep = |mut all: Vec<(f64, Neighbour)>| {
        all.sort_by(by_spread);
        all.into_iter().take(NEIGHBOURS).map(|(_, neighbour)| neighbour).collect()
    };
    ranked.into_iter().map(keep).collect()
}
