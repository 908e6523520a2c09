use augment::{
    AugmentError, Limb, Preset, blackout, hide_segment, limb, one_segment, random_segment,
};
use mocap_core::{MarkerKnowledge, MarkerSet, Take};
use ndarray::Array3;
use proptest::prelude::*;

use crate::{take, take_seen};

fn named(names: &[&str]) -> Take {
    let set = MarkerSet::new(names.iter().copied()).unwrap();
    Take::from_positions(set, 120.0, Array3::zeros((40, names.len(), 3))).unwrap()
}

#[test]
fn one_segment_hides_one_marker_once() {
    let take = named(&["jane:RKNE", "jane:RTHI", "joe:RTHI"]);
    let holdout = one_segment(&take, "RKNE", 10..30).unwrap();
    let gaps = holdout.visible().gaps();
    assert_eq!(
        gaps.iter().map(|g| (g.marker, g.frames.clone())).collect::<Vec<_>>(),
        [(0, 10..30)]
    );
    assert!(matches!(one_segment(&take, "RTHI", 10..30), Err(AugmentError::Core(_))));
    assert!(matches!(one_segment(&take, "LTHI", 10..30), Err(AugmentError::Core(_))));
}

#[test]
fn limbs_know_the_markers_of_the_sets() {
    let cmu = MarkerKnowledge::cmu_41();
    let set = MarkerSet::new(cmu.markers().iter().cloned()).unwrap();
    let names =
        |limb: Limb| -> Vec<&str> { limb.markers(&set).into_iter().map(|m| set.name(m)).collect() };
    assert_eq!(names(Limb::RightArm), ["RUPA", "RELB", "RFRM", "RWRA", "RWRB", "RFIN"]);
    assert_eq!(names(Limb::LeftLeg), ["LTHI", "LKNE", "LSHN", "LANK", "LHEE", "LMT5", "LTOE"]);
    for (preset, each) in [(Preset::FrontWaist, [8, 8, 9, 9]), (Preset::Production, [8, 8, 9, 9])] {
        let set = MarkerSet::new(preset.markers().map(|marker| marker.0)).unwrap();
        let found = Limb::ALL.map(|limb| limb.markers(&set).len());
        assert_eq!(found, each, "{preset}");
    }
}

#[test]
fn a_limb_is_hidden_on_one_subject() {
    let take = named(&["C7", "joe:RKNE", "jane:RKNE", "jane:RANK", "joe:RFWT"]);
    let holdout = limb(&take, Limb::RightLeg, 3..9).unwrap();
    assert!(holdout.hidden().iter().eq((3..9).flat_map(|t| [(t, 2), (t, 3)])));
    let equals = named(&["joe:LTOE", "jane:LTOE"]);
    assert_eq!(Limb::LeftLeg.markers(equals.markers()), [1], "of equals the first by name");
    assert_eq!(
        limb(&take, Limb::LeftArm, 3..9).unwrap_err(),
        AugmentError::NoLimb { limb: "left arm" }
    );
}

#[test]
fn a_blackout_hides_all() {
    let holdout = blackout(&take(50, 3), 10..40).unwrap();
    assert_eq!(holdout.hidden().count(), 90);
    assert!((10..40).all(|t| holdout.visible().observed().frame(t).iter().all(|seen| !seen)));
}

#[test]
#[expect(clippy::reversed_empty_ranges, reason = "an empty range is what is refused")]
fn segments_that_hide_nothing_are_refused() {
    let take = take_seen(20, 3, |t, m| m != 1 || t < 5);
    let outside = |start, end| AugmentError::Segment { start, end, frames: 20 };
    assert_eq!(blackout(&take, 5..5).unwrap_err(), outside(5, 5));
    assert_eq!(blackout(&take, 9..3).unwrap_err(), outside(9, 3));
    assert_eq!(blackout(&take, 15..21).unwrap_err(), outside(15, 21));
    let nothing = AugmentError::NothingToHide { start: 5, end: 9 };
    assert_eq!(hide_segment(&take, &[1], 5..9).unwrap_err(), nothing);
    assert_eq!(hide_segment(&take, &[], 5..9).unwrap_err(), nothing);
    assert!(matches!(hide_segment(&take, &[3], 5..9), Err(AugmentError::Core(_))));
    let empty = AugmentError::EmptyTake { frames: 0, markers: 2 };
    assert_eq!(blackout(&crate::take(0, 2), 0..1).unwrap_err(), empty);
    assert_eq!(random_segment(&crate::take(0, 2), 1, 1..=1, 0).unwrap_err(), empty);
    let too_many = AugmentError::MarkerCount { wanted: 4, found: 3 };
    assert_eq!(random_segment(&take, 4, 20..=20, 0).unwrap_err(), too_many);
    assert!(matches!(random_segment(&take, 0, 1..=9, 0), Err(AugmentError::MarkerCount { .. })));
    for lengths in [0..=3, 5..=3, 1..=21] {
        let refused = random_segment(&take, 1, lengths, 0).unwrap_err();
        assert!(matches!(refused, AugmentError::OutOfRange { .. }));
    }
}

#[test]
fn random_segments_reach_every_marker_length_and_end() {
    let take = take(6, 4);
    let gaps: Vec<_> = (0..400)
        .map(|seed| random_segment(&take, 1, 1..=6, seed).unwrap().visible().gaps().remove(0))
        .collect();
    for length in 1..=6 {
        // 400 draws of 1 in 6: 67 ± 7.5; five deviations.
        let count = gaps.iter().filter(|gap| gap.len() == length).count();
        assert!((29..105).contains(&count), "{length}: {count}");
    }
    assert!((0..4).all(|m| gaps.iter().filter(|gap| gap.marker == m).count() > 60));
    assert!(gaps.iter().any(|gap| gap.len() < 6 && gap.frames.end == 6));
    assert!(gaps.iter().any(|gap| gap.len() < 6 && gap.frames.start == 0));
}

proptest! {
    #[test]
    fn random_segments_hide_what_was_asked_for(
        seed in any::<u64>(), markers in 1..=5_usize, length in 1..=30_usize,
    ) {
        let take = take_seen(30, 6, |_, m| m != 2);
        let holdout = random_segment(&take, markers, length..=length, seed).unwrap();
        prop_assert_eq!(holdout.hidden().count(), markers * length);
        let again = random_segment(&take, markers, length..=length, seed).unwrap();
        prop_assert_eq!(holdout.hidden(), again.hidden());
    }
}
