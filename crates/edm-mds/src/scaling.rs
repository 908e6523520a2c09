//! Points from their distances.

use mocap_core::geometry::symmetric_eigen;

use crate::params::MAX_NEIGHBOURS;

/// Points in space whose mutual squared distances come closest, in the sense of classical scaling,
/// to the row-major symmetric matrix `(n, n)` in m², around their centre.
///
/// Handedness and orientation are arbitrary. A matrix that no points have, as interpolation may give,
/// has negative eigenvalues; they count as zero.
///
/// Implements [Pan23] Eq. (2).
pub(crate) fn classical_scaling(squared: &[f64], n: usize) -> Vec<[f64; 3]> {
    if n <= 8 { scaling::<8>(squared, n) } else { scaling::<{ MAX_NEIGHBOURS + 1 }>(squared, n) }
}

fn scaling<const N: usize>(squared: &[f64], n: usize) -> Vec<[f64; 3]> {
    let count = n.max(1) as f64;
    let means: Vec<f64> =
        (0..n).map(|i| squared[i * n..(i + 1) * n].iter().sum::<f64>() / count).collect();
    let grand = means.iter().sum::<f64>() / count;
    let mut gram = [[0.0; N]; N];
    for (i, row) in gram.iter_mut().enumerate().take(n) {
        for (j, entry) in row.iter_mut().enumerate().take(n) {
            *entry = -0.5 * (squared[i * n + j] - means[i] - means[j] + grand);
        }
    }
    let (values, vectors) = symmetric_eigen(gram);
    let mut order: [usize; N] = std::array::from_fn(|k| k);
    order.sort_by(|&i, &j| values[j].total_cmp(&values[i]));
    let roots = [0, 1, 2].map(|k| (order[k], values[order[k]].max(0.0).sqrt()));
    vectors[..n].iter().map(|row| roots.map(|(column, root)| root * row[column])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::geometry::distance;

    fn squared_distances(points: &[[f64; 3]]) -> Vec<f64> {
        let pairs = points.iter().flat_map(|&p| points.iter().map(move |&q| distance(p, q)));
        pairs.map(|d| d * d).collect()
    }

    #[test]
    fn distances_are_rebuilt() {
        let points =
            [[0.1, 0.0, 0.3], [0.0, 0.2, -0.1], [-0.3, 0.1, 0.0], [0.2, 0.2, 0.2], [0.0; 3]];
        let squared = squared_distances(&points);
        let rebuilt = squared_distances(&classical_scaling(&squared, 5));
        // Squares below 1 m² through a well-conditioned eigenproblem.
        assert!(squared.iter().zip(rebuilt).all(|(a, b)| (a - b).abs() < 1e-14));
    }

    /// Distances 1, 1 and 3 break the triangle inequality.
    #[test]
    fn distances_of_no_points_give_finite_points() {
        let squared = [0.0, 1.0, 9.0, 1.0, 0.0, 1.0, 9.0, 1.0, 0.0];
        let points = classical_scaling(&squared, 3);
        assert!(points.iter().flatten().all(|c| c.is_finite()));
        // Classical scaling keeps the positive part, a line, and drops the negative one.
        assert!(points.iter().all(|p| p[1].abs() < 1e-12 && p[2].abs() < 1e-12));
        assert!((distance(points[0], points[2]) - 3.0).abs() < 1e-12);
    }
}
