//! Which markers to measure distances to.

use mocap_core::{Take, geometry::distance};
use ndarray::Axis;

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
    let moments = distance_moments(take, target);
    let mut found: Vec<(Neighbour, f64)> = (0..)
        .zip(&moments)
        .filter(|&(m, moments)| m != target && moments.frames >= min_shared.max(1))
        .map(|(marker, moments)| {
            let variance = moments.variance().max(CONSTANT_M2);
            (Neighbour { marker, variance }, moments.mean())
        })
        .collect();
    found.sort_by(|(a, near), (b, far)| {
        let steady = a.variance.total_cmp(&b.variance);
        steady.then(near.total_cmp(far)).then(a.marker.cmp(&b.marker))
    });
    found.into_iter().map(|(neighbour, _)| neighbour).collect()
}

/// Sums over the frames that show two markers, of their distance less that in the first such frame, so
/// that no digits are lost where it hardly varies.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    first: f64,
    frames: usize,
    sum: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, distance: f64) {
        if self.frames == 0 {
            self.first = distance;
        }
        let x = distance - self.first;
        self.frames += 1;
        self.sum += x;
        self.squares += x * x;
    }

    fn mean(&self) -> f64 {
        self.first + self.sum / self.frames as f64
    }

    fn variance(&self) -> f64 {
        let mean = self.sum / self.frames as f64;
        self.squares / self.frames as f64 - mean * mean
    }
}

/// Of the distances of each marker to `target`; frame by frame, as positions lie in memory.
fn distance_moments(take: &Take, target: usize) -> Vec<Moments> {
    let mut moments = vec![Moments::default(); take.marker_count()];
    let positions = take.positions();
    for (t, &seen) in take.observed().marker(target).iter().enumerate() {
        if !seen {
            continue;
        }
        let frame = positions.index_axis_move(Axis(0), t);
        let (points, _) = frame.to_slice().unwrap_or_default().as_chunks::<3>();
        for (moments, &point) in moments.iter_mut().zip(points) {
            let distance = distance(point, points[target]);
            // Missing markers have NaN for a position.
            if !distance.is_nan() {
                moments.add(distance);
            }
        }
    }
    moments
}

/// The neighbours to use of those in order of rank that pass `seen`: at most K, and beyond the third
/// none that spreads too far.
pub(crate) fn choose<'a>(
    ranking: &'a [Neighbour],
    params: &'a EdmParams,
    seen: impl Fn(usize) -> bool + 'a,
) -> impl Iterator<Item = Neighbour> + 'a {
    let limit = params.max_spread_m * params.max_spread_m;
    ranking
        .iter()
        .filter(move |n| seen(n.marker))
        .take(params.neighbours)
        .enumerate()
        .take_while(move |(rank, n)| *rank < LEAST || n.variance <= limit)
        .map(|(_, n)| *n)
}
