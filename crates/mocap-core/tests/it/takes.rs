use mocap_core::{
    CellState, CoreError, Estimates, FillReport, Filled, Gap, GapContext, Holdout, MarkerSet, Mask,
    Refusal, Take, Termination,
};
use ndarray::Array3;
use proptest::prelude::*;

use crate::take;

#[test]
fn observed_cells_must_be_finite() {
    let names = MarkerSet::new(["a"]).unwrap();
    let xyz = Array3::from_elem((2, 1, 3), f64::INFINITY);
    let error = Take::new(names.clone(), 100.0, xyz.clone(), Mask::all(2, 1)).unwrap_err();
    assert_eq!(error, CoreError::NotFinite { frame: 0, marker: "a".into() });
    assert!(Take::new(names, 100.0, xyz, Mask::none(2, 1)).is_ok());
}

#[test]
fn rates_and_shapes_are_checked() {
    let names = MarkerSet::new(["a"]).unwrap();
    for rate_hz in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Take::from_positions(names.clone(), rate_hz, Array3::zeros((1, 1, 3)));
        assert!(matches!(error, Err(CoreError::Rate { .. })));
    }
    for shape in [(1, 2, 3), (1, 1, 2)] {
        let error = Take::from_positions(names.clone(), 100.0, Array3::zeros(shape));
        assert!(matches!(error, Err(CoreError::Shape { .. })), "{shape:?}");
    }
}

#[test]
fn names_are_unique_and_found_without_prefix() {
    assert!(matches!(MarkerSet::new(["a", " "]), Err(CoreError::EmptyMarkerName { index: 1 })));
    let set = MarkerSet::new(["x:C7", "y:C7", "y:T10"]).unwrap();
    assert_eq!(set.find("y:C7"), Ok(1));
    assert_eq!(set.find("T10"), Ok(2));
    let Err(CoreError::UnknownMarker { similar, .. }) = set.find("C7") else {
        panic!("an ambiguous bare name was resolved")
    };
    assert_eq!(similar, ["x:C7", "y:C7"]);
}

#[test]
fn hidden_truth_cannot_be_read() {
    let truth = take(3, 2, |t, m| Some([t as f64, m as f64, 1.0]));
    let hidden = Mask::from_fn(3, 2, |t, m| t == 1 && m == 0);
    let holdout = Holdout::new(truth, &hidden).unwrap();
    assert!(holdout.visible().positions().slice(ndarray::s![1, 0, ..]).iter().all(|c| c.is_nan()));
    assert_eq!(holdout.truth().position(1, 0), Some([1.0, 0.0, 1.0]));
    assert_eq!(holdout.hidden(), &hidden);
}

#[test]
fn merging_never_alters_a_measurement() {
    let input = take(3, 1, |t, _| (t != 1).then_some([t as f64; 3]));
    let estimates = Estimates { positions: Array3::from_elem((3, 1, 3), 9.0), sigma_m: None };
    let report = FillReport::new("constant", Termination::ClosedForm);
    let filled = Filled::merge(&input, estimates, report).unwrap();
    assert_eq!(filled.take().position(0, 0), Some([0.0; 3]));
    assert_eq!(filled.take().position(1, 0), Some([9.0; 3]));
    assert_eq!(filled.state(1, 0), CellState::Filled);

    let gap = Gap { marker: 0, frames: 1..2 };
    let open = filled.refuse(gap.clone(), Refusal::NotFinite).unwrap();
    assert_eq!(open.state(1, 0), CellState::Missing);
    assert_eq!(open.state(0, 0), CellState::Observed);
    assert_eq!(open.report().refusals[0].gap, gap);
}

#[test]
fn estimates_that_are_not_finite_stay_missing() {
    let input = take(2, 1, |t, _| (t == 0).then_some([0.0; 3]));
    let mut positions = Array3::zeros((2, 1, 3));
    positions[(1, 0, 2)] = f64::INFINITY;
    let report = FillReport::new("broken", Termination::ClosedForm);
    let filled = Filled::merge(&input, Estimates { positions, sigma_m: None }, report).unwrap();
    assert_eq!(filled.state(1, 0), CellState::Missing);
}

proptest! {
    /// The gaps are exactly the missing cells: disjoint, maximal, in order.
    #[test]
    fn gaps_partition_the_missing_cells(
        cells in prop::collection::vec(prop::collection::vec(any::<bool>(), 3), 1..40),
    ) {
        let frames = cells.len();
        let input = take(frames, 3, |t, m| cells[t][m].then_some([0.0; 3]));
        let gaps = input.gaps();
        let mut covered = Mask::none(frames, 3);
        for gap in &gaps {
            prop_assert!(!gap.is_empty());
            for t in gap.frames.clone() {
                prop_assert!(!input.is_observed(t, gap.marker));
                prop_assert!(!covered.contains(t, gap.marker));
                covered.insert(t, gap.marker).unwrap();
            }
            let (start, end) = (gap.frames.start, gap.frames.end);
            prop_assert!(start == 0 || input.is_observed(start - 1, gap.marker));
            prop_assert!(end == frames || input.is_observed(end, gap.marker));
            let context = gap.context(frames);
            prop_assert_eq!(context == GapContext::Interior, start > 0 && end < frames);
        }
        prop_assert_eq!(covered.count() + input.observed().count(), frames * 3);
    }
}
