use mocap_core::Termination;

const STEPS: usize = 500;

/// Minimises `f` by the downhill simplex of Nelder and Mead, from `start` with edges of `edge`.
///
/// Converged where the values of the corners agree to `tolerance` of their size.
pub(crate) fn minimise(
    f: impl Fn([f64; 2]) -> f64,
    start: [f64; 2],
    edge: [f64; 2],
    tolerance: f64,
) -> ([f64; 2], f64, Termination) {
    let corner = |x: [f64; 2]| (x, f(x));
    let mut corners = [
        corner(start),
        corner([start[0] + edge[0], start[1]]),
        corner([start[0], start[1] + edge[1]]),
    ];
    for _ in 0..STEPS {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let [best, second, worst] = corners;
        let size: f64 = (0..2).map(|i| (best.0[i] - worst.0[i]).abs()).sum();
        if worst.1 - best.1 <= tolerance * (best.1.abs() + tolerance) && size < 1e-4 {
            return (best.0, best.1, Termination::Converged);
        }
        let along = |factor: f64| {
            corner(std::array::from_fn(|i| {
                let middle = 0.5 * (best.0[i] + second.0[i]);
                middle + factor * (worst.0[i] - middle)
            }))
        };
        let reflected = along(-1.0);
        let replacement = if reflected.1 < best.1 {
            let expanded = along(-2.0);
            if expanded.1 < reflected.1 { expanded } else { reflected }
        } else if reflected.1 < second.1 {
            reflected
        } else {
            along(if reflected.1 < worst.1 { -0.5 } else { 0.5 })
        };
        if replacement.1 < worst.1 {
            corners[2] = replacement;
        } else {
            let halfway = |x: [f64; 2]| corner(std::array::from_fn(|i| 0.5 * (x[i] + best.0[i])));
            corners = [best, halfway(second.0), halfway(worst.0)];
        }
    }
    corners.sort_by(|a, b| a.1.total_cmp(&b.1));
    (corners[0].0, corners[0].1, Termination::IterationLimit)
}
