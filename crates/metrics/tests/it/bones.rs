use metrics::{MetricError, bone_deviation, per_bone};
use mocap_core::{Bone, BoneSet, CoreError, Mask, Take};

use crate::{along_x, assert_mm, take};

/// Marker 0 rests at the origin, marker 1 drifts away from 1 m, marker 2 is seen in the last frame.
fn drifting() -> Take {
    let nan = f64::NAN;
    take(&[along_x(&[0.0; 3]), along_x(&[1.0, 1.002, 0.996]), along_x(&[nan, nan, 2.0])])
}

fn bones() -> BoneSet {
    BoneSet::new([Bone::new(0, 1, 1.0).unwrap(), Bone::new(1, 2, 1.0).unwrap()]).unwrap()
}

#[test]
fn deviations_by_hand() {
    // 0, 2, 4 mm on the first bone; 4 mm in the one frame that shows the second.
    let all = bone_deviation(&drifting(), &bones(), None).unwrap();
    assert_eq!(all.samples, 4);
    assert_mm(all.mean_mm, 2.5);
    assert_mm(all.rms_mm, 3.0);
    assert_mm(all.max_mm, 4.0);
    let each = per_bone(&drifting(), &bones(), None).unwrap();
    assert_eq!(each.iter().map(|(_, d)| d.samples).collect::<Vec<_>>(), [3, 1]);
    assert_mm(each[0].1.mean_mm, 2.0);
    assert_mm(each[1].1.mean_mm, 4.0);
}

#[test]
fn a_mask_narrows_to_bones_that_touch_it() {
    let cells = Mask::from_fn(3, 3, |t, m| (t, m) == (1, 0));
    let touched = bone_deviation(&drifting(), &bones(), Some(&cells)).unwrap();
    assert_eq!(touched.samples, 1);
    assert_mm(touched.mean_mm, 2.0);
}

#[test]
fn no_sample_is_nan_not_zero() {
    let nothing = bone_deviation(&drifting(), &BoneSet::default(), None).unwrap();
    assert_eq!(nothing.samples, 0);
    assert!(nothing.mean_mm.is_nan() && nothing.rms_mm.is_nan() && nothing.max_mm.is_nan());
}

#[test]
fn foreign_bones_and_masks_are_refused() {
    let far = BoneSet::new([Bone::new(0, 7, 1.0).unwrap()]).unwrap();
    assert!(matches!(
        bone_deviation(&drifting(), &far, None),
        Err(MetricError::Core(CoreError::OutOfRange { marker: 7, .. }))
    ));
    assert!(matches!(
        per_bone(&drifting(), &bones(), Some(&Mask::all(3, 2))),
        Err(MetricError::Shape { what: "the cell mask", found_markers: 2, .. })
    ));
}
