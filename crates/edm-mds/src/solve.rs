//! A position from interpolated distances.

use mocap_core::geometry::{add, best_rotation, distance, scale, sub};

use crate::{
    EdmSolver,
    moments::{centre, extents, products},
    params::MAX_NEIGHBOURS,
    scaling::Between,
    trilateration::trilaterate,
};

/// Neighbours whose second extent is below this share of the first lie on a line, and those whose
/// third is below this share of the second lie in a plane.
const DEGENERATE: f64 = 0.05;

/// Two borders of a gap as its frames need them; a gap that has one border has it twice.
pub(crate) struct Borders {
    poses: [Pose; 2],
    between: Between,
    weights: Vec<f64>,
}

/// A border: the marker and its neighbours there.
struct Pose {
    /// The marker about the weighted mean of its neighbours.
    marker: [f64; 3],
    /// The neighbours about it, times their weights.
    neighbours: Vec<[f64; 3]>,
    /// From the marker to its neighbours, in m².
    squared_distances: Vec<f64>,
}

impl Pose {
    fn new(points: &[[f64; 3]], weights: &[f64]) -> Self {
        let (marker, neighbours) = (points[0], &points[1..]);
        let centre = centre(neighbours, weights);
        let weigh = |(&p, &w): (&[f64; 3], &f64)| scale(w, sub(p, centre));
        Self {
            marker: sub(marker, centre),
            neighbours: neighbours.iter().zip(weights).map(weigh).collect(),
            squared_distances: neighbours.iter().map(|&p| distance(p, marker).powi(2)).collect(),
        }
    }
}

impl Borders {
    /// From the points at each border, the marker first and then its neighbours, at most
    /// [`MAX_NEIGHBOURS`], with their weights.
    pub fn new(points: [&[[f64; 3]]; 2], weights: Vec<f64>) -> Self {
        let poses = points.map(|points| Pose::new(points, &weights));
        Self { poses, between: Between::new(points[0], points[1]), weights }
    }

    /// The marker's position at a share of the way between the borders, where its neighbours are `here`. It
    /// equals the observed one at a border, whatever the neighbours are.
    pub fn solve(&self, share: f64, here: &[[f64; 3]], solver: EdmSolver) -> [f64; 3] {
        let middle = centre(here, &self.weights);
        let [first, second, third] = extents(here);
        if here.len() < 3 || second.is_nan() || second <= DEGENERATE * first {
            // Offsets from the middle, interpolated: no turn is made up where the neighbours do not show one.
            let [before, after] = [&self.poses[0], &self.poses[1]].map(|pose| pose.marker);
            return self.trilaterate(share, here, add(middle, mix(share, before, after)));
        }
        // The sums of products in [Horn87] of the neighbours at the borders and here.
        let mut offsets = [[0.0; 3]; MAX_NEIGHBOURS];
        for (offset, &p) in offsets.iter_mut().zip(here) {
            *offset = sub(p, middle);
        }
        let sums = [0, 1].map(|side| products(&self.poses[side].neighbours, &offsets));
        // The borders' positions carried rigidly with the neighbours, and interpolated.
        let [before, after] =
            [0, 1].map(|side| best_rotation(&sums[side]).apply(self.poses[side].marker));
        let start = mix(share, before, after);
        // The height above a plane is what distances determine worst.
        let trust = (third / (DEGENERATE * second)).min(1.0);
        let found = match solver {
            EdmSolver::Scaling => self.scale(share, &sums, start),
            EdmSolver::Trilateration => {
                sub(self.trilaterate(share, here, add(middle, start)), middle)
            }
        };
        add(middle, mix(trust, start, found))
    }

    /// The scaled points laid on the neighbours, in the handedness that comes closer to `start`; relative to
    /// the middle of the neighbours.
    fn scale(&self, share: f64, sums: &[[[f64; 3]; 3]; 2], start: [f64; 3]) -> [f64; 3] {
        let scaled = self.between.at(share);
        let sums = scaled.products(&sums[0], &sums[1]);
        let point = scaled.point(self.poses[0].marker, self.poses[1].marker);
        let laid = [1.0, -1.0].map(|hand| {
            let turn = best_rotation(&[scale(hand, sums[0]), sums[1], sums[2]]);
            turn.apply([hand * point[0], point[1], point[2]])
        });
        let [right, left] = laid;
        if distance(left, start) < distance(right, start) { left } else { right }
    }

    /// With squared distances in linear interpolation.
    fn trilaterate(&self, share: f64, here: &[[f64; 3]], start: [f64; 3]) -> [f64; 3] {
        let [before, after] = [&self.poses[0], &self.poses[1]].map(|pose| &pose.squared_distances);
        let mut distances = [0.0; MAX_NEIGHBOURS];
        for ((d, a), b) in distances.iter_mut().zip(before).zip(after) {
            *d = ((1.0 - share) * a + share * b).sqrt();
        }
        trilaterate(here, &distances[..here.len()], &self.weights, start)
    }
}

/// The point at a share of the way from `p` to `q`.
fn mix(share: f64, p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    add(scale(1.0 - share, p), scale(share, q))
}
