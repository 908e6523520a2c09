use mocap_core::{Bone, BoneRule, BoneSet, CoreError, MarkerKnowledge, RigidPairs};

use crate::take;

#[test]
fn wrong_bones_are_refused() {
    assert_eq!(Bone::new(3, 3, 1.0), Err(CoreError::SelfBone { marker: 3 }));
    for length in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(Bone::new(0, 1, length), Err(CoreError::BoneLength { .. })));
    }
    let twice = [Bone::new(1, 0, 0.3).unwrap(), Bone::new(0, 1, 0.4).unwrap()];
    assert_eq!(BoneSet::new(twice), Err(CoreError::DuplicateBone { a: 0, b: 1 }));
}

#[test]
fn lengths_come_from_visible_samples_alone() {
    // The pair is 0.3 m apart while seen, and would be 0.9 m apart where it is hidden.
    let truth = take(10, 2, |t, m| Some([if t < 6 { 0.3 } else { 0.9 } * m as f64, 0.0, 0.0]));
    let hidden = mocap_core::Mask::from_fn(10, 2, |t, m| t >= 6 && m == 1);
    let visible = truth.hide(&hidden).unwrap();
    let bones = BoneSet::estimate(&visible, &BoneRule::Pairs(vec![(1, 0)])).unwrap();
    assert_eq!(bones.bones()[0].markers(), (0, 1));
    assert!((bones.bones()[0].length_m() - 0.3).abs() < 1e-15);
}

#[test]
fn pairs_never_seen_together_give_no_bone() {
    let input = take(4, 2, |t, m| (t % 2 == m).then_some([m as f64, 0.0, 0.0]));
    let bones = BoneSet::estimate(&input, &BoneRule::Pairs(vec![(0, 1)])).unwrap();
    assert!(bones.is_empty());
    let error = BoneSet::estimate(&input, &BoneRule::Pairs(vec![(0, 2)])).unwrap_err();
    assert!(matches!(error, CoreError::OutOfRange { marker: 2, .. }));
}

#[test]
fn rigid_pairs_are_found_and_moving_ones_are_not() {
    // Markers 0 and 1 stay 0.2 m apart, marker 2 swings away by 0.3 m.
    let input = take(50, 3, |t, m| {
        let t = t as f64 / 10.0;
        Some(match m {
            0 => [t, 0.0, 1.0],
            1 => [t, 0.2, 1.0],
            _ => [t + 0.3 * t.sin(), 0.1, 0.8],
        })
    });
    let bones = BoneSet::estimate(&input, &BoneRule::Rigid(RigidPairs::default())).unwrap();
    assert_eq!(bones.len(), 1);
    assert_eq!(bones.bones()[0].markers(), (0, 1));
    assert!(bones.check(&input.select(&[0]).unwrap()).is_err());
}

#[test]
fn known_pairs_come_before_rigid_ones() {
    // Markers 0 and 1 are rigid; the known set names 1 and 2, which swing.
    let input = take(50, 3, |t, m| {
        let swing = 0.05 * (t as f64 / 8.0).sin();
        Some([[0.0; 3], [0.2, 0.0, 0.0], [0.5 + swing, 0.0, 0.0]][m])
    });
    let text = "marker m1\nmarker m2\nbone m1 m2";
    let known = MarkerKnowledge::parse(text, "pair").unwrap();
    let bones = BoneSet::estimate(&input, &BoneRule::Known(vec![known])).unwrap();
    assert_eq!(bones.bones().iter().map(Bone::markers).collect::<Vec<_>>(), [(1, 2)]);
    let foreign = MarkerKnowledge::cmu_41();
    let bones = BoneSet::estimate(&input, &BoneRule::Known(vec![foreign])).unwrap();
    assert_eq!(bones.bones().iter().map(Bone::markers).collect::<Vec<_>>(), [(0, 1)]);
}
