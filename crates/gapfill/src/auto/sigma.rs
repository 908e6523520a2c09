//! How far a fill errs, by the distance from its borders.

use locality_ridge::ensemble::{PseudoGap, Sides};
use mocap_core::geometry::dot;

/// Correlation times that are tried, in seconds.
const TIMES_S: [f64; 6] = [0.03, 0.1, 0.3, 1.0, 3.0, 10.0];

/// The root mean square error becomes the radius that holds 68 % of errors by a factor that is 1 for gaps of
/// this length.
const PAR_S: f64 = 0.5;

/// It grows with the length of the gap to this power: the rarer a pose, the longer the gaps that hold one.
const GROWTH: f64 = 0.05;

/// Errors that spread from the borders as those of a stationary process that is known there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    variance_m2: f64,
    tau: f64,
    rate_hz: f64,
}

/// Errors of one pseudo-gap with the frames they belong to.
pub(super) struct Errors<'a> {
    pub gap: &'a PseudoGap,
    pub frames: &'a [usize],
    pub values: &'a [[f64; 3]],
    /// How much they count.
    pub counts: f64,
}

impl Spread {
    /// The spread that makes the errors most likely; `None` without any.
    pub fn of(pseudo_gaps: &[Errors<'_>], rate_hz: f64) -> Option<Self> {
        let samples: Vec<(f64, Option<f64>, Option<f64>, f64)> = pseudo_gaps
            .iter()
            .flat_map(|tried| {
                let weight = tried.counts / tried.values.len().max(1) as f64;
                tried.frames.iter().zip(tried.values).map(move |(&t, &e)| {
                    let (before, after) = distances(t, &tried.gap.frames, tried.gap.sides);
                    (dot(e, e), before, after, weight)
                })
            })
            .collect();
        let total: f64 = samples.iter().map(|s| s.3).sum();
        TIMES_S
            .iter()
            .map(|seconds| {
                let tau = seconds * rate_hz;
                let share = |s: &(f64, Option<f64>, Option<f64>, f64)| open_share(s.1, s.2, tau);
                let variance = samples.iter().map(|s| s.3 * s.0 / share(s)).sum::<f64>() / total;
                // Three coordinates each; the constant terms do not matter.
                let cost = samples.iter().map(|s| s.3 * share(s).ln()).sum::<f64>() / total
                    + variance.max(1e-24).ln();
                (cost, Self { variance_m2: variance, tau, rate_hz })
            })
            .filter(|(cost, _)| cost.is_finite())
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, spread)| spread)
    }

    /// The spread where candidates differ by so many times as much, in mean square: half of the variance is taken to
    /// go with it.
    pub fn in_dissent(self, times: f64) -> Self {
        Self { variance_m2: 0.5 * (1.0 + times) * self.variance_m2, ..self }
    }

    /// Sigma in metres of frame `t` of a gap.
    pub fn sigma_m(&self, t: usize, gap: &std::ops::Range<usize>, sides: Sides) -> f64 {
        let (before, after) = distances(t, gap, sides);
        let seconds = gap.len() as f64 / self.rate_hz;
        (seconds / PAR_S).powf(GROWTH)
            * (self.variance_m2 * open_share(before, after, self.tau)).sqrt()
    }
}

/// Frames to the observed sample on either side.
fn distances(t: usize, gap: &std::ops::Range<usize>, sides: Sides) -> (Option<f64>, Option<f64>) {
    let before = sides.left.then(|| (t + 1 - gap.start) as f64);
    let after = sides.right.then(|| (gap.end - t) as f64);
    (before, after)
}

/// The share of its variance that an exponentially correlated process keeps between known values.
fn open_share(before: Option<f64>, after: Option<f64>, tau: f64) -> f64 {
    let lost = |frames: f64| -(-2.0 * frames / tau).exp_m1();
    match (before, after) {
        (None, None) => 1.0,
        (Some(d), None) | (None, Some(d)) => lost(d),
        (Some(a), Some(b)) => lost(a) * lost(b) / lost(a + b),
    }
}
