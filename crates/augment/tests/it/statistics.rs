use augment::{AugmentError, GapSampler, GapSamplerParams, GapStatistics, LengthCount, LogNormal};
use mocap_core::{MarkerSet, Mask, Take};
use ndarray::Array3;

use crate::{model, take, take_seen};

#[test]
fn gaps_are_counted_by_hand() {
    // M0: gap of 2 inside. M1: cut at both ends. M2: never worn. M3: complete.
    let seen = |t: usize, m: usize| match m {
        0 => !(3..5).contains(&t),
        1 => (2..9).contains(&t),
        2 => false,
        _ => true,
    };
    let statistics = GapStatistics::from_takes([take_seen(10, 4, seen)]).unwrap();
    let counted: Vec<_> =
        statistics.markers().iter().map(|m| (m.worn_frames, m.missing_frames, m.gaps)).collect();
    assert_eq!(counted, [(10, 2, 1), (10, 3, 2), (0, 0, 0), (10, 0, 0)]);
    let lengths =
        [LengthCount { frames: 1, whole: 0, cut: 1 }, LengthCount { frames: 2, whole: 1, cut: 1 }];
    assert_eq!(statistics.lengths(), lengths);
    assert_eq!(statistics.occlusion(), 5.0 / 30.0);
    assert_eq!(statistics.histogram().unwrap().probability(2), 2.0 / 3.0);
    assert_eq!(statistics.rate_hz(), 120.0);
}

#[test]
fn subjects_and_takes_pool_by_bare_name() {
    let worn = |names: [&str; 2]| {
        let mut xyz = Array3::zeros((4, 2, 3));
        xyz[(1, 0, 0)] = f64::NAN;
        Take::from_positions(MarkerSet::new(names).unwrap(), 120.0, xyz).unwrap()
    };
    let takes = [worn(["jane:C7", "joe:C7"]), worn(["T10", "C7"])];
    let statistics = GapStatistics::from_takes(&takes).unwrap();
    let names: Vec<_> = statistics.markers().iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["C7", "T10"]);
    assert_eq!(statistics.markers()[0].probability(), 1.0 / 12.0);
    assert_eq!(statistics.markers()[1].probability(), 0.25);
}

#[test]
fn takes_that_do_not_fit_are_refused() {
    let none: [Take; 0] = [];
    assert_eq!(GapStatistics::from_takes(none), Err(AugmentError::NoTakes));
    let slow = Take::new(crate::names(1), 60.0, Array3::zeros((5, 1, 3)), Mask::all(5, 1)).unwrap();
    let mixed = GapStatistics::from_takes([take(5, 1), slow]);
    assert_eq!(mixed, Err(AugmentError::MixedRates { first_hz: 120.0, other_hz: 60.0 }));
    let complete = GapStatistics::from_takes([take(5, 1)]).unwrap();
    assert_eq!(complete.occlusion(), 0.0);
    assert_eq!(complete.model(), Err(AugmentError::EmptyHistogram));
    assert_eq!(complete.fit(), Err(AugmentError::TooFewLengths { distinct: 0 }));
}

#[test]
fn an_empty_take_is_refused() {
    let empty = AugmentError::EmptyTake { frames: 0, markers: 3 };
    assert_eq!(GapStatistics::from_takes([take(9, 3), take(0, 3)]), Err(empty));
}

/// A long mask is cut into short takes: half of the gaps touch an end, and recorded lengths are far
/// too short; the fit still finds the law.
#[test]
fn censoring_undoes_the_cuts_of_short_takes() {
    let law = LogNormal::new(2.5, 0.9).unwrap();
    let params = GapSamplerParams { occlusion: 0.3, ..GapSamplerParams::default() };
    let sampler = GapSampler::new(model(1, law.histogram(600).unwrap()), params).unwrap();
    let (frames, window) = (600_000, 60);
    let hidden = sampler.draw(&crate::names(1), &Mask::all(frames, 1), None).unwrap().hidden;
    let takes = (0..frames / window)
        .map(|k| take_seen(window, 1, |t, _| !hidden.contains(k * window + t, 0)));
    let statistics = GapStatistics::from_takes(takes).unwrap();
    let cut: u64 = statistics.lengths().iter().map(|count| count.cut).sum();
    let all: u64 = cut + statistics.lengths().iter().map(|count| count.whole).sum::<u64>();
    assert!(cut as f64 > 0.3 * all as f64, "{cut} of {all} are cut");
    let fit = statistics.fit().unwrap().law;
    // 9000 gaps: the standard error of mu is 0.9/√9000 ≈ 0.01, and as much of sigma; five of them.
    assert!((fit.mu() - 2.5).abs() < 0.05 && (fit.sigma() - 0.9).abs() < 0.05, "{fit:?}");
    let recorded = statistics.histogram().unwrap().mean_frames();
    let true_mean = law.histogram(600).unwrap().mean_frames();
    assert!(recorded < 0.8 * true_mean, "{recorded} against {true_mean}: the test has no teeth");
}
