use metrics::{MetricError, mse, per_gap, quantile, score};
use mocap_core::{Gap, Holdout, Mask, Take};

use crate::{along_x, assert_mm, take};

const NAN: f64 = f64::NAN;

fn truth() -> Take {
    take(&[along_x(&[0.0; 6]), along_x(&[1.0; 6])])
}

/// Marker 0 hidden in frames 1 to 4.
fn hidden() -> Mask {
    Mask::from_fn(6, 2, |t, m| m == 0 && (1..5).contains(&t))
}

/// Off by (3, 4, 0), (0, 0, 10) and (1, 2, 2) mm; frame 4 stays open.
fn filled() -> Take {
    let z = [0.0; 3];
    let column = vec![z, [0.003, 0.004, 0.0], [0.0, 0.0, 0.01], [0.001, 0.002, 0.002], [NAN; 3], z];
    take(&[column, along_x(&[1.0; 6])])
}

#[test]
fn mse_follows_its_equation_by_hand() {
    let holdout = Holdout::new(truth(), &hidden()).unwrap();
    let result = mse(&holdout, &filled()).unwrap();
    // (25 + 100 + 9) mm² over nine coordinates.
    assert!((result.mse_m2 - 134e-6 / 9.0).abs() < 1e-18);
    assert_eq!((result.hidden_cells, result.unfilled_cells), (4, 1));
}

#[test]
fn score_by_hand() {
    let s = score(&truth(), &filled(), &hidden()).unwrap();
    assert_mm(s.mean_mm, 6.0);
    assert_mm(s.median_mm, 5.0);
    // Type 7: h = 2 · 0.95 = 1.9, so 5 + 0.9 · (10 − 5).
    assert_mm(s.p95_mm, 9.5);
    assert_mm(s.max_mm, 10.0);
    assert_mm(s.rms_mm, (134.0_f64 / 3.0).sqrt());
    assert_eq!((s.hidden_cells, s.unfilled_cells, s.truthless_cells), (4, 1, 0));
}

#[test]
fn cells_outside_the_mask_have_no_part() {
    let mut off = filled();
    off = off.map_positions(|t, m, p| if m == 1 || t == 0 { [9.0; 3] } else { p }).unwrap();
    let (a, b) = (score(&truth(), &off, &hidden()), score(&truth(), &filled(), &hidden()));
    assert_eq!(a.unwrap(), b.unwrap());
}

#[test]
fn each_gap_has_its_own_score() {
    let hidden = Mask::from_fn(6, 2, |t, m| if m == 0 { t == 1 || t == 2 } else { t == 5 });
    let gaps = per_gap(&truth(), &filled(), &hidden).unwrap();
    let expected = [(Gap { marker: 0, frames: 1..3 }, 7.5), (Gap { marker: 1, frames: 5..6 }, 0.0)];
    assert_eq!(gaps.len(), 2);
    for (found, (gap, mean_mm)) in gaps.iter().zip(expected) {
        assert_eq!(found.gap, gap);
        assert_mm(found.score.mean_mm, mean_mm);
    }
}

#[test]
fn nothing_filled_is_nan_and_counted() {
    let open = truth().hide(&hidden()).unwrap();
    let s = score(&truth(), &open, &hidden()).unwrap();
    assert!(
        [s.mse_m2, s.mean_mm, s.rms_mm, s.median_mm, s.p95_mm, s.max_mm].iter().all(|v| v.is_nan())
    );
    assert_eq!((s.hidden_cells, s.unfilled_cells), (4, 4));
}

#[test]
fn hidden_cells_without_truth_are_counted_apart() {
    let truth = truth().hide(&Mask::from_fn(6, 2, |t, m| m == 0 && t == 2)).unwrap();
    let s = score(&truth, &filled(), &hidden()).unwrap();
    assert_eq!((s.hidden_cells, s.unfilled_cells, s.truthless_cells), (3, 1, 1));
    assert_mm(s.mean_mm, 4.0);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let none = Mask::none(6, 2);
    assert_eq!(score(&truth(), &filled(), &none).unwrap_err(), MetricError::NoHiddenCell);
    let narrow = Mask::all(6, 1);
    assert!(matches!(
        score(&truth(), &filled(), &narrow),
        Err(MetricError::Shape { what: "the hidden mask", found_markers: 1, .. })
    ));
    let short = take(&[along_x(&[0.0; 5]), along_x(&[0.0; 5])]);
    let error = score(&truth(), &short, &hidden()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the filled take has 5 frames × 2 markers, but the take it is measured against has 6 × 2"
    );
    let swapped = filled().select(&[1, 0]).unwrap();
    assert_eq!(
        score(&truth(), &swapped, &hidden()).unwrap_err(),
        MetricError::Markers { index: 0, expected: "M0".into(), found: "M1".into() }
    );
}

#[test]
fn quantiles_of_type_seven() {
    let x = [1.0, 2.0, 4.0, 8.0];
    for (p, q) in [(-1.0, 1.0), (0.0, 1.0), (0.25, 1.75), (0.5, 3.0), (0.9, 6.8), (1.0, 8.0)] {
        assert!((quantile(&x, p).unwrap() - q).abs() < 1e-12, "{p}");
    }
    assert_eq!(quantile(&[5.0], 0.95), Some(5.0));
    assert_eq!(quantile(&x, 7.0), Some(8.0));
}
