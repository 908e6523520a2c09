//! Moments of points.

use mocap_core::geometry::{add, scale, sub, symmetric_eigen};

/// Squares of extents below this share of the largest are rounding.
const ROUNDING: f64 = 1e-12;

/// Sums of products `Σ p[a] q[b]`.
pub(crate) fn products(source: &[[f64; 3]], target: &[[f64; 3]]) -> [[f64; 3]; 3] {
    let mut sums = [[0.0; 3]; 3];
    for (p, q) in source.iter().zip(target) {
        for (row, x) in sums.iter_mut().zip(p) {
            for (entry, y) in row.iter_mut().zip(q) {
                *entry += x * y;
            }
        }
    }
    sums
}

/// The weighted mean.
pub(crate) fn centre(points: &[[f64; 3]], weights: &[f64]) -> [f64; 3] {
    let sum = points.iter().zip(weights).fold([0.0; 3], |sum, (&p, &w)| add(sum, scale(w, p)));
    scale(1.0 / weights.iter().sum::<f64>(), sum)
}

/// The mean.
pub(crate) fn centroid(points: &[[f64; 3]]) -> [f64; 3] {
    let sum = points.iter().fold([0.0; 3], |sum, &p| add(sum, p));
    scale(1.0 / points.len() as f64, sum)
}

/// Extent of points along their principal axes, largest first: singular values of their offsets
/// from the mean.
pub(crate) fn extents(points: &[[f64; 3]]) -> [f64; 3] {
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
    values.sort_by(|x, y| y.total_cmp(x));
    // Rounding in the squares would count as height above a plane.
    let least = ROUNDING * values[0];
    values.map(|value| if value > least { value.sqrt() } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extents_of_a_box() {
        let corners: Vec<[f64; 3]> = (0..8)
            .map(|k| [f64::from(k & 1) * 0.6, f64::from(k >> 1 & 1) * 0.4, f64::from(k >> 2) * 0.2])
            .collect();
        let [a, b, c] = extents(&corners);
        // Eight corners, each half an edge away from the middle plane.
        let expected = [0.3, 0.2, 0.1].map(|half: f64| half * 8.0_f64.sqrt());
        assert!(
            (a - expected[0]).abs() + (b - expected[1]).abs() + (c - expected[2]).abs() < 1e-13
        );
    }
}
