//! The interpolating fillers against closed forms and the shared contract.
#![allow(clippy::unwrap_used)] // tests

use baselines::{CubicSpline, Edges, Linear};
use mocap_core::{CellState, GapFiller, MarkerSet, Refusal, Take};
use mocap_testkit::{Claims, conformance};
use ndarray::Array3;
use proptest::prelude::*;

/// Interpolation is linear in the data, so only rounding in the rotation itself remains.
const CLAIMS: Claims = Claims { rigid_motion_m: Some(1e-12), permutation_m: Some(0.0) };

#[test]
fn linear_conforms() {
    conformance(&Linear::default(), &CLAIMS);
    conformance(&Linear { edges: Edges::Hold }, &CLAIMS);
}

#[test]
fn spline_conforms() {
    conformance(&CubicSpline::default(), &CLAIMS);
    conformance(&CubicSpline { edges: Edges::Hold }, &CLAIMS);
}

/// One marker on the given curve, hidden in `hidden`.
fn take(frames: usize, hidden: &[usize], curve: impl Fn(f64) -> [f64; 3]) -> Take {
    let xyz = Array3::from_shape_fn((frames, 1, 3), |(t, _, a)| {
        if hidden.contains(&t) { f64::NAN } else { curve(t as f64)[a] }
    });
    Take::from_positions(MarkerSet::new(["C7"]).unwrap(), 100.0, xyz).unwrap()
}

proptest! {
    /// A cubic passes through the not-a-knot spline unchanged, wherever it is hidden inside.
    #[test]
    fn spline_recovers_cubics(
        coefficients in prop::array::uniform4(-1.0..1.0_f64),
        hidden in prop::collection::btree_set(1_usize..19, 1..15),
    ) {
        let hidden: Vec<usize> = hidden.into_iter().collect();
        let [a, b, c, d] = coefficients;
        let curve = |t: f64| { let x = t / 20.0; [a + x * (b + x * (c + x * d)), x, 1.0] };
        let filled = CubicSpline::default().fill(&take(20, &hidden, curve)).unwrap();
        for t in hidden {
            let p = filled.take().position(t, 0).unwrap();
            // Twenty knots and values of order one: a few hundred roundings.
            prop_assert!(p.iter().zip(curve(t as f64)).all(|(x, y)| (x - y).abs() < 1e-12));
        }
    }

    #[test]
    fn linear_recovers_lines(
        slope in prop::array::uniform3(-1.0..1.0_f64),
        hidden in prop::collection::btree_set(1_usize..19, 1..18),
    ) {
        let hidden: Vec<usize> = hidden.into_iter().collect();
        let curve = |t: f64| slope.map(|s| 1.0 + s * t);
        let filled = Linear::default().fill(&take(20, &hidden, curve)).unwrap();
        for t in hidden {
            let p = filled.take().position(t, 0).unwrap();
            // Values up to 20 carry roundings of 4e-15.
            prop_assert!(p.iter().zip(curve(t as f64)).all(|(x, y)| (x - y).abs() < 1e-13));
        }
    }
}

#[test]
fn few_samples_give_line_and_parabola() {
    let parabola = |t: f64| [t * t, 2.0, -t];
    let filled = CubicSpline::default().fill(&take(7, &[1, 2, 4, 5], parabola)).unwrap();
    for t in [1, 2, 4, 5] {
        let p = filled.take().position(t, 0).unwrap();
        assert!((p[0] - (t * t) as f64).abs() < 1e-12, "three samples determine a parabola");
    }
    let filled = CubicSpline::default().fill(&take(4, &[1, 2], parabola)).unwrap();
    let p = filled.take().position(1, 0).unwrap();
    assert!((p[0] - 3.0).abs() < 1e-12, "two samples determine a line");
}

#[test]
fn one_sided_gaps_are_refused_or_held() {
    let input = take(6, &[0, 5], |t| [t, 0.0, 0.0]);
    let refused = Linear::default().fill(&input).unwrap();
    assert_eq!(refused.state(0, 0), CellState::Missing);
    assert!(refused.report().refusals.iter().all(|r| r.reason == Refusal::OneSided));
    assert_eq!(refused.report().refusals.len(), 2);
    let held = Linear { edges: Edges::Hold }.fill(&input).unwrap();
    assert_eq!(held.take().position(0, 0), Some([1.0, 0.0, 0.0]));
    assert_eq!(held.take().position(5, 0), Some([4.0, 0.0, 0.0]));
}
