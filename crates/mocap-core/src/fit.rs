//! The best rotation between two sets of points.

use crate::{
    Rotation,
    geometry::{cofactors, dot, product, scale, times, transposed},
};

/// (s₁ + s₂)(s₂ ± s₃)(s₁ ± s₃) of the singular values, below which the closed form loses digits: points so close
/// to a line that their second extent is a hundredth of the first.
const WELL_DETERMINED: f64 = 1e-4;

/// Newton's steps at most; from the bound that they start at, five suffice.
const STEPS: usize = 12;

/// The rotation `R` that makes `Σ q · R p` largest, given the sums of products `sums[a][b] = Σ p[a] q[b]`
/// of points about their centres.
///
/// The answer is a proper rotation also where the points lie in a plane. Where they lie on a line, or
/// the sums are zero, it is one of many.
///
/// Implements [Markley93] Eqs. (14) and (23), and where points lie close to a line, or match equally well by
/// many rotations, [Horn87] Sec. 4: the dominant eigenvector of the matrix of sums of products.
///
/// # Cost
/// About 300 operations; near a line ten times as many.
#[must_use]
pub fn best_rotation(sums: &[[f64; 3]; 3]) -> Rotation {
    closed_form(sums).unwrap_or_else(|| by_quaternion(sums))
}

/// `None` where that would lose digits.
fn closed_form(sums: &[[f64; 3]; 3]) -> Option<Rotation> {
    let square = sums.iter().map(|row| dot(*row, *row)).sum::<f64>();
    // Squares this small have lost digits already.
    if !(square.is_finite() && square > 1e-200) {
        return None;
    }
    let size = square.sqrt();
    // With Frobenius norm 1, so that singular values s₁, s₂, s₃ are at most 1.
    let profile = transposed(sums).map(|row| scale(1.0 / size, row));
    let minors = cofactors(&profile);
    let determinant = dot(profile[0], minors[0]);
    let pairs = minors.iter().map(|row| dot(*row, *row)).sum::<f64>();
    // The largest root is s₁ + s₂ ± s₃. Its square is 1 + 2 (s₁s₂ ± s₂s₃ ± s₁s₃), and these products have the
    // sum of squares `pairs`: Newton's steps from this bound descend on the root.
    let mut root = (1.0 + 12.0_f64.sqrt() * pairs.sqrt()).sqrt();
    // (s₁ + s₂)(s₂ ± s₃)(s₁ ± s₃), an eighth of the slope.
    let eighth = |root: f64| 0.5 * root * (root * root - 1.0) - determinant;
    let mut steps = 0..STEPS;
    loop {
        let slope = eighth(root);
        if slope.is_nan() || slope < WELL_DETERMINED {
            return None;
        }
        let excess = root * root - 1.0;
        let step = (excess * excess - 8.0 * root * determinant - 4.0 * pairs) / (8.0 * slope);
        root -= step;
        // What is left goes with the square of this step.
        if step.abs() < 1e-9 {
            break;
        }
        steps.next()?;
    }
    let steep = eighth(root);
    let spread = 0.5 * (root * root + 1.0);
    let cube = product(&product(&profile, &transposed(&profile)), &profile);
    let matrix = std::array::from_fn(|i| {
        std::array::from_fn(|j| (spread * profile[i][j] + root * minors[i][j] - cube[i][j]) / steep)
    });
    Some(polished(Rotation::of_orthonormal(&matrix), sums))
}

/// One Newton step of the sum of products in the rotation vector: squares an error of 1e-8.
fn polished(rotation: Rotation, sums: &[[f64; 3]; 3]) -> Rotation {
    let turned = product(&rotation.matrix(), sums);
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = turned;
    let gradient = [yz - zy, zx - xz, xy - yx];
    let (a, b, c) = (-0.5 * (xy + yx), -0.5 * (xz + zx), -0.5 * (yz + zy));
    let curvature = [[yy + zz, a, b], [a, xx + zz, c], [b, c, xx + yy]];
    let minors = cofactors(&curvature);
    let half = scale(0.5 / dot(curvature[0], minors[0]), times(&minors, gradient));
    let turn = Rotation::from_quaternion(1.0, half);
    turn.map_or(rotation, |turn| turn.after(rotation).normalized())
}

fn by_quaternion(sums: &[[f64; 3]; 3]) -> Rotation {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *sums;
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

/// Eigenvalues, and eigenvectors as columns, of a small symmetric matrix, by cyclic Jacobi rotations.
/// The order is arbitrary but fixed. Rows and columns of zeros cost nothing.
///
/// # Cost
/// About `N³` operations a sweep, and five to eight sweeps: meant for N up to ten.
#[must_use]
pub fn symmetric_eigen<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    const SWEEPS: usize = 30;
    let mut vectors = [[0.0; N]; N];
    for (k, row) in vectors.iter_mut().enumerate() {
        row[k] = 1.0;
    }
    let total: f64 = a.iter().flatten().map(|x| x * x).sum();
    for _ in 0..SWEEPS {
        let off: f64 = a.iter().enumerate().flat_map(|(p, row)| &row[..p]).map(|x| x * x).sum();
        // Entries this small move no eigenvector by more than a rounding.
        if off <= total * 1e-32 || !off.is_finite() {
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
    let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
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

    use crate::geometry::distance;

    /// Sums of products of points with the same points turned.
    fn sums_of(points: &[[f64; 3]], turned: impl Fn([f64; 3]) -> [f64; 3]) -> [[f64; 3]; 3] {
        let mut sums = [[0.0; 3]; 3];
        for &p in points {
            let q = turned(p);
            for (row, x) in sums.iter_mut().zip(p) {
                for (entry, y) in row.iter_mut().zip(q) {
                    *entry += x * y;
                }
            }
        }
        sums
    }

    fn turns() -> impl Iterator<Item = Rotation> {
        let axes = [[1.0, 0.0, 0.0], [0.3, -1.0, 0.5], [-0.2, 0.1, 2.0], [1.0, 1.0, -1.0]];
        axes.into_iter().flat_map(|axis| {
            [0.0, 1e-9, 0.3, 1.5, std::f64::consts::PI, -2.0]
                .map(|angle| Rotation::about(axis, angle))
        })
    }

    /// Points in space and in a plane, from a millimetre to a kilometre, with the same points turned.
    #[test]
    fn a_rotation_is_found_again() {
        let solid = [[0.4, 0.1, 0.2], [-0.3, 0.2, 0.1], [0.1, -0.5, 0.2], [-0.2, 0.2, -0.5]];
        for (flatness, size) in [(1.0, 1.0), (0.0, 1.0), (1e-3, 1e-3), (0.2, 1e3)] {
            let body = solid.map(|[x, y, z]| [size * x, size * y, size * flatness * z]);
            for turn in turns() {
                let sums = sums_of(&body, |p| turn.apply(p));
                let found = closed_form(&sums).unwrap();
                let q = [0.5, -0.7, 0.6];
                assert!(distance(found.apply(q), turn.apply(q)) < 3e-15, "{turn:?} {flatness}");
            }
        }
    }

    /// The closed form and the eigenvector agree wherever the former answers, to the digits that the points leave:
    /// contradictory points, nearly a line, and reflections of bodies that are not too round.
    #[test]
    fn both_ways_agree() {
        let mut answered = 0;
        for line in [1.0, 0.3, 0.1, 0.05, 0.02] {
            for flat in [1.0, 0.5, 0.1, 0.0, -0.1, -0.5, -0.9] {
                for turn in turns() {
                    let stretched =
                        [[1.0, 0.0, 0.0], [0.2, line, 0.0], [0.1, 0.3 * line, line * flat]];
                    let sums = stretched.map(|row| turn.apply(row));
                    let Some(found) = closed_form(&sums) else { continue };
                    answered += 1;
                    let reference = by_quaternion(&sums);
                    for q in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
                        let error = distance(found.apply(q), reference.apply(q));
                        assert!(error < 1e-11, "{line} {flat} {error:e}");
                    }
                }
            }
        }
        assert!(answered > 500, "{answered}");
    }

    /// What no rotation matches best is left to the eigenvector, which answers with a proper rotation.
    #[test]
    fn lines_points_and_round_reflections_have_some_rotation() {
        let line = [[0.3, 0.6, -0.2], [-0.6, -1.2, 0.4], [0.3, 0.6, -0.2]];
        for turn in turns() {
            let sums = sums_of(&line, |p| turn.apply(p));
            assert!(closed_form(&sums).is_none());
            let found = best_rotation(&sums);
            // The turn about the line is free, not the line.
            assert!(line.iter().all(|&p| distance(found.apply(p), turn.apply(p)) < 1e-12));
        }
        let inversion = [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
        for sums in [[[0.0; 3]; 3], inversion, inversion.map(|row| scale(1e-120, row))] {
            assert!(closed_form(&sums).is_none());
            let (w, v) = best_rotation(&sums).quaternion();
            assert!((w * w + dot(v, v) - 1.0).abs() < 1e-15);
        }
        assert!(closed_form(&[[f64::NAN; 3]; 3]).is_none());
    }

    /// A mirrored body gets the proper rotation that turns its flattest direction the wrong way.
    #[test]
    fn a_mirrored_body_is_not_mirrored_back() {
        let body = [[0.4, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.1]];
        for turn in turns() {
            let sums = sums_of(&body, |p| turn.apply([p[0], p[1], -p[2]]));
            let found = best_rotation(&sums);
            let worst = body.iter().map(|&p| distance(found.apply(p), turn.apply(p)));
            assert!(worst.fold(0.0, f64::max) < 1e-13);
        }
    }

    #[test]
    fn eigenvectors_rebuild_the_matrix() {
        for n in 1..=8 {
            let entry = |i: usize, j: usize| ((i * j + i + j) % 7) as f64 - 3.0;
            let a: [[f64; 8]; 8] = std::array::from_fn(|i| {
                std::array::from_fn(|j| if i < n && j < n { entry(i, j) } else { 0.0 })
            });
            let (values, v) = symmetric_eigen(a);
            for i in 0..8 {
                for j in 0..8 {
                    let rebuilt: f64 = (0..8).map(|k| v[i][k] * values[k] * v[j][k]).sum();
                    // Entries up to 3 after a few hundred rotations.
                    assert!((rebuilt - a[i][j]).abs() < 1e-13, "{n} {i} {j}");
                }
            }
        }
    }
}
