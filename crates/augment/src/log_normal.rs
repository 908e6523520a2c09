use std::collections::BTreeSet;

use mocap_core::Termination;

use crate::{AugmentError, GapHistogram, error::check, simplex::minimise};

/// A log-normal law of gap lengths, counted in whole frames.
///
/// A length `l ≥ 1` has probability `Φ((ln(l+½)−mu)/sigma) − Φ((ln(l−½)−mu)/sigma)`, divided by the
/// probability of all `l ≥ 1`. The heavy tail of captured gaps is in it at two parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogNormal {
    mu: f64,
    sigma: f64,
}

/// Gaps of which this much is known: their number, and bounds of their length in frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthSpan {
    /// Shortest length they may have, in frames, from 1.
    pub shortest: usize,
    /// Longest length they may have, in frames; `None` for gaps that were cut off.
    pub longest: Option<usize>,
    /// Number of gaps, or their weight.
    pub weight: f64,
}

impl LengthSpan {
    /// Gaps of known length.
    #[must_use]
    pub fn exact(frames: usize, weight: f64) -> Self {
        Self { shortest: frames, longest: Some(frames), weight }
    }

    /// Gaps that last at least this long: right-censored.
    #[must_use]
    pub fn at_least(frames: usize, weight: f64) -> Self {
        Self { shortest: frames, longest: None, weight }
    }
}

/// A fitted law and how well it fits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogNormalFit {
    /// The most likely law.
    pub law: LogNormal,
    /// Mean negative log-likelihood of a gap in nats.
    pub nats_per_gap: f64,
    /// Total weight of the gaps.
    pub weight: f64,
    /// Share of the weight whose length is known from below only.
    pub censored_share: f64,
    /// [`Termination::Stalled`] where the best law lies at the edge of the searched range, as it
    /// does when the lengths are no heavier in the tail than in one or two bins.
    pub termination: Termination,
}

const MU: (f64, f64) = (-20.0, 20.0);
const SIGMA: (f64, f64) = (0.01, 20.0);
/// No histogram is longer: 2.3 hours at 120 Hz.
const LONGEST: usize = 1_000_000;

impl LogNormal {
    /// The law with mean `mu` and standard deviation `sigma` of the logarithm of the length in frames.
    ///
    /// # Errors
    /// [`AugmentError::OutOfRange`] unless `mu` is within ±20 and `sigma` between 0.01 and 20.
    pub fn new(mu: f64, sigma: f64) -> Result<Self, AugmentError> {
        check("mu", mu, MU.0, MU.1)?;
        check("sigma", sigma, SIGMA.0, SIGMA.1)?;
        Ok(Self { mu, sigma })
    }

    /// The law of built-in parameters.
    pub(crate) const fn trusted(mu: f64, sigma: f64) -> Self {
        Self { mu, sigma }
    }

    /// Mean of the logarithm of the length in frames, before lengths below ½ are cut off.
    #[must_use]
    pub fn mu(&self) -> f64 {
        self.mu
    }

    /// Standard deviation of the logarithm of the length in frames.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Probability of a gap of this many frames.
    #[must_use]
    pub fn probability(&self, frames: usize) -> f64 {
        if frames == 0 { 0.0 } else { self.ln_span(frames, Some(frames)).map_or(0.0, libm::exp) }
    }

    /// Probability of a gap of at least this many frames.
    #[must_use]
    pub fn at_least(&self, frames: usize) -> f64 {
        self.ln_span(frames.max(1), None).map_or(0.0, libm::exp)
    }

    /// The lengths of 1 to `longest` frames, renormalised.
    ///
    /// # Errors
    /// [`AugmentError::OutOfRange`] unless `longest` is between 1 and 1 000 000;
    /// [`AugmentError::EmptyHistogram`] if the law has no such gaps to the precision of `f64`.
    pub fn histogram(&self, longest: usize) -> Result<GapHistogram, AugmentError> {
        check("longest", longest as f64, 1.0, LONGEST as f64)?;
        GapHistogram::new((1..=longest).map(|frames| (frames, self.probability(frames))))
    }

    /// The law that makes these gaps most likely.
    ///
    /// Gaps of known length, of a range of lengths and right-censored ones may be mixed.
    ///
    /// # Errors
    /// [`AugmentError::ZeroLength`], [`AugmentError::Span`] and [`AugmentError::Weight`] for spans that
    /// make no sense, [`AugmentError::TooFewLengths`] if fewer than two different ones have an end.
    ///
    /// ```
    /// use augment::{LengthSpan, LogNormal};
    /// let law = LogNormal::new(1.0, 1.5)?;
    /// let seen: Vec<_> = (1..100)
    ///     .map(|l| LengthSpan::exact(l, law.probability(l)))
    ///     .chain([LengthSpan::at_least(100, law.at_least(100))])
    ///     .collect();
    /// let fit = LogNormal::fit(&seen)?;
    /// assert!((fit.law.mu() - 1.0).abs() < 1e-3 && (fit.law.sigma() - 1.5).abs() < 1e-3);
    /// # Ok::<(), augment::AugmentError>(())
    /// ```
    pub fn fit(gaps: &[LengthSpan]) -> Result<LogNormalFit, AugmentError> {
        gaps.iter().try_for_each(LengthSpan::check)?;
        let gaps: Vec<_> = gaps.iter().filter(|gap| gap.weight > 0.0).copied().collect();
        let ended = gaps.iter().filter_map(|gap| Some((gap.shortest, gap.longest?)));
        let distinct = ended.collect::<BTreeSet<_>>().len();
        if distinct < 2 {
            return Err(AugmentError::TooFewLengths { distinct });
        }
        let weight: f64 = gaps.iter().map(|gap| gap.weight).sum();
        let open = gaps.iter().filter(|gap| gap.longest.is_none());
        let censored = open.fold(0.0, |sum, gap| sum + gap.weight);
        let nats = |[mu, ln_sigma]: [f64; 2]| {
            let sigma = libm::exp(ln_sigma);
            if Self::new(mu, sigma).is_err() {
                return f64::INFINITY;
            }
            let law = Self { mu, sigma };
            gaps.iter().map(|gap| gap.weight / weight * law.nats(gap)).sum()
        };
        // Twice: a simplex that has collapsed off the minimum gets away when it is opened again.
        let (coarse, _, _) = minimise(nats, [1.0, 0.5], [1.0, 0.5], 1e-9);
        let ([mu, ln_sigma], nats_per_gap, termination) = minimise(nats, coarse, [0.1, 0.1], 1e-13);
        let law = Self { mu, sigma: libm::exp(ln_sigma) };
        let termination = if law.is_at_edge() { Termination::Stalled } else { termination };
        Ok(LogNormalFit {
            law,
            nats_per_gap,
            weight,
            censored_share: censored / weight,
            termination,
        })
    }

    fn is_at_edge(&self) -> bool {
        let near = |x: f64, (low, high): (f64, f64)| x < low + 0.01 || x > high - 0.01;
        near(self.mu, MU) || near(self.sigma, SIGMA)
    }

    fn nats(&self, gap: &LengthSpan) -> f64 {
        // 700 nats stand for a span whose probability is too small for `f64`.
        self.ln_span(gap.shortest, gap.longest).map_or(700.0, |ln| -ln)
    }

    /// Logarithm of the probability of the span, where it is positive.
    fn ln_span(&self, shortest: usize, longest: Option<usize>) -> Option<f64> {
        let z = |frames: f64| (libm::log(frames) - self.mu) / self.sigma;
        let low = z(shortest as f64 - 0.5);
        let high = longest.map_or(f64::INFINITY, |frames| z(frames as f64 + 0.5));
        let (span, all) = (normal_between(low, high), normal_between(z(0.5), f64::INFINITY));
        (span > 0.0 && all > 0.0).then(|| libm::log(span) - libm::log(all))
    }
}

impl LengthSpan {
    fn check(&self) -> Result<(), AugmentError> {
        let Self { shortest, longest, weight } = *self;
        if shortest == 0 {
            return Err(AugmentError::ZeroLength);
        }
        if let Some(longest) = longest.filter(|&longest| longest < shortest) {
            return Err(AugmentError::Span { shortest, longest });
        }
        if !(weight.is_finite() && weight >= 0.0) {
            return Err(AugmentError::Weight { frames: shortest, weight });
        }
        Ok(())
    }
}

/// Probability of a standard normal between two bounds, exact in both tails.
fn normal_between(low: f64, high: f64) -> f64 {
    let above = |z: f64| 0.5 * libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2);
    if low > 0.0 { above(low) - above(high) } else { above(-high) - above(-low) }
}
