//! One frame: a position from interpolated distances.

use mocap_core::geometry::{add, distance, scale, sub};

use crate::{
    EdmSolver,
    procrustes::{Fit, centre, extents, squared},
    scaling::classical_scaling,
    trilateration::trilaterate,
};

/// Neighbours whose second extent is below this share of the first lie on a line, and those whose
/// third is below this share of the second lie in a plane.
const DEGENERATE: f64 = 0.05;

/// A border of the gap: the marker's position there, and its neighbours'.
#[derive(Debug, Clone)]
pub(crate) struct Pose {
    pub marker: [f64; 3],
    pub neighbours: Vec<[f64; 3]>,
}

/// What a frame's position is found from.
pub(crate) struct Setting<'a> {
    /// Borders with their shares, which sum to one.
    pub borders: &'a [(f64, &'a Pose)],
    /// The neighbours in this frame.
    pub neighbours: &'a [[f64; 3]],
    pub weights: &'a [f64],
}

impl Setting<'_> {
    /// The marker's position in this frame. It equals the observed one at a border, whatever the
    /// neighbours are.
    pub fn solve(&self, solver: EdmSolver) -> [f64; 3] {
        let [first, second, third] = extents(self.neighbours);
        if self.neighbours.len() < 3 || second.is_nan() || second <= DEGENERATE * first {
            return self.trilaterate(self.carried());
        }
        let start = self.moved_along();
        let found = match solver {
            EdmSolver::Scaling => self.scale(start),
            EdmSolver::Trilateration => self.trilaterate(start),
        };
        // The height above a plane is what distances determine worst.
        let trust = (third / (DEGENERATE * second)).min(1.0);
        add(scale(trust, found), scale(1.0 - trust, start))
    }

    /// The borders' positions carried rigidly with the neighbours, and interpolated.
    fn moved_along(&self) -> [f64; 3] {
        self.mix(|pose| Fit::of(&pose.neighbours, self.neighbours, self.weights).apply(pose.marker))
    }

    /// The borders' offsets from the centre of the neighbours, interpolated: no turn is made up where
    /// the neighbours do not show one.
    fn carried(&self) -> [f64; 3] {
        let here = centre(self.neighbours, self.weights);
        self.mix(|pose| add(here, sub(pose.marker, centre(&pose.neighbours, self.weights))))
    }

    fn mix(&self, place: impl Fn(&Pose) -> [f64; 3]) -> [f64; 3] {
        self.borders.iter().fold([0.0; 3], |sum, (w, pose)| add(sum, scale(*w, place(pose))))
    }

    fn trilaterate(&self, start: [f64; 3]) -> [f64; 3] {
        let distances: Vec<f64> =
            (0..self.neighbours.len()).map(|j| self.squared_distance(j + 1, 0).sqrt()).collect();
        trilaterate(self.neighbours, &distances, self.weights, start)
    }

    /// Squared distance in m², interpolated linearly between the borders; point 0 is the marker.
    fn squared_distance(&self, i: usize, j: usize) -> f64 {
        let point = |pose: &Pose, i: usize| {
            i.checked_sub(1).map_or(pose.marker, |neighbour| pose.neighbours[neighbour])
        };
        self.borders.iter().map(|(w, pose)| w * squared(point(pose, i), point(pose, j))).sum()
    }

    /// The scaled points laid on the neighbours, in the handedness that comes closer to `start`.
    fn scale(&self, start: [f64; 3]) -> [f64; 3] {
        let n = self.neighbours.len() + 1;
        let matrix: Vec<f64> = (0..n * n).map(|k| self.squared_distance(k / n, k % n)).collect();
        let points = classical_scaling(&matrix, n);
        let laid = [1.0, -1.0].map(|hand| {
            let points: Vec<[f64; 3]> = points.iter().map(|&[x, y, z]| [hand * x, y, z]).collect();
            Fit::of(&points[1..], self.neighbours, self.weights).apply(points[0])
        });
        let [right, left] = laid;
        if distance(left, start) < distance(right, start) { left } else { right }
    }
}
