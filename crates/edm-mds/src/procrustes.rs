//! Rigid fits of points to points.

use mocap_core::{
    Rotation,
    geometry::{add, best_rotation, dot, scale, sub, symmetric_eigen},
};

/// Squares of extents below this share of the largest are rounding.
const ROUNDING: f64 = 1e-12;

/// A rigid motion as centre, rotation, centre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fit {
    from: [f64; 3],
    rotation: Rotation,
    to: [f64; 3],
}

impl Fit {
    /// The proper rigid motion that takes `source` to `target` with the least weighted sum of
    /// squares: the rotation is the dominant eigenvector of the matrix of sums of products in
    /// [Horn87].
    pub fn of(source: &[[f64; 3]], target: &[[f64; 3]], weights: &[f64]) -> Self {
        let (from, to) = (centre(source, weights), centre(target, weights));
        let mut sums = [[0.0; 3]; 3];
        for ((&p, &q), &w) in source.iter().zip(target).zip(weights) {
            let (p, q) = (scale(w, sub(p, from)), sub(q, to));
            for (row, x) in sums.iter_mut().zip(p) {
                for (entry, y) in row.iter_mut().zip(q) {
                    *entry += x * y;
                }
            }
        }
        Self { from, rotation: best_rotation(&sums), to }
    }

    pub fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        add(self.rotation.apply(sub(p, self.from)), self.to)
    }
}

/// The weighted mean.
pub(crate) fn centre(points: &[[f64; 3]], weights: &[f64]) -> [f64; 3] {
    let sum = points.iter().zip(weights).fold([0.0; 3], |sum, (&p, &w)| add(sum, scale(w, p)));
    scale(1.0 / weights.iter().sum::<f64>(), sum)
}

/// Extent of points along their principal axes, largest first: singular values of their offsets
/// from the centre.
pub(crate) fn extents(points: &[[f64; 3]]) -> [f64; 3] {
    let centre = centre(points, &vec![1.0; points.len()]);
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

/// Squared distance.
pub(crate) fn squared(p: [f64; 3], q: [f64; 3]) -> f64 {
    let d = sub(p, q);
    dot(d, d)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::geometry::distance;

    #[test]
    fn a_motion_is_found_again() {
        let source = [[0.1, 0.0, 0.2], [0.3, -0.2, 0.0], [0.0, 0.4, 0.1], [-0.1, 0.1, -0.3]];
        let rotation = Rotation::about([1.0, 2.0, -0.5], 2.5);
        let moved = |p| add(rotation.apply(p), [3.0, -2.0, 1.0]);
        let fit = Fit::of(&source, &source.map(moved), &[1.0, 0.5, 2.0, 1.0]);
        let q = [0.5, 0.6, -0.7];
        // Coordinates of a few metres lose about 1e-15 each.
        assert!(distance(fit.apply(q), moved(q)) < 1e-13);
    }

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
