use std::ops::ControlFlow;

use mocap_core::{FillError, Filled, GapFiller, IterReport, Take};

use crate::{Edges, per_marker};

/// The piecewise cubic that rises and falls only where the samples do: PCHIP.
///
/// Each coordinate by itself never leaves the range of the two samples beside a gap, so the curve
/// cannot overshoot as a spline does. Its slopes at the samples are the weighted harmonic means of
/// [FB84], with one-sided three-point slopes at the ends of the take.
///
/// Implements [FC80] Sec. 4, with the slopes of [FB84] Eq. (5).
///
/// # When not to use
/// In gaps of more than a few tenths of a second, or where a turning point lies inside the gap: it is cut
/// off. The limits hold for each coordinate, so another choice of axes gives a slightly different fill.
///
/// # Cost
/// Linear in the frames of the markers that have gaps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Pchip {
    /// What becomes of one-sided gaps.
    pub edges: Edges,
}

impl GapFiller for Pchip {
    fn name(&self) -> &'static str {
        "pchip"
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        per_marker::fill(take, self.name(), self.edges, |samples| {
            let knots: Vec<f64> = samples.frames.iter().map(|&f| f as f64).collect();
            let curves: [Monotone; 3] = std::array::from_fn(|a| {
                Monotone::through(&knots, samples.values.iter().map(|p| p[a]).collect())
            });
            move |t| std::array::from_fn(|a| curves[a].at(&knots, t as f64))
        })
    }
}

/// A cubic Hermite interpolant by its values and slopes at the knots.
struct Monotone {
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Monotone {
    fn through(knots: &[f64], values: Vec<f64>) -> Self {
        let slopes = slopes(knots, &values);
        Self { values, slopes }
    }

    /// Value at `x`, which must lie between the first and the last knot.
    fn at(&self, knots: &[f64], x: f64) -> f64 {
        let i = knots.partition_point(|&k| k < x).clamp(1, knots.len() - 1);
        let h = knots[i] - knots[i - 1];
        let u = (x - knots[i - 1]) / h;
        let v = 1.0 - u;
        // Each end's value and slope; `u² (3 − 2u)` and `v² (3 − 2v)` sum to one.
        let from = v * v * ((1.0 + 2.0 * u) * self.values[i - 1] + u * h * self.slopes[i - 1]);
        let to = u * u * ((1.0 + 2.0 * v) * self.values[i] - v * h * self.slopes[i]);
        from + to
    }
}

/// Slopes at the knots that keep the interpolant monotone between any two.
///
/// Implements [FB84] Eq. (5).
fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let rise: Vec<f64> = y.windows(2).zip(&h).map(|(w, h)| (w[1] - w[0]) / h).collect();
    match rise.len() {
        0 => return vec![0.0; y.len()],
        1 => return vec![rise[0]; 2],
        _ => {}
    }
    let last = rise.len() - 1;
    let mut slopes = vec![end_slope(h[0], h[1], rise[0], rise[1])];
    for i in 1..=last {
        slopes.push(if rise[i - 1] * rise[i] > 0.0 {
            let (before, after) = (2.0 * h[i] + h[i - 1], h[i] + 2.0 * h[i - 1]);
            (before + after) / (before / rise[i - 1] + after / rise[i])
        } else {
            0.0
        });
    }
    slopes.push(end_slope(h[last], h[last - 1], rise[last], rise[last - 1]));
    slopes
}

/// The slope of the parabola through three points at the outermost, cut to what keeps the interval monotone.
fn end_slope(h: f64, next_h: f64, rise: f64, next_rise: f64) -> f64 {
    let slope = ((2.0 * h + next_h) * rise - h * next_rise) / (h + next_h);
    if slope * rise <= 0.0 {
        0.0
    } else if rise * next_rise <= 0.0 && slope.abs() > 3.0 * rise.abs() {
        3.0 * rise
    } else {
        slope
    }
}
