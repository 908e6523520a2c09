//! Which markers to measure distances to.

use mocap_core::Take;

use crate::EdmParams;

/// Distances that vary by less than 0.1 µm are constant up to rounding.
const CONSTANT_M2: f64 = 1e-14;

/// Neighbours kept whatever their spread.
const LEAST: usize = 3;

/// A marker that is seen together with the missing one often enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Neighbour {
    pub marker: usize,
    /// Variance of its distance to the missing marker in m².
    pub variance: f64,
}

/// The neighbours of `target`, those with the steadiest distance first; of equally steady ones, the
/// nearest first. Only frames that show both markers count.
///
/// Implements the choice of neighbours of [Pan23] §3.1.
pub(crate) fn rank(take: &Take, target: usize, min_shared: usize) -> Vec<Neighbour> {
    let mut found: Vec<(Neighbour, f64)> = (0..take.marker_count())
        .filter(|&m| m != target)
        .filter_map(|marker| {
            let (variance, mean) = distance_moments(take, target, marker, min_shared)?;
            Some((Neighbour { marker, variance: variance.max(CONSTANT_M2) }, mean))
        })
        .collect();
    found.sort_by(|(a, near), (b, far)| {
        let steady = a.variance.total_cmp(&b.variance);
        steady.then(near.total_cmp(far)).then(a.marker.cmp(&b.marker))
    });
    found.into_iter().map(|(neighbour, _)| neighbour).collect()
}

/// Variance and mean of the distance over the frames that show both markers.
fn distance_moments(take: &Take, a: usize, b: usize, least: usize) -> Option<(f64, f64)> {
    let mut first = None;
    let (mut n, mut sum, mut squares) = (0_usize, 0.0, 0.0);
    for d in (0..take.frames()).filter_map(|t| take.distance(t, a, b)) {
        // Around the first distance, so that no digits are lost where they hardly vary.
        let x = d - *first.get_or_insert(d);
        n += 1;
        sum += x;
        squares += x * x;
    }
    let mean = sum / n as f64;
    (n >= least.max(1)).then(|| (squares / n as f64 - mean * mean, first.unwrap_or(0.0) + mean))
}

/// The neighbours to use of those in order of rank that pass `seen`: at most K, and beyond the third
/// none that spreads too far.
pub(crate) fn choose(
    ranking: &[Neighbour],
    params: &EdmParams,
    seen: impl Fn(usize) -> bool,
) -> Vec<Neighbour> {
    let limit = params.max_spread_m * params.max_spread_m;
    ranking
        .iter()
        .filter(|n| seen(n.marker))
        .take(params.neighbours)
        .enumerate()
        .take_while(|(rank, n)| *rank < LEAST || n.variance <= limit)
        .map(|(_, n)| *n)
        .collect()
}
