use metrics::{MetricError, by_gap_length, gap_length_classes, per_gap, score};
use mocap_core::Mask;
use proptest::prelude::*;

use crate::{along_x, assert_mm, take};

/// Marker 0 misses frames 1 to 2, marker 1 frame 3, marker 2 frames 0 to 9.
fn hidden() -> Mask {
    Mask::from_fn(20, 3, |t, m| match m {
        0 => t == 1 || t == 2,
        1 => t == 3,
        _ => t < 10,
    })
}

#[test]
fn classes_hold_their_upper_edge() {
    // 100 Hz: gaps of 0.02, 0.01 and 0.1 s.
    let classes = gap_length_classes(&hidden(), 100.0, &[0.02, 0.05, 0.1]).unwrap();
    let markers: Vec<Vec<usize>> =
        classes.iter().map(|gaps| gaps.iter().map(|gap| gap.marker).collect()).collect();
    assert_eq!(markers, [vec![0, 1], vec![], vec![2], vec![]]);
}

#[test]
fn errors_by_length_by_hand() {
    let truth = take(&[along_x(&[0.0; 20]), along_x(&[1.0; 20]), along_x(&[2.0; 20])]);
    // Off by 2, 6 and 10 mm; marker 2 stays open in frames 0 to 4.
    let off = truth.map_positions(|_, m, [x, y, z]| [x + [0.002, 0.006, 0.01][m], y, z]).unwrap();
    let off = off.hide(&Mask::from_fn(20, 3, |t, m| m == 2 && t < 5)).unwrap();
    let classes = by_gap_length(&truth, &off, &hidden(), &[0.02, 0.05]).unwrap();
    assert_eq!(classes.len(), 3);
    assert_eq!(classes.iter().map(|class| class.gaps).collect::<Vec<_>>(), [2, 0, 1]);
    // Two samples of 2 mm and one of 6 mm.
    assert_mm(classes[0].score.mean_mm, 10.0 / 3.0);
    assert!(classes[1].score.mean_mm.is_nan() && classes[1].score.hidden_cells == 0);
    assert_mm(classes[2].score.mean_mm, 10.0);
    assert_eq!((classes[2].score.hidden_cells, classes[2].score.unfilled_cells), (10, 5));
    assert_eq!((classes[1].longer_than_s, classes[1].at_most_s), (0.02, 0.05));
    assert_eq!((classes[0].longer_than_s, classes[2].at_most_s), (0.0, f64::INFINITY));
}

#[test]
fn classes_without_sense_are_refused() {
    for edges in [&[0.0][..], &[-1.0], &[0.2, 0.1], &[0.1, 0.1], &[f64::NAN], &[f64::INFINITY]] {
        assert_eq!(gap_length_classes(&hidden(), 100.0, edges).unwrap_err(), MetricError::Edges);
    }
    assert_eq!(gap_length_classes(&hidden(), 100.0, &[]).unwrap().len(), 1);
    let one = take(&[along_x(&[0.0; 4])]);
    let nothing = by_gap_length(&one, &one, &Mask::none(4, 1), &[0.1]);
    assert_eq!(nothing.unwrap_err(), MetricError::NoHiddenCell);
}

proptest! {
    /// The classes are the gaps of `per_gap`, each in one class, and together the score of the take.
    #[test]
    fn classes_add_up_to_the_take(kind in prop::collection::vec(0_u8..3, 60), edge in 0.011..0.2_f64) {
        let truth = take(&[along_x(&[0.0; 20]), along_x(&[1.0; 20]), along_x(&[2.0; 20])]);
        let hidden = Mask::from_fn(20, 3, |t, m| kind[3 * t + m] > 0);
        prop_assume!(hidden.count() > 0);
        let filled = truth
            .map_positions(|t, m, [x, y, z]| [x + 0.001 * f64::from(kind[3 * t + m]), y, z])
            .unwrap();
        let classes = by_gap_length(&truth, &filled, &hidden, &[edge, 2.0 * edge]).unwrap();
        let gaps = per_gap(&truth, &filled, &hidden).unwrap();
        prop_assert_eq!(classes.iter().map(|class| class.gaps).sum::<usize>(), gaps.len());
        for class in &classes {
            let own = |seconds: f64| seconds > class.longer_than_s && seconds <= class.at_most_s;
            let own = gaps.iter().filter(|gap| own(gap.gap.seconds(100.0))).count();
            prop_assert_eq!(own, class.gaps);
        }
        let whole = score(&truth, &filled, &hidden).unwrap();
        let sum: f64 = classes
            .iter()
            .filter(|class| class.gaps > 0)
            .map(|class| class.score.mean_mm * class.score.hidden_cells as f64)
            .sum();
        assert_mm(sum / whole.hidden_cells as f64, whole.mean_mm);
    }
}
