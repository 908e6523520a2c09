use augment::{AugmentError, PerFrameParams, hide_per_frame};

use crate::{take, take_seen};

#[test]
fn the_baseline_hides_as_much_as_published_and_no_long_gaps() {
    let holdout = hide_per_frame(&take(20_000, 20), &PerFrameParams::default()).unwrap();
    let share = holdout.hidden().count() as f64 / 400_000.0;
    // 20 000 frames whose probability has a deviation of 0.055: a standard error of 0.0004.
    assert!((share - 0.0781).abs() < 0.002, "{share}");
    // A frame hides a marker with at most 0.2: among 30 000 gaps one of 10 is due 0.0003 times.
    let longest = holdout.visible().gaps().iter().map(mocap_core::Gap::len).max();
    assert!((4..10).contains(&longest.unwrap()), "{longest:?}");
}

#[test]
fn only_observed_cells_are_hidden_and_seeds_decide() {
    let take = take_seen(400, 5, |t, m| (t + m) % 3 != 0);
    let draw = |seed| {
        let params = PerFrameParams { seed, ..PerFrameParams::default() };
        hide_per_frame(&take, &params).unwrap().hidden().clone()
    };
    assert!(draw(1).iter().all(|(t, m)| take.is_observed(t, m)));
    assert_eq!(draw(1), draw(1));
    assert_ne!(draw(1), draw(2));
}

#[test]
fn the_baseline_refuses_what_makes_no_sense() {
    for deviation in [-0.1, 1.1, f64::NAN] {
        let params = PerFrameParams { deviation, seed: 0 };
        let refused = hide_per_frame(&take(5, 2), &params).unwrap_err();
        assert!(matches!(refused, AugmentError::OutOfRange { name: "deviation", .. }));
    }
    let empty = hide_per_frame(&take(0, 2), &PerFrameParams::default()).unwrap_err();
    assert_eq!(empty, AugmentError::EmptyTake { frames: 0, markers: 2 });
    let all = PerFrameParams { deviation: 0.0, seed: 0 };
    assert_eq!(hide_per_frame(&take(50, 2), &all).unwrap().hidden().count(), 0);
}
