//! Frames that move with a few markers.

use mocap_core::{
    Rotation,
    geometry::{add, best_rotation, dot, scale, sub, symmetric_eigen},
};

/// Singular values of a pose below this share of the largest leave the turn about a line undefined.
const LINEAR: f64 = 0.05;

/// Local coordinates in one frame of a take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LocalFrame {
    /// Rows are the local axes in world coordinates.
    axes: [[f64; 3]; 3],
    centre: [f64; 3],
}

impl LocalFrame {
    pub fn to_local(self, p: [f64; 3]) -> [f64; 3] {
        self.turn_in(sub(p, self.centre))
    }

    pub fn to_world(self, q: [f64; 3]) -> [f64; 3] {
        add(self.turn_out(q), self.centre)
    }

    /// Turns a difference of positions into local coordinates.
    pub fn turn_in(self, v: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, v))
    }

    /// Turns a local difference into world coordinates.
    pub fn turn_out(self, v: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| {
            v[0] * self.axes[0][a] + v[1] * self.axes[1][a] + v[2] * self.axes[2][a]
        })
    }
}

/// The pose of the core markers that local frames refer to.
#[derive(Debug, Clone)]
pub(crate) struct Reference {
    /// Around its centre, times its weight; `None` where the markers lie on a line, so that only their
    /// centre counts.
    shape: Option<Vec<[f64; 3]>>,
    /// Weights of the markers, of sum 1.
    weights: Vec<f64>,
}

impl Reference {
    pub fn new(pose: &[[f64; 3]]) -> Self {
        Self::weighted(pose, &vec![1.0; pose.len()])
    }

    /// A reference in which markers count by their positive weights.
    pub fn weighted(pose: &[[f64; 3]], weights: &[f64]) -> Self {
        let sum: f64 = weights.iter().sum();
        let weights: Vec<f64> = weights.iter().map(|w| w / sum).collect();
        let centre = weighted_centre(pose, &weights);
        let weigh = |(&p, &w): (&[f64; 3], &f64)| scale(w, sub(p, centre));
        let shape = (!is_linear(pose)).then(|| pose.iter().zip(&weights).map(weigh).collect());
        Self { shape, weights }
    }

    /// The frame of the same markers in another pose: the proper rotation and translation that take
    /// the pose to the reference with the least weighted sum of squares.
    ///
    /// Found as a quaternion, it is never a reflection, as the solution of [Kabsch76] can be.
    pub fn frame(&self, pose: &[[f64; 3]]) -> LocalFrame {
        let centre = weighted_centre(pose, &self.weights);
        let rotation = self.shape.as_ref().map_or(Rotation::IDENTITY, |shape| {
            let mut covariance = [[0.0; 3]; 3];
            for (&p, q) in pose.iter().zip(shape) {
                let p = sub(p, centre);
                for (row, x) in covariance.iter_mut().zip(p) {
                    for (entry, y) in row.iter_mut().zip(q) {
                        *entry += x * y;
                    }
                }
            }
            best_rotation(&covariance)
        });
        LocalFrame { axes: rotation.matrix(), centre }
    }
}

/// Whether the points lie close to one line or one point.
pub(crate) fn is_linear(points: &[[f64; 3]]) -> bool {
    let centre = centroid(points);
    let mut scatter = [[0.0; 3]; 3];
    for &p in points {
        let p = sub(p, centre);
        for (row, x) in scatter.iter_mut().zip(p) {
            for (entry, y) in row.iter_mut().zip(p) {
                *entry += x * y;
            }
        }
    }
    let (mut values, _) = symmetric_eigen(scatter);
    values.sort_by(f64::total_cmp);
    // Squares of singular values; a NaN counts as a line.
    !(values[1] >= LINEAR * LINEAR * values[2] && values[1] > f64::MIN_POSITIVE)
}

fn weighted_centre(points: &[[f64; 3]], weights: &[f64]) -> [f64; 3] {
    points.iter().zip(weights).fold([0.0; 3], |sum, (&p, &w)| add(sum, scale(w, p)))
}

fn centroid(points: &[[f64; 3]]) -> [f64; 3] {
    let sum = points.iter().fold([0.0; 3], |sum, &p| add(sum, p));
    scale(1.0 / points.len().max(1) as f64, sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::geometry::distance;

    #[test]
    fn a_rigid_motion_leaves_local_coordinates() {
        let pose = [[0.1, 0.0, 0.2], [0.3, -0.2, 0.0], [0.0, 0.4, 0.1], [-0.1, 0.1, -0.3]];
        let reference = Reference::new(&pose);
        let q = [0.5, 0.6, -0.7];
        let still = reference.frame(&pose).to_local(q);
        for angle in [0.3, 1.5, 3.1, -2.0] {
            let rotation = Rotation::about([0.3, -1.0, 0.5], angle);
            let moved = |p| add(rotation.apply(p), [3.0, -2.0, 1.0]);
            let frame = reference.frame(&pose.map(moved));
            // Coordinates of a few metres lose about 1e-15 each.
            assert!(distance(frame.to_local(moved(q)), still) < 1e-13, "angle {angle}");
            assert!(distance(frame.to_world(still), moved(q)) < 1e-13, "angle {angle}");
        }
    }

    #[test]
    fn lines_and_points_are_linear() {
        let line = [0.0, 0.1, 0.25, 0.5].map(|s| [s, -2.0 * s, 0.01 * s]);
        assert!(is_linear(&line));
        assert!(is_linear(&[[1.0; 3]; 3]));
        assert!(is_linear(&[[f64::NAN; 3]; 3]));
        assert!(!is_linear(&[[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]]));
    }
}
