use crate::math::solve;

/// The plane that a twentieth of the points lie below: its height at the origin and its slopes, at most 4 %. Over
/// points within two metres it is level: what rises there is more likely a foot than the floor.
///
/// Asymmetric least squares by reweighting; the level is then set so that the share below is exact.
pub(super) fn floor(points: &[[f64; 3]]) -> [f64; 3] {
    const BELOW: f64 = 0.05;
    const ROUNDS: usize = 30;
    /// Weight of the wish for a level floor against one point, in m².
    const LEVEL_M2: f64 = 0.02;
    const STEEPEST: f64 = 0.04;
    const NEAR_M: f64 = 2.0;
    let span = |axis: usize| {
        let ends = points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| {
            [low.min(p[axis]), high.max(p[axis])]
        });
        ends[1] - ends[0]
    };
    let steepest = if span(0).hypot(span(1)) < NEAR_M { 0.0 } else { STEEPEST };
    let mut plane = [0.0; 3];
    let under =
        |plane: &[f64; 3], p: &[f64; 3]| p[2] - plane[0] - plane[1] * p[0] - plane[2] * p[1];
    for _ in 0..ROUNDS {
        let mut normal = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        for p in points {
            let weight = if under(&plane, p) > 0.0 { BELOW } else { 1.0 - BELOW };
            let row = [1.0, p[0], p[1]];
            for a in 0..3 {
                right[a] += weight * row[a] * p[2];
                for b in 0..3 {
                    normal[a][b] += weight * row[a] * row[b];
                }
            }
        }
        for (a, row) in normal.iter_mut().enumerate().skip(1) {
            row[a] += LEVEL_M2 * BELOW * points.len() as f64;
        }
        plane = solve(normal, right);
        (1..3).for_each(|a| plane[a] = plane[a].clamp(-steepest, steepest));
    }
    let mut left: Vec<f64> = points.iter().map(|p| under(&plane, p)).collect();
    left.sort_by(f64::total_cmp);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let share = left[(BELOW * (left.len() - 1) as f64) as usize];
    plane[0] += share;
    plane
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sloping_floor_is_found_under_steps() {
        let points: Vec<[f64; 3]> = (0..400)
            .map(|k| {
                let x = 0.01 * f64::from(k);
                [x, 0.2, 0.03 + 0.015 * x + 0.05 * (0.5 * f64::from(k)).sin().max(0.0)]
            })
            .collect();
        let [level, ahead, left] = floor(&points);
        // Half the points stand on the floor, the others above it.
        assert!((ahead - 0.015).abs() < 1e-3, "{ahead}");
        assert!((level + left * 0.2 - 0.03).abs() < 2e-3, "{level}");
    }
}
