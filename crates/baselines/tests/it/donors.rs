//! The donor fills of Vicon Nexus: closed forms and refusals.

use baselines::{PatternFill, RigidBodyFill};
use mocap_core::{CellState, GapFiller, MarkerSet, Mask, Refusal, Take, geometry::distance};
use mocap_testkit::{Claims, conformance, rigid_take};
use ndarray::Array3;
use proptest::prelude::*;

/// Offsets and three-point fits of metres: rounding.
const CLAIMS: Claims = Claims { rigid_motion_m: Some(1e-12), permutation_m: Some(1e-12) };

#[test]
fn donor_fills_conform() {
    conformance(&PatternFill, &CLAIMS);
    conformance(&RigidBodyFill, &CLAIMS);
}

fn hide(take: &Take, hidden: impl Fn(usize, usize) -> bool) -> Take {
    take.hide(&Mask::from_fn(take.frames(), take.marker_count(), hidden)).unwrap()
}

fn reasons(filler: &dyn GapFiller, take: &Take) -> Vec<Refusal> {
    filler.fill(take).unwrap().report().refusals.iter().map(|r| r.reason).collect()
}

/// The formula of the program's pages, spelt out: `V(F) − V(D) + D`, where V draws a straight line between the borders.
#[test]
fn pattern_is_the_published_formula() {
    let xyz = Array3::from_shape_fn((30, 2, 3), |(t, m, axis)| {
        let t = t as f64;
        (0.1 * t * (1.0 + axis as f64)).sin() + 0.02 * m as f64 * t.sqrt()
    });
    let truth = Take::from_positions(MarkerSet::new(["F", "D"]).unwrap(), 100.0, xyz).unwrap();
    let filled = PatternFill.fill(&hide(&truth, |t, m| m == 0 && (10..20).contains(&t))).unwrap();
    let line = |t: usize, m: usize, axis: usize| {
        let (p, q) = (truth.positions()[(9, m, axis)], truth.positions()[(20, m, axis)]);
        (q - p) * (t - 9) as f64 / 11.0 + p
    };
    for t in 10..20 {
        for axis in 0..3 {
            let expected = line(t, 0, axis) - line(t, 1, axis) + truth.positions()[(t, 1, axis)];
            assert!((filled.take().positions()[(t, 0, axis)] - expected).abs() < 1e-14);
        }
    }
}

#[test]
fn a_donor_with_a_gap_is_refused() {
    let truth = rigid_take(5, 60, 4);
    // The donors of a marker on a rigid body are the first ones: all distances vary by roundings.
    let complete = hide(&truth, |t, m| m == 0 && (20..30).contains(&t));
    let pattern = PatternFill.fill(&complete).unwrap();
    assert!((20..30).all(|t| pattern.state(t, 0) == CellState::Filled));
    for gone in [19, 25, 30] {
        let visible =
            hide(&truth, |t, m| (m == 0 && (20..30).contains(&t)) || (m > 0 && t == gone));
        for filler in [&PatternFill as &dyn GapFiller, &RigidBodyFill] {
            let refusals = reasons(filler, &visible);
            assert!(matches!(refusals[0], Refusal::DonorMissing { .. }), "{gone} {refusals:?}");
        }
    }
    let outside = hide(&truth, |t, m| (m == 0 && (20..30).contains(&t)) || (m > 0 && t == 31));
    assert_eq!(RigidBodyFill.fill(&outside).unwrap().state(25, 0), CellState::Filled);
}

#[test]
fn one_sided_gaps_have_one_reference_or_none() {
    let truth = rigid_take(5, 60, 9);
    let visible = hide(&truth, |t, m| m == 0 && t >= 40);
    assert_eq!(reasons(&PatternFill, &visible), [Refusal::OneSided]);
    let filled = RigidBodyFill.fill(&visible).unwrap();
    let error = |t| distance(filled.take().position(t, 0).unwrap(), truth.position(t, 0).unwrap());
    assert!((40..60).all(|t| error(t) < 1e-9));
}

#[test]
fn too_few_donors_are_refused() {
    let two = rigid_take(2, 40, 1);
    let visible = hide(&two, |t, m| m == 0 && (10..20).contains(&t));
    assert_eq!(reasons(&RigidBodyFill, &visible), [Refusal::NoNeighbour]);
    let one = rigid_take(1, 40, 1);
    let visible = hide(&one, |t, _| (10..20).contains(&t));
    assert_eq!(reasons(&PatternFill, &visible), [Refusal::NoNeighbour]);
}

/// Donors on a line tell no turn about it, so the next marker takes their place.
#[test]
fn donors_on_a_line_are_passed_over() {
    let shape = [[0.0, 0.1, 0.0], [0.0; 3], [0.1, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.0, 0.2]];
    let xyz = Array3::from_shape_fn((40, 5, 3), |(t, m, axis)| {
        let turn = mocap_core::Rotation::about([1.0, 0.0, 0.0], 0.05 * t as f64);
        turn.apply(shape[m])[axis]
    });
    let names = MarkerSet::new(["A", "B", "C", "D", "E"]).unwrap();
    let truth = Take::from_positions(names, 100.0, xyz).unwrap();
    let filled = RigidBodyFill.fill(&hide(&truth, |t, m| m == 0 && (5..35).contains(&t))).unwrap();
    let error = |t| distance(filled.take().position(t, 0).unwrap(), truth.position(t, 0).unwrap());
    assert!((5..35).all(|t| error(t) < 1e-12));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_rigid_body_is_recovered(
        seed in 0..1000_u64,
        markers in 5..9_usize,
        start in 0..80_usize,
        length in 1..80_usize,
    ) {
        let truth = rigid_take(markers, 100, seed);
        prop_assume!(start + length < 90 || start > 0);
        let visible = hide(&truth, |t, m| m == 0 && (start..start + length).contains(&t));
        prop_assume!(visible.gaps().iter().all(|gap| gap.len() <= 89));
        let filled = RigidBodyFill.fill(&visible).unwrap();
        for t in start..(start + length).min(100) {
            let error = distance(filled.take().position(t, 0).unwrap(), truth.position(t, 0).unwrap());
            // Three donors may stand near a line, which costs digits.
            prop_assert!(error < 1e-8, "{error}");
        }
    }
}
