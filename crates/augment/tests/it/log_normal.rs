use augment::{AugmentError, GapHistogram, LengthSpan, LogNormal};
use mocap_core::Termination;
use proptest::prelude::*;

#[test]
fn probabilities_are_differences_of_the_tail() {
    for (mu, sigma) in [(0.85, 2.721), (-0.561, 2.358), (3.0, 0.2)] {
        let law = LogNormal::new(mu, sigma).unwrap();
        assert_eq!(law.at_least(1), 1.0);
        let sum: f64 = (1..500).map(|l| law.probability(l)).sum();
        // Rounding of 500 additions.
        assert!((sum + law.at_least(500) - 1.0).abs() < 1e-12);
        assert_eq!(law.probability(0), 0.0);
    }
}

#[test]
fn the_median_of_long_gaps_is_the_exponential_of_mu() {
    // Far from 1 frame, half a frame of rounding and the cut at ½ do not matter.
    let law = LogNormal::new(6.0, 0.5).unwrap();
    // One frame there holds 0.002 of the gaps.
    assert!((law.at_least(403) - 0.5).abs() < 0.002, "e⁶ is 403.4");
}

#[test]
fn the_far_tail_keeps_its_digits() {
    let law = LogNormal::new(0.0, 0.2).unwrap();
    let (near, far) = (law.at_least(3), law.at_least(4));
    assert!(near > 0.0 && far > 0.0 && far < 1e-3 * near);
    assert!((law.probability(3) - (near - far)).abs() < 1e-12 * near);
}

#[test]
fn lengths_in_one_or_two_bins_are_fitted_as_far_as_they_go() {
    // All of the mass in two bins: as many parameters as data, so the fit reproduces them.
    let fit = LogNormal::fit(&[LengthSpan::exact(7, 30.0), LengthSpan::exact(8, 70.0)]).unwrap();
    assert!((fit.law.probability(7) - 0.3).abs() < 0.01, "{fit:?}");
    assert!((fit.law.probability(8) - 0.7).abs() < 0.01, "{fit:?}");
}

#[test]
fn a_fit_without_a_best_law_says_so() {
    // Nearly all at 1, one very long: the likelihood rises as mu falls and sigma grows.
    let gaps = [LengthSpan::exact(1, 1e6), LengthSpan::exact(100_000, 1.0)];
    let fit = LogNormal::fit(&gaps).unwrap();
    assert!(fit.nats_per_gap.is_finite());
    assert!(fit.law.mu() < -5.0 || fit.termination == Termination::Stalled, "{fit:?}");
}

#[test]
fn fits_refuse_what_makes_no_sense() {
    let fit = |gaps: &[LengthSpan]| LogNormal::fit(gaps).unwrap_err();
    assert_eq!(fit(&[]), AugmentError::TooFewLengths { distinct: 0 });
    let one = [LengthSpan::exact(3, 9.0), LengthSpan::at_least(9, 1.0), LengthSpan::exact(5, 0.0)];
    assert_eq!(fit(&one), AugmentError::TooFewLengths { distinct: 1 });
    assert_eq!(fit(&[LengthSpan::exact(0, 1.0)]), AugmentError::ZeroLength);
    let backwards = LengthSpan { shortest: 5, longest: Some(4), weight: 1.0 };
    assert_eq!(fit(&[backwards]), AugmentError::Span { shortest: 5, longest: 4 });
    assert!(matches!(fit(&[LengthSpan::exact(2, -1.0)]), AugmentError::Weight { frames: 2, .. }));
    assert!(matches!(fit(&[LengthSpan::exact(2, f64::NAN)]), AugmentError::Weight { .. }));
}

#[test]
fn histograms_refuse_what_makes_no_sense() {
    assert_eq!(GapHistogram::new([]), Err(AugmentError::EmptyHistogram));
    assert_eq!(GapHistogram::new([(3, 0.0)]), Err(AugmentError::EmptyHistogram));
    assert_eq!(GapHistogram::new([(0, 1.0)]), Err(AugmentError::ZeroLength));
    assert!(matches!(GapHistogram::new([(1, -1.0)]), Err(AugmentError::Weight { .. })));
    assert!(GapHistogram::new([(1, f64::INFINITY)]).is_err());
    let huge = GapHistogram::new([(1, f64::MAX), (2, f64::MAX)]).unwrap();
    assert_eq!(huge.probability(2), 0.5);
    assert_eq!(huge.clipped(3, 9), Err(AugmentError::EmptyHistogram));
    assert!(LogNormal::new(0.0, 1.0).unwrap().histogram(0).is_err());
    assert!(LogNormal::new(0.0, 1.0).unwrap().histogram(usize::MAX).is_err());
    assert!(LogNormal::new(f64::NAN, 1.0).is_err() && LogNormal::new(0.0, 0.0).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_fit_finds_the_law_behind_exact_counts(
        mu in -1.0..4.0_f64, sigma in 0.4..3.0_f64, cut in 20..400_usize,
    ) {
        let law = LogNormal::new(mu, sigma).unwrap();
        let mut gaps: Vec<_> =
            (1..cut).map(|l| LengthSpan::exact(l, law.probability(l))).collect();
        gaps.push(LengthSpan::at_least(cut, law.at_least(cut)));
        let fit = LogNormal::fit(&gaps).unwrap();
        // The search stops where the likelihood no longer tells laws apart, at about 1e-6.
        prop_assert!((fit.law.mu() - mu).abs() < 1e-3 * (1.0 + mu.abs()), "{:?}", fit);
        prop_assert!((fit.law.sigma() - sigma).abs() < 1e-3 * sigma, "{:?}", fit);
        prop_assert_eq!(fit.termination, Termination::Converged);
    }

    #[test]
    fn histograms_are_distributions(weights in prop::collection::vec((1..500_usize, 0.0..9.0), 1..40)) {
        prop_assume!(weights.iter().any(|w| w.1 > 0.0));
        let gaps = GapHistogram::new(weights).unwrap();
        let sum: f64 = gaps.bins().iter().map(|bin| bin.1).sum();
        prop_assert!((sum - 1.0).abs() < 1e-12);
        prop_assert!(gaps.bins().is_sorted_by(|a, b| a.0 < b.0));
        prop_assert!(gaps.mean_frames() <= gaps.longest_frames() as f64 + 1e-9);
    }
}
