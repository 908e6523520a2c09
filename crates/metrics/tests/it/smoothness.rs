use metrics::{MetricError, smoothness};
use mocap_core::{Mask, Take};

use crate::{along_x, take};

/// 100 Hz: x = t² / 2 · 2 m/s², plus t³ / 6 · 30 m/s³.
fn truth() -> Take {
    let x = |k: i32| {
        let t = f64::from(k) / 100.0;
        t * t + 5.0 * t.powi(3)
    };
    take(&[along_x(&(0..12).map(x).collect::<Vec<_>>())])
}

#[test]
fn the_truth_has_ratio_one_and_its_own_derivatives() {
    let hidden = Mask::from_fn(12, 1, |t, _| t == 6);
    let same = smoothness(&truth(), &truth(), &hidden).unwrap();
    // Stencils of 3 and 4 frames that hold frame 6.
    assert_eq!((same.acceleration_samples, same.jerk_samples), (3, 4));
    assert!((same.acceleration_ratio - 1.0).abs() < 1e-12 && (same.jerk_ratio - 1.0).abs() < 1e-12);
    // Central differences of a cubic are exact: 2 + 30 t at t = 0.05, 0.06, 0.07.
    let rms = ((3.5_f64.powi(2) + 3.8_f64.powi(2) + 4.1_f64.powi(2)) / 3.0).sqrt();
    // 1e-16 m over (0.01 s)³ is 1e-10 m/s³.
    assert!((same.true_acceleration_rms_m_s2 - rms).abs() < 1e-9);
    assert!((same.jerk_rms_m_s3 - 30.0).abs() < 1e-7);
}

#[test]
fn a_single_jump_by_hand() {
    let still = take(&[along_x(&[0.0; 9]), along_x(&[1.0; 9])]);
    let hidden = Mask::from_fn(9, 2, |t, m| m == 0 && t == 4);
    let jump =
        still.map_positions(|t, m, [x, y, z]| [x + f64::from(u8::from(m == 0 && t == 4)), y, z]);
    let found = smoothness(&still, &jump.unwrap(), &hidden).unwrap();
    // Second differences 1, −2, 1; third 1, −3, 3, −1; at 100 Hz.
    assert!((found.acceleration_rms_m_s2 - 1e4 * 2.0_f64.sqrt()).abs() < 1e-6);
    assert!((found.jerk_rms_m_s3 - 1e6 * 5.0_f64.sqrt()).abs() < 1e-4);
    assert!(found.acceleration_ratio.is_nan(), "the truth stands still");
}

#[test]
fn straight_lines_are_too_smooth() {
    let hidden = Mask::from_fn(12, 1, |t, _| (3..9).contains(&t));
    let (a, b) = (truth().position(2, 0).unwrap()[0], truth().position(9, 0).unwrap()[0]);
    let line = truth().map_positions(|t, _, p| {
        let share = (t as f64 - 2.0) / 7.0;
        if (3..9).contains(&t) { [a + share * (b - a), 0.0, 0.0] } else { p }
    });
    let inner = Mask::from_fn(12, 1, |t, _| t == 5);
    let found = smoothness(&truth(), &line.unwrap(), &inner).unwrap();
    assert!(found.acceleration_ratio < 1e-9);
    let open = truth().hide(&hidden).unwrap();
    let nothing = smoothness(&truth(), &open, &hidden).unwrap();
    assert_eq!((nothing.acceleration_samples, nothing.jerk_samples), (0, 0));
    assert!(nothing.acceleration_ratio.is_nan() && nothing.jerk_rms_m_s3.is_nan());
}

#[test]
fn short_takes_and_empty_masks() {
    let two = take(&[along_x(&[0.0, 1.0])]);
    let found = smoothness(&two, &two, &Mask::all(2, 1)).unwrap();
    assert_eq!((found.acceleration_samples, found.jerk_samples), (0, 0));
    assert_eq!(smoothness(&two, &two, &Mask::none(2, 1)), Err(MetricError::NoHiddenCell));
}
