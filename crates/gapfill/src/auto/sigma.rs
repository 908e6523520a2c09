//! How far a fill errs, by the distance from its borders.

use locality_ridge::ensemble::{PseudoGap, Sides};
use mocap_core::geometry::dot;

/// Correlation times that are tried, in seconds.
const TIMES_S: [f64; 6] = [0.03, 0.1, 0.3, 1.0, 3.0, 10.0];

/// The mixture is the one that errs least in the pseudo-gaps, and so errs by more in the gap: with `n` of them its
/// variance is larger by a share that goes with 1 + this / n.
const OPTIMISM: f64 = 4.0;

/// The root mean square error in so many pseudo-gaps is the radius that holds 68 % of errors.
const PAR: f64 = 8.0;

/// Errors that spread from the borders as those of a stationary process that is known there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    variance_m2: f64,
    tau: f64,
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
        let few = optimism(pseudo_gaps);
        TIMES_S
            .iter()
            .map(|seconds| {
                let tau = seconds * rate_hz;
                let share = |s: &(f64, Option<f64>, Option<f64>, f64)| open_share(s.1, s.2, tau);
                let variance = samples.iter().map(|s| s.3 * s.0 / share(s)).sum::<f64>() / total;
                // Three coordinates each; the constant terms do not matter.
                let cost = samples.iter().map(|s| s.3 * share(s).ln()).sum::<f64>() / total
                    + variance.max(1e-24).ln();
                (cost, Self { variance_m2: few * variance, tau })
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
        (self.variance_m2 * open_share(before, after, self.tau)).sqrt()
    }
}

/// By how much the variance of errors exceeds that in the pseudo-gaps, of which those that count little are few.
fn optimism(pseudo_gaps: &[Errors<'_>]) -> f64 {
    let counts = || pseudo_gaps.iter().filter(|tried| !tried.values.is_empty()).map(|t| t.counts);
    let squares: f64 = counts().map(|c| c * c).sum();
    let n = counts().sum::<f64>().powi(2) / squares;
    if squares > 0.0 { ((1.0 + OPTIMISM / n) / (1.0 + OPTIMISM / PAR)).max(1.0) } else { 1.0 }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_pseudo_gaps_are_too_good() {
        let both = Sides { left: true, right: true };
        let gap = PseudoGap { frames: 0..2, hidden: 0..2, sides: both };
        let (frames, values) = ([0, 1], [[0.01, 0.0, 0.0]; 2]);
        let tried = |counts: f64| Errors { gap: &gap, frames: &frames, values: &values, counts };
        let of = |counts: &[f64]| {
            let tried: Vec<Errors<'_>> = counts.iter().map(|&c| tried(c)).collect();
            Spread::of(&tried, 100.0).unwrap().sigma_m(0, &(0..2), both)
        };
        let many = of(&[1.0; 8]);
        assert!((of(&[1.0; 20]) / many - 1.0).abs() < 1e-12);
        assert!(of(&[1.0; 2]) > 1.3 * many);
        // Those that count for nothing are none.
        assert!((of(&[1.0, 1.0, 1e-9]) / of(&[1.0; 2]) - 1.0).abs() < 1e-6);
        assert!(Spread::of(&[], 100.0).is_none());
    }
}
