use metrics::{Calibration, MetricError, calibration, calibration_by_gap_length};
use mocap_core::{Estimates, FillReport, Filled, Mask, Take, Termination};
use ndarray::Array2;
use rand::{RngExt as _, SeedableRng as _};

use crate::{along_x, assert_mm, take};

/// Fills each hidden cell with the truth moved along x by `error_m`, and states `sigma_m`.
fn filled(
    truth: &Take,
    hidden: &Mask,
    mut error_m: impl FnMut(usize, usize) -> f64,
    sigma_m: impl Fn(usize, usize) -> f64,
) -> Filled {
    let moved = truth.map_positions(|t, m, [x, y, z]| [x + error_m(t, m), y, z]).unwrap();
    let sigma_m =
        Array2::from_shape_fn((truth.frames(), truth.marker_count()), |(t, m)| sigma_m(t, m));
    let estimates = Estimates { positions: moved.positions().to_owned(), sigma_m: Some(sigma_m) };
    let report = FillReport::new("test", Termination::ClosedForm);
    Filled::merge(&truth.hide(hidden).unwrap(), estimates, report).unwrap()
}

fn truth() -> Take {
    take(&[along_x(&[0.0; 8]), along_x(&[1.0; 8])])
}

#[test]
fn shares_by_hand() {
    // Frames 1 to 4: errors 1, 2, 3 and 0 mm at 2 mm; frame 5: no sigma; frame 6 of marker 1: 0 mm at 0.
    let hidden = Mask::from_fn(8, 2, |t, m| if m == 0 { (1..6).contains(&t) } else { t == 6 });
    let errors = [0.0, 0.001, 0.002, 0.003, 0.0, 0.5, 0.0, 0.0];
    let fill = filled(
        &truth(),
        &hidden,
        |t, m| if m == 0 { errors[t] } else { 0.0 },
        |t, m| {
            if m == 1 {
                0.0
            } else if t == 5 {
                f64::NAN
            } else {
                0.002
            }
        },
    );
    let found = calibration(&truth(), &fill, &hidden, &[0.5, 1.0, 2.0]).unwrap();
    assert_eq!((found.samples, found.without_sigma), (5, 1));
    let counts: Vec<usize> = found.within.iter().map(|level| level.samples).collect();
    // Both exact ones lie within anything. 2 mm is 1 σ up to the rounding of 1.0 + 0.002.
    assert_eq!(counts, [3, 4, 5]);
    assert_eq!(found.share_within(2.0), Some(1.0));
    assert_eq!(found.share_within(3.0), None);
    assert_mm(found.mean_sigma_mm().unwrap(), 1.6);
    assert_mm(found.rms_ratio().unwrap(), ((0.25 + 1.0 + 2.25) / 5.0_f64).sqrt());
    let by_length = calibration_by_gap_length(&truth(), &fill, &hidden, &[1.0], &[0.02]).unwrap();
    assert_eq!(by_length.iter().map(|class| class.samples).collect::<Vec<_>>(), [1, 4]);
}

#[test]
fn a_normal_law_is_honest() {
    // 4000 errors along one axis with the stated deviation: a standard error of 0.7 %.
    let truth = take(&[along_x(&vec![0.0; 4002])]);
    let hidden = Mask::from_fn(4002, 1, |t, _| t > 0 && t < 4001);
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
    // Twelve uniform numbers less their mean are normal to well below that.
    let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
    let fill = filled(&truth, &hidden, |_, _| 0.01 * normal(), |_, _| 0.01);
    let multiples = [0.5, 1.0, 1.5, 2.0];
    let found = calibration(&truth, &fill, &hidden, &multiples).unwrap();
    for multiple in multiples {
        let (share, nominal) =
            (found.share_within(multiple).unwrap(), Calibration::nominal_share(multiple));
        assert!((share - nominal).abs() < 0.025, "{multiple}: {share} for {nominal}");
    }
    assert!((found.rms_ratio().unwrap() - 1.0).abs() < 0.05);
    assert!((Calibration::nominal_share(1.0) - 0.682_689).abs() < 1e-6);
    assert!((Calibration::nominal_share(2.0) - 0.954_500).abs() < 1e-6);
    assert_eq!(Calibration::nominal_share(-1.0), 0.0);
}

#[test]
fn takes_add_up() {
    let hidden = Mask::from_fn(8, 2, |t, m| m == 0 && (1..4).contains(&t));
    let fill = |error| filled(&truth(), &hidden, move |_, _| error, |_, _| 0.002);
    let count =
        |error, multiples: &[f64]| calibration(&truth(), &fill(error), &hidden, multiples).unwrap();
    let mut all = Calibration::default();
    all.merge(&count(0.001, &[1.0])).unwrap();
    all.merge(&count(0.003, &[1.0])).unwrap();
    assert_eq!((all.samples, all.share_within(1.0)), (6, Some(0.5)));
    assert_eq!(all.merge(&count(0.001, &[2.0])), Err(MetricError::Multiples));
    assert_eq!(
        (Calibration::default().mean_sigma_mm(), Calibration::default().rms_ratio()),
        (None, None)
    );
}

#[test]
fn nothing_hidden_is_refused() {
    let hidden = Mask::none(8, 2);
    let fill = filled(&truth(), &hidden, |_, _| 0.0, |_, _| 0.001);
    assert_eq!(calibration(&truth(), &fill, &hidden, &[1.0]), Err(MetricError::NoHiddenCell));
    let all = Mask::all(8, 1);
    assert!(matches!(
        calibration_by_gap_length(&truth(), &fill, &all, &[1.0], &[0.1]),
        Err(MetricError::Shape { .. })
    ));
}
