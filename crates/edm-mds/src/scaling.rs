//! Points from their distances.

use mocap_core::geometry::{
    add, best_rotation, cofactors, dot, product, scale, sub, symmetric_eigen, times, transposed,
};

use crate::moments::{centroid, products};

type Matrix = [[f64; 3]; 3];

/// Eigenvalues kept are at least so many times those dropped where iteration finds them: each step gains that.
const SEPARATION: f64 = 2.0;

/// Steps that reach rounding at that factor.
const STEPS: usize = 52;

/// Classical scaling of squared distances that are interpolated linearly between those of two poses of the
/// same points.
///
/// Let the rows of `X` be the points of the first pose about their centre, those of `X + E` the points of the
/// second about theirs, turned so as to come close. At a share `w` of the way the doubly centred matrix of
/// [Pan23] Eq. (2), of as many rows as points, is
///
/// `B = (1 − w) X Xᵀ + w (X + E)(X + E)ᵀ = A Aᵀ + D Dᵀ` with `A = X + w E` and `D = √(w (1 − w)) E`.
///
/// Interpolated distances thus are those of points in six dimensions, never those of none, and the
/// eigenvectors of `B` with the three largest eigenvalues follow from those of `[A D]ᵀ [A D]`, six by six
/// whatever the number of points. Its blocks are combinations of `XᵀX`, `XᵀE` and `EᵀE`, which are constant
/// over the gap, and the last is small where the poses differ little: a frame has to find the leading subspace
/// beside the first three axes.
#[derive(Debug, Clone)]
pub(crate) struct Between {
    /// The rotation that lays the second pose on the first.
    turn: Matrix,
    shape: Matrix,
    across: Matrix,
    change: Matrix,
}

impl Between {
    pub fn new(first: &[[f64; 3]], second: &[[f64; 3]]) -> Self {
        let about = |points: &[[f64; 3]]| {
            let centre = centroid(points);
            points.iter().map(|&p| sub(p, centre)).collect::<Vec<_>>()
        };
        let (x, y) = (about(first), about(second));
        let turn = best_rotation(&products(&y, &x)).matrix();
        let e: Vec<_> = x.iter().zip(&y).map(|(&x, &y)| sub(times(&turn, y), x)).collect();
        Self { turn, shape: products(&x, &x), across: products(&x, &e), change: products(&e, &e) }
    }

    /// The scaled points at a share of the way from the first pose to the second.
    pub fn at(&self, share: f64) -> Scaled<'_> {
        let both = combine(share, &self.across, share, &transposed(&self.across));
        let kept = combine(1.0, &self.shape, 1.0, &both);
        let kept = combine(1.0, &kept, share * share, &self.change);
        let spread = (share * (1.0 - share)).max(0.0).sqrt();
        let cross = combine(spread, &self.across, spread * share, &self.change);
        let dropped = self.change.map(|row| scale(spread * spread, row));
        // Products of two eigenvalues are the eigenvalues of the cofactors, so that their Frobenius norm bounds the
        // product of the two larger ones, and the next line the smallest from below.
        let minors = cofactors(&kept);
        let least = dot(kept[0], minors[0]) / frobenius(&minors);
        let [a, d] = if least >= SEPARATION * frobenius(&dropped) {
            leading_by_iteration(&kept, &cross, &dropped)
        } else {
            leading_by_rotations(&kept, &cross, &dropped)
        };
        // Rows of [A D] are x + w e and √(w (1 − w)) e.
        Scaled { turn: &self.turn, of_first: a, of_change: combine(share, &a, spread, &d) }
    }
}

/// Maps offsets in the two poses to coordinates of the scaled points, in arbitrary orientation and handedness.
pub(crate) struct Scaled<'a> {
    turn: &'a Matrix,
    of_first: Matrix,
    of_change: Matrix,
}

impl Scaled<'_> {
    /// A point from where it is in the two poses, relative to the same mean of points.
    pub fn point(&self, first: [f64; 3], second: [f64; 3]) -> [f64; 3] {
        let change = sub(times(self.turn, second), first);
        add(times(&self.of_first, first), times(&self.of_change, change))
    }

    /// Sums of products of scaled points and others, from those of the points in the two poses.
    pub fn products(&self, first: &Matrix, second: &Matrix) -> Matrix {
        let change = combine(1.0, &product(self.turn, second), -1.0, first);
        combine(1.0, &product(&self.of_first, first), 1.0, &product(&self.of_change, &change))
    }
}

/// An orthonormal basis of the invariant subspace of `[[kept, cross], [crossᵀ, dropped]]` with the three largest
/// eigenvalues, as two blocks with basis vectors as rows: the columns of `[I; Z] L⁻ᵀ` with `I + ZᵀZ = L Lᵀ`.
///
/// Orthogonal iteration from `Z = 0`; each step gains the ratio of the eigenvalues on either side.
fn leading_by_iteration(kept: &Matrix, cross: &Matrix, dropped: &Matrix) -> [Matrix; 2] {
    let back = transposed(cross);
    let mut z = [[0.0; 3]; 3];
    for _ in 0..STEPS {
        let over = combine(1.0, kept, 1.0, &product(cross, &z));
        let under = combine(1.0, &back, 1.0, &product(dropped, &z));
        let minors = cofactors(&over);
        let next = product(&under, &transposed(&minors));
        let next = next.map(|row| scale(1.0 / dot(over[0], minors[0]), row));
        let moved =
            combine(1.0, &next, -1.0, &z).iter().flatten().fold(0.0_f64, |m, c| m.max(c.abs()));
        z = next;
        if moved < 1e-15 {
            break;
        }
    }
    let slope = transposed(&z);
    let mut gram = product(&slope, &z);
    for (k, row) in gram.iter_mut().enumerate() {
        row[k] += 1.0;
    }
    let first = inverse_factor(&gram);
    [first, product(&first, &slope)]
}

/// `L⁻¹` of `L Lᵀ`, the Cholesky factorisation of a positive definite matrix.
fn inverse_factor(m: &Matrix) -> Matrix {
    let a = m[0][0].sqrt();
    let (b, c) = (m[1][0] / a, m[2][0] / a);
    let d = (m[1][1] - b * b).sqrt();
    let e = (m[2][1] - b * c) / d;
    let f = (m[2][2] - c * c - e * e).sqrt();
    let (ia, id, inv) = (1.0 / a, 1.0 / d, 1.0 / f);
    [[ia, 0.0, 0.0], [-b * ia * id, id, 0.0], [(b * e * id - c) * ia * inv, -e * id * inv, inv]]
}

/// The same for eigenvalues that may lie close together, from all six.
fn leading_by_rotations(kept: &Matrix, cross: &Matrix, dropped: &Matrix) -> [Matrix; 2] {
    let matrix: [[f64; 6]; 6] = std::array::from_fn(|i| {
        std::array::from_fn(|j| match (i < 3, j < 3) {
            (true, true) => kept[i][j],
            (true, false) => cross[i][j - 3],
            (false, true) => cross[j][i - 3],
            (false, false) => dropped[i - 3][j - 3],
        })
    });
    let (values, vectors) = symmetric_eigen(matrix);
    let mut order = [0, 1, 2, 3, 4, 5];
    order.sort_by(|&i: &usize, &j| values[j].total_cmp(&values[i]));
    [0, 3].map(|block| {
        std::array::from_fn(|k| std::array::from_fn(|axis| vectors[block + axis][order[k]]))
    })
}

/// `s · a + t · b`.
fn combine(s: f64, a: &Matrix, t: f64, b: &Matrix) -> Matrix {
    std::array::from_fn(|r| std::array::from_fn(|c| s * a[r][c] + t * b[r][c]))
}

fn frobenius(m: &Matrix) -> f64 {
    m.iter().map(|row| dot(*row, *row)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::{Rotation, geometry::distance};

    const FIRST: [[f64; 3]; 7] = [
        [0.1, 0.0, 0.3],
        [0.0, 0.2, -0.1],
        [-0.3, 0.1, 0.0],
        [0.2, 0.2, 0.2],
        [0.0; 3],
        [0.1, -0.2, 0.1],
        [-0.1, -0.1, -0.2],
    ];

    /// The first pose turned and shifted, with points moved by up to `by`.
    fn second(first: &[[f64; 3]], by: f64) -> Vec<[f64; 3]> {
        let turn = Rotation::about([0.3, 1.0, -0.4], 2.1);
        let moved = |(k, &p): (usize, &[f64; 3])| {
            let k = k as f64;
            let step = scale(by, [(7.0 * k).sin(), (5.0 * k + 1.0).sin(), (3.0 * k + 2.0).cos()]);
            add(turn.apply(add(p, step)), [1.0, -2.0, 0.5])
        };
        first.iter().enumerate().map(moved).collect()
    }

    fn squared_distances(points: &[[f64; 3]]) -> Vec<f64> {
        let pairs = points.iter().flat_map(|&p| points.iter().map(move |&q| distance(p, q)));
        pairs.map(|d| d * d).collect()
    }

    /// [Pan23] Eq. (2) as it stands.
    fn by_the_equation(squared: &[f64], n: usize) -> Vec<[f64; 3]> {
        let mean = |i: usize| squared[i * n..(i + 1) * n].iter().sum::<f64>() / n as f64;
        let grand = squared.iter().sum::<f64>() / (n * n) as f64;
        let gram: [[f64; 8]; 8] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let inside = i < n && j < n;
                if inside { -0.5 * (squared[i * n + j] - mean(i) - mean(j) + grand) } else { 0.0 }
            })
        });
        let (values, vectors) = symmetric_eigen(gram);
        let mut order: [usize; 8] = std::array::from_fn(|k| k);
        order.sort_by(|&i, &j| values[j].total_cmp(&values[i]));
        let root = |k: usize| values[order[k]].max(0.0).sqrt();
        vectors[..n].iter().map(|v| [0, 1, 2].map(|k| root(k) * v[order[k]])).collect()
    }

    fn scaled(first: &[[f64; 3]], second: &[[f64; 3]], share: f64) -> Vec<[f64; 3]> {
        let between = Between::new(first, second);
        let scaled = between.at(share);
        let (c, d) = (centroid(first), centroid(second));
        first.iter().zip(second).map(|(&p, &q)| scaled.point(sub(p, c), sub(q, d))).collect()
    }

    /// From poses that agree to poses that have nothing in common: by iteration and by rotations.
    #[test]
    fn classical_scaling_of_interpolated_distances() {
        for (by, n) in [(0.0, 7), (0.01, 7), (0.01, 4), (0.05, 5), (0.05, 7), (0.3, 7), (0.3, 4)] {
            let first = &FIRST[..n];
            let second = second(first, by);
            for share in [0.0, 0.1, 0.5, 0.8, 1.0] {
                let (a, b) = (squared_distances(first), squared_distances(&second));
                let mixed: Vec<f64> =
                    a.iter().zip(&b).map(|(a, b)| (1.0 - share) * a + share * b).collect();
                let expected = squared_distances(&by_the_equation(&mixed, n));
                let found = squared_distances(&scaled(first, &second, share));
                // Squares below 1 m² through two eigenproblems.
                let worst = expected.iter().zip(&found).map(|(e, f)| (e - f).abs());
                assert!(worst.fold(0.0, f64::max) < 1e-13, "{by} {n} {share}");
            }
        }
    }

    #[test]
    fn both_ways_find_the_same_subspace() {
        let matrix = |seed: f64| -> Matrix {
            std::array::from_fn(|r| {
                std::array::from_fn(|c| (seed + 3.0 * r as f64 + c as f64).sin())
            })
        };
        let square = |m: &Matrix| product(&transposed(m), m);
        for size in [0.0, 1e-3, 0.1] {
            let (a, d) = (matrix(1.0), matrix(2.0).map(|row| scale(size, row)));
            let a: Matrix = std::array::from_fn(|r| {
                std::array::from_fn(|c| a[r][c] + 2.0 * f64::from(u8::from(r == c)))
            });
            let (kept, cross, dropped) = (square(&a), product(&transposed(&a), &d), square(&d));
            let projector = |[a, d]: [Matrix; 2]| {
                [
                    product(&transposed(&a), &a),
                    product(&transposed(&d), &a),
                    product(&transposed(&d), &d),
                ]
            };
            let one = projector(leading_by_iteration(&kept, &cross, &dropped));
            let two = projector(leading_by_rotations(&kept, &cross, &dropped));
            for (p, q) in one.iter().flatten().flatten().zip(two.iter().flatten().flatten()) {
                assert!((p - q).abs() < 1e-14, "{size}");
            }
        }
    }

    /// Four corners of a square that fold up the other way have no mean shape in which the diagonals fit.
    #[test]
    fn distances_of_no_points_give_finite_points() {
        let fold = |h: f64| [[0.1, 0.0, h], [0.0, 0.1, -h], [-0.1, 0.0, h], [0.0, -0.1, -h]];
        for share in [0.0, 0.3, 0.5] {
            let points = scaled(&fold(0.08), &fold(-0.02), share);
            assert!(points.iter().flatten().all(|c| c.is_finite()));
        }
    }
}
