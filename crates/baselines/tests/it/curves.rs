//! The interpolating fillers against closed forms and another program.

use baselines::{CubicSpline, Edges, Linear, Pchip, QuinticSpline};
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

/// Frames `seen` of a take of one marker hold `values` in all three coordinates.
fn samples(frames: usize, seen: &[usize], values: &[f64]) -> Take {
    let xyz = Array3::from_shape_fn((frames, 1, 3), |(t, _, _)| {
        seen.iter().position(|&s| s == t).map_or(f64::NAN, |k| values[k])
    });
    Take::from_positions(MarkerSet::new(["C7"]).unwrap(), 100.0, xyz).unwrap()
}

fn filled_values(filler: &dyn GapFiller, take: &Take, frames: &[usize]) -> Vec<f64> {
    let filled = filler.fill(take).unwrap();
    frames.iter().map(|&t| filled.take().position(t, 0).unwrap()[1]).collect()
}

#[test]
fn pchip_and_nexus_spline_conform() {
    // The slopes are limited coordinate by coordinate, so a turned take is filled otherwise.
    let claims = Claims { rigid_motion_m: None, permutation_m: Some(0.0) };
    conformance(&Pchip::default(), &claims);
    conformance(&Pchip { edges: Edges::Hold }, &claims);
    // Values of metres through a system with a condition of about 1e4.
    conformance(&QuinticSpline, &Claims { rigid_motion_m: Some(1e-10), ..CLAIMS });
}

/// `scipy.interpolate.PchipInterpolator` 1.17 on the same samples.
#[test]
fn pchip_agrees_with_scipy() {
    let take = samples(10, &[0, 1, 2, 5, 6, 9], &[0.0, 0.3, 1.0, 1.1, 0.7, 0.9]);
    let found = filled_values(&Pchip::default(), &take, &[3, 4, 7, 8]);
    let expected = [1.059_259_26, 1.090_740_74, 0.707_407_41, 0.759_259_26];
    // As many digits as were printed.
    assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 6e-9), "{found:?}");
}

/// `scipy.interpolate.make_interp_spline` 1.17 with `k=5` and natural ends, on the same samples.
#[test]
fn nexus_spline_agrees_with_scipy() {
    let seen: Vec<usize> = (0..7).chain(13..20).collect();
    let value = |&t: &usize| (0.35 * t as f64).sin() + 0.1 * (2.0 * t as f64).cos();
    let take = samples(20, &seen, &seen.iter().map(value).collect::<Vec<_>>());
    let found = filled_values(&QuinticSpline, &take, &[7, 8, 9, 10, 11, 12]);
    let expected = [1.017_458, 1.006_137_85, 0.847_545_46, 0.519_699_5, 0.050_221_81, -0.478_167];
    // As many digits as were printed.
    assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 6e-9), "{found:?}");
}

#[test]
fn nexus_spline_refuses_short_seeds() {
    let four: Vec<usize> = (0..8).chain(10..14).collect();
    let take = samples(16, &four, &[0.0; 12]);
    let filled = QuinticSpline.fill(&take).unwrap();
    let reasons: Vec<Refusal> = filled.report().refusals.iter().map(|r| r.reason).collect();
    assert_eq!(reasons, [Refusal::ShortSeed { found: 4, needed: 5 }, Refusal::OneSided]);
    let five: Vec<usize> = (0..8).chain(10..15).collect();
    let filled = QuinticSpline.fill(&samples(15, &five, &[0.5; 13])).unwrap();
    assert_eq!(filled.state(8, 0), CellState::Filled);
}

/// Only N / 2 + 5 samples on each side count: what lies farther away changes nothing.
#[test]
fn nexus_spline_reads_no_further_than_its_seeds() {
    let curve = |t: f64| [(0.2 * t).sin(), 0.1 * t, (0.3 * t).cos()];
    let bent = |t: f64| curve(t).map(|c| if (13.0..37.0).contains(&t) { c } else { c + 1.0 });
    let hidden: Vec<usize> = (20..30).collect();
    let (here, there) = (take(50, &hidden, curve), take(50, &hidden, bent));
    let fill = |take: &Take| QuinticSpline.fill(take).unwrap();
    let moved = take(50, &hidden, |t| {
        curve(t).map(|c| if (10.0..40.0).contains(&t) { c } else { c + 1.0 })
    });
    let at = |take: &Take| {
        (20..30).map(|t| fill(take).take().position(t, 0).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(at(&here), at(&moved), "ten seeds on each side are N / 2 + 5");
    assert_ne!(at(&here), at(&there));
}

proptest! {
    /// Between the samples beside a gap, in every coordinate, whatever the samples are.
    #[test]
    fn pchip_never_overshoots(
        values in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 20),
        hidden in prop::collection::btree_set(1_usize..19, 1..15),
    ) {
        let hidden: Vec<usize> = hidden.into_iter().collect();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole numbers below 20
        let input = take(20, &hidden, |t| values[t as usize]);
        let filled = Pchip::default().fill(&input).unwrap();
        for &t in &hidden {
            let before = (0..t).rev().find(|s| !hidden.contains(s)).unwrap();
            let after = (t..20).find(|s| !hidden.contains(s)).unwrap();
            let p = filled.take().position(t, 0).unwrap();
            for axis in 0..3 {
                let (x, y) = (values[before][axis], values[after][axis]);
                // One rounding in a weighted mean of the two.
                prop_assert!(p[axis] >= x.min(y) - 1e-15 && p[axis] <= x.max(y) + 1e-15);
            }
        }
    }

    /// A parabola has no third derivative, so the spline that has least of it is the parabola.
    #[test]
    fn nexus_spline_recovers_parabolas(
        coefficients in prop::array::uniform3(-1.0..1.0_f64),
        start in 5_usize..30,
        length in 1_usize..60,
    ) {
        let hidden: Vec<usize> = (start..start + length).collect();
        let [a, b, c] = coefficients;
        let curve = |t: f64| { let x = t / 100.0; [a + x * (b + x * c), x, 1.0] };
        let filled = QuinticSpline.fill(&take(100, &hidden, curve)).unwrap();
        for t in hidden {
            let p = filled.take().position(t, 0).unwrap();
            // Block elimination through a gap of 60 frames loses seven digits.
            prop_assert!(p.iter().zip(curve(t as f64)).all(|(x, y)| (x - y).abs() < 1e-9));
        }
    }
}
