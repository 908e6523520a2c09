//! A point from its distances to known points.

use mocap_core::geometry::{add, cofactors, dot, norm, scale, sub};

/// Damping relative to the sum of weights: what the distances do not determine stays at the start.
const DAMPING: f64 = 1e-4;

/// A climb by less is rounding: refusing it would let rounding decide where the steps end.
const ROUNDING: f64 = 1e-9;

/// Steps at most; from a good start four or five suffice.
const STEPS: usize = 20;

/// The point nearest to `start` with a locally least Σ wⱼ (‖x − mⱼ‖ − dⱼ)², by damped Gauss–Newton
/// steps that are halved until they do not climb, to within a picometre.
///
/// With fewer than three anchors, or anchors on a line or in a plane, the start decides what the
/// distances leave open, such as the side of the plane.
///
/// # Units
/// Metres.
///
/// Deviates from [Pan23] Eq. (1): it sums squares of differences of distances, where the paper has
/// absolute differences of squared distances.
pub(crate) fn trilaterate(
    anchors: &[[f64; 3]],
    distances: &[f64],
    weights: &[f64],
    start: [f64; 3],
) -> [f64; 3] {
    let terms = || anchors.iter().zip(distances).zip(weights);
    let cost =
        |x: [f64; 3]| terms().map(|((&m, d), w)| w * (norm(sub(x, m)) - d).powi(2)).sum::<f64>();
    let damping = DAMPING * weights.iter().sum::<f64>();
    let (mut x, mut best) = (start, cost(start));
    for _ in 0..STEPS {
        let mut normal = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        for ((&m, d), &w) in terms() {
            let away = sub(x, m);
            let length = norm(away).max(f64::MIN_POSITIVE);
            let direction = scale(1.0 / length, away);
            right = add(right, scale(w * (d - length), direction));
            for (row, u) in normal.iter_mut().zip(direction) {
                for (entry, v) in row.iter_mut().zip(direction) {
                    *entry += w * u * v;
                }
            }
        }
        for (k, row) in normal.iter_mut().enumerate() {
            row[k] += damping;
        }
        let Some(step) = solve(&normal, right) else { break };
        let lower = (0..8).map(|k| 0.5_f64.powi(k)).find_map(|share| {
            let next = add(x, scale(share, step));
            let cost = cost(next);
            (cost <= best * (1.0 + ROUNDING)).then_some((next, cost))
        });
        let Some((next, cost)) = lower else { break };
        let moved = norm(sub(next, x));
        (x, best) = (next, cost);
        if moved < 1e-12 {
            break;
        }
    }
    x
}

/// Cramer's rule.
fn solve(rows: &[[f64; 3]; 3], right: [f64; 3]) -> Option<[f64; 3]> {
    let minors = cofactors(rows);
    let determinant = dot(rows[0], minors[0]);
    let sum = (0..3).fold([0.0; 3], |sum, k| add(sum, scale(right[k], minors[k])));
    let x = scale(1.0 / determinant, sum);
    x.iter().all(|c| c.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::geometry::distance;

    const ANCHORS: [[f64; 3]; 4] =
        [[0.3, 0.0, 0.0], [0.0, 0.3, 0.1], [-0.2, -0.2, 0.0], [0.0, 0.1, -0.3]];

    #[test]
    fn a_point_is_found_from_exact_distances() {
        let point = [0.1, -0.15, 0.2];
        let distances = ANCHORS.map(|m| distance(m, point));
        let found = trilaterate(&ANCHORS, &distances, &[1.0, 2.0, 0.5, 1.0], [0.05, -0.05, 0.1]);
        // Damping leaves a thousandth of the last step, at most.
        assert!(distance(found, point) < 1e-10);
    }

    /// The gradient of the cost vanishes where distances contradict each other.
    #[test]
    fn contradictions_are_balanced() {
        let weights = [1.0, 2.0, 0.5, 1.0];
        let distances = [0.35, 0.4, 0.3, 0.45];
        let x = trilaterate(&ANCHORS, &distances, &weights, [0.05, -0.05, 0.1]);
        let mut gradient = [0.0; 3];
        for k in 0..4 {
            let away = sub(x, ANCHORS[k]);
            let slope = weights[k] * (norm(away) - distances[k]) / norm(away);
            gradient = add(gradient, scale(slope, away));
        }
        assert!(norm(gradient) < 1e-6, "{gradient:?}");
    }

    #[test]
    fn one_anchor_keeps_the_direction() {
        let found = trilaterate(&[[1.0, 1.0, 1.0]], &[0.2], &[1.0], [1.0, 1.0, 1.1]);
        assert!(distance(found, [1.0, 1.0, 1.2]) < 1e-6);
    }

    #[test]
    fn the_start_decides_the_side_of_a_plane() {
        let flat = [[0.2, 0.0, 0.0], [-0.1, 0.2, 0.0], [-0.1, -0.2, 0.0]];
        for height in [0.1, -0.1] {
            let point = [0.01, 0.02, height];
            let distances = flat.map(|m| distance(m, point));
            let found = trilaterate(&flat, &distances, &[1.0; 3], [0.0, 0.0, 0.8 * height]);
            assert!(distance(found, point) < 1e-9);
        }
    }
}
