//! Frames that move with a few markers.

use mocap_core::{
    Rotation,
    geometry::{add, dot, scale, sub},
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
    /// Around its centre; `None` where the markers lie on a line, so that only their centre counts.
    shape: Option<Vec<[f64; 3]>>,
}

impl Reference {
    pub fn new(pose: &[[f64; 3]]) -> Self {
        let centre = centroid(pose);
        let shape = (!is_linear(pose)).then(|| pose.iter().map(|&p| sub(p, centre)).collect());
        Self { shape }
    }

    /// The frame of the same markers in another pose: the proper rotation and translation that take
    /// the pose to the reference with the least sum of squares.
    ///
    /// Found as a quaternion, it is never a reflection, as the solution of [Kabsch76] can be.
    pub fn frame(&self, pose: &[[f64; 3]]) -> LocalFrame {
        let centre = centroid(pose);
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

fn centroid(points: &[[f64; 3]]) -> [f64; 3] {
    let sum = points.iter().fold([0.0; 3], |sum, &p| add(sum, p));
    scale(1.0 / points.len().max(1) as f64, sum)
}

/// The rotation `R` that makes Σ q · R p largest, given the sums of `p[a] · q[b]`: the dominant
/// eigenvector of the matrix of sums of products in [Horn87].
fn best_rotation(covariance: &[[f64; 3]; 3]) -> Rotation {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *covariance;
    let matrix = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ];
    let (values, vectors) = symmetric_eigen(matrix);
    let top = (1..4).fold(0, |best, k| if values[k] > values[best] { k } else { best });
    let q = vectors.map(|row| row[top]);
    Rotation::from_quaternion(q[0], [q[1], q[2], q[3]]).unwrap_or(Rotation::IDENTITY)
}

/// Eigenvalues and eigenvectors (as columns) of a small symmetric matrix, by cyclic Jacobi rotations.
fn symmetric_eigen<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    const SWEEPS: usize = 30;
    let mut vectors = [[0.0; N]; N];
    for (k, row) in vectors.iter_mut().enumerate() {
        row[k] = 1.0;
    }
    let total: f64 = a.iter().flatten().map(|x| x * x).sum();
    for _ in 0..SWEEPS {
        let off: f64 =
            (0..N).flat_map(|p| (0..p).map(move |q| (p, q))).map(|(p, q)| a[p][q].powi(2)).sum();
        // Entries this small move no eigenvector by a rounding.
        if off <= total * 1e-34 || !off.is_finite() {
            break;
        }
        for p in 0..N {
            for q in p + 1..N {
                annihilate(&mut a, &mut vectors, p, q);
            }
        }
    }
    (std::array::from_fn(|k| a[k][k]), vectors)
}

/// One Jacobi rotation that makes `a[p][q]` zero.
fn annihilate<const N: usize>(
    a: &mut [[f64; N]; N],
    vectors: &mut [[f64; N]; N],
    p: usize,
    q: usize,
) {
    if a[p][q].abs() <= f64::MIN_POSITIVE {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let tangent = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    for row in a.iter_mut().chain(vectors.iter_mut()) {
        let (x, y) = (row[p], row[q]);
        row[p] = cosine * x - sine * y;
        row[q] = sine * x + cosine * y;
    }
    let (x, y) = (a[p], a[q]);
    for k in 0..N {
        a[p][k] = cosine * x[k] - sine * y[k];
        a[q][k] = sine * x[k] + cosine * y[k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::geometry::distance;

    #[test]
    fn eigenvectors_rebuild_the_matrix() {
        let a = [[2.0, -1.0, 0.3], [-1.0, 0.5, 0.2], [0.3, 0.2, -1.0]];
        let (values, v) = symmetric_eigen(a);
        for i in 0..3 {
            for j in 0..3 {
                let rebuilt: f64 = (0..3).map(|k| v[i][k] * values[k] * v[j][k]).sum();
                // Entries of order one after about twenty rotations.
                assert!((rebuilt - a[i][j]).abs() < 1e-14);
            }
        }
    }

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
