use std::ops::ControlFlow;

use mocap_core::{FillError, Filled, GapFiller, IterReport, Take};

use crate::{Edges, per_marker};

/// The not-a-knot cubic spline through all observed positions of a marker.
///
/// The interpolant is twice continuously differentiable, and its third derivative is continuous at
/// the second and the last but one sample ([deBoor78] ch. IV). Two samples give a line and three a
/// parabola.
///
/// # When not to use
/// In gaps of more than a few tenths of a second: the curve overshoots, by metres in gaps of seconds.
///
/// # Cost
/// Linear in the frames of the markers that have gaps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CubicSpline {
    /// What becomes of one-sided gaps.
    pub edges: Edges,
}

impl GapFiller for CubicSpline {
    fn name(&self) -> &'static str {
        "spline"
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        per_marker::fill(take, self.name(), self.edges, |samples| {
            let knots: Vec<f64> = samples.frames.iter().map(|&f| f as f64).collect();
            let curves: [NotAKnot; 3] = std::array::from_fn(|a| {
                NotAKnot::through(&knots, samples.values.iter().map(|p| p[a]).collect())
            });
            move |t| std::array::from_fn(|a| curves[a].at(&knots, t as f64))
        })
    }
}

/// A cubic spline by its values and second derivatives at the knots.
struct NotAKnot {
    values: Vec<f64>,
    curvature: Vec<f64>,
}

impl NotAKnot {
    fn through(knots: &[f64], values: Vec<f64>) -> Self {
        let curvature = match knots.len() {
            0..=2 => vec![0.0; knots.len()],
            3 => vec![parabola(knots, &values); 3],
            _ => curvatures(knots, &values),
        };
        Self { values, curvature }
    }

    /// Value at `x`, which must lie between the first and the last knot.
    fn at(&self, knots: &[f64], x: f64) -> f64 {
        let i = knots.partition_point(|&k| k < x).clamp(1, knots.len() - 1);
        let h = knots[i] - knots[i - 1];
        let (a, b) = ((knots[i] - x) / h, (x - knots[i - 1]) / h);
        let bend = (a * a * a - a) * self.curvature[i - 1] + (b * b * b - b) * self.curvature[i];
        a * self.values[i - 1] + b * self.values[i] + bend * h * h / 6.0
    }
}

/// Second derivative of the parabola through three points.
fn parabola(x: &[f64], y: &[f64]) -> f64 {
    let slope = |i: usize| (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    2.0 * (slope(1) - slope(0)) / (x[2] - x[0])
}

/// Second derivatives at four or more knots, by one tridiagonal elimination.
///
/// The interior rows are `h₋ c₋ + 2 (h₋ + h₊) c + h₊ c₊ = 6 (slope₊ − slope₋)`; the not-a-knot
/// conditions express the outermost two unknowns by their neighbours.
fn curvatures(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let slope: Vec<f64> = (0..n - 1).map(|i| (y[i + 1] - y[i]) / h[i]).collect();
    let (mut diagonal, mut upper, mut right) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        let (mut lower, mut middle, mut above) = (h[i - 1], 2.0 * (h[i - 1] + h[i]), h[i]);
        if i == 1 {
            middle += h[0] * (h[0] + h[1]) / h[1];
            above -= h[0] * h[0] / h[1];
            lower = 0.0;
        }
        if i == n - 2 {
            let (g, last) = (h[n - 3], h[n - 2]);
            middle += last * (last + g) / g;
            lower -= last * last / g;
            above = 0.0;
        }
        let factor = if i == 1 { 0.0 } else { lower / diagonal[i - 1] };
        diagonal[i] = middle - factor * upper[i - 1];
        upper[i] = above;
        right[i] = 6.0 * (slope[i] - slope[i - 1]) - factor * right[i - 1];
    }
    let mut c = vec![0.0; n];
    for i in (1..n - 1).rev() {
        c[i] = (right[i] - upper[i] * c[i + 1]) / diagonal[i];
    }
    c[0] = ((h[0] + h[1]) * c[1] - h[0] * c[2]) / h[1];
    c[n - 1] = ((h[n - 2] + h[n - 3]) * c[n - 2] - h[n - 2] * c[n - 3]) / h[n - 3];
    c
}
