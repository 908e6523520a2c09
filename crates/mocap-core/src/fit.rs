//! The best rotation between two sets of points.

use crate::Rotation;

/// The rotation `R` that makes `Σ q · R p` largest, given the sums of products `sums[a][b] = Σ p[a] q[b]`
/// of points about their centres.
///
/// The answer is a proper rotation also where the points lie in a plane. Where they lie on a line, or
/// the sums are zero, it is one of many.
///
/// Implements [Horn87] Sec. 4: the dominant eigenvector of the matrix of sums of products.
#[must_use]
pub fn best_rotation(sums: &[[f64; 3]; 3]) -> Rotation {
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
