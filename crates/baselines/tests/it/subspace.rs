//! Missing-value SVD and principal components: closed forms, options and the shared contract.

use std::ops::ControlFlow;

use baselines::{Linear, Msvd, MsvdParams, Pca, PcaParams};
use mocap_core::{
    FillError, GapFiller, MarkerSet, Mask, Refusal, Take, Termination, geometry::distance,
};
use mocap_testkit::{Claims, articulated_take, conformance, with_gaps};
use ndarray::{Array1, Array2, Array3};
use proptest::prelude::*;

#[test]
fn subspace_fillers_conform() {
    // Sums in another order, through decompositions of matrices of order one.
    let claims = Claims { rigid_motion_m: None, permutation_m: Some(1e-7) };
    conformance(&Msvd::default(), &claims);
    conformance(&Pca::default(), &claims);
    conformance(&Pca::new(PcaParams { ramp: false, ..PcaParams::default() }).unwrap(), &claims);
}

/// Markers whose coordinates are products of a curve and a shape: rank one.
fn rank_one(frames: usize, markers: usize) -> Take {
    let names = MarkerSet::new((0..markers).map(|m| format!("M{m}"))).unwrap();
    let xyz = Array3::from_shape_fn((frames, markers, 3), |(t, m, axis)| {
        (1.5 + (0.1 * t as f64).sin()) * (1.0 + m as f64 - 0.4 * axis as f64)
    });
    Take::from_positions(names, 100.0, xyz).unwrap()
}

fn hide(take: &Take, hidden: impl Fn(usize, usize) -> bool) -> Take {
    take.hide(&Mask::from_fn(take.frames(), take.marker_count(), hidden)).unwrap()
}

#[test]
fn msvd_completes_a_matrix_of_its_rank() {
    let truth = rank_one(80, 4);
    let visible = hide(&truth, |t, m| (m == 1 && (20..50).contains(&t)) || (m == 3 && t < 10));
    let params = MsvdParams { rank: 1, iterations: 500, tolerance: 0.0 };
    let filled = Msvd::new(params).unwrap().fill(&visible).unwrap();
    for (t, m) in filled.filled_cells().iter() {
        let error = distance(filled.take().position(t, m).unwrap(), truth.position(t, m).unwrap());
        // Each iteration takes away a share of the error that is as large as the share of the matrix that is seen.
        assert!(error < 1e-6, "{t} {m} {error}");
    }
}

/// Each step of the iteration brings matrix and approximation closer.
#[test]
fn msvd_objective_falls() {
    let visible = with_gaps(articulated_take(150, 3), 3, 4, 10..=40);
    let params = MsvdParams { rank: 6, ..MsvdParams::default() };
    let filled = Msvd::new(params).unwrap().fill(visible.visible()).unwrap();
    let objective = &filled.report().objective;
    assert!(objective.len() > 3);
    assert!(objective.windows(2).all(|w| w[1] <= w[0] * (1.0 + 1e-9)), "{objective:?}");
}

#[test]
fn msvd_of_full_rank_stays_at_the_straight_line() {
    let visible = hide(&articulated_take(60, 1), |t, m| m == 2 && (20..30).contains(&t));
    let params = MsvdParams { rank: 24, ..MsvdParams::default() };
    let filled = Msvd::new(params).unwrap().fill(&visible).unwrap();
    let line = Linear::default().fill(&visible).unwrap();
    assert_eq!(filled.report().termination, Termination::Converged);
    for t in 20..30 {
        let (p, q) = (filled.take().position(t, 2).unwrap(), line.take().position(t, 2).unwrap());
        assert!(distance(p, q) < 1e-12);
    }
}

#[test]
fn msvd_stops_when_told() {
    let visible = hide(&rank_one(40, 3), |t, m| m == 0 && (10..20).contains(&t));
    let mut seen = Vec::new();
    let filled = Msvd::default()
        .fill_observed(&visible, &mut |report| {
            seen.push(report.iteration);
            if report.iteration == 1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .unwrap();
    assert_eq!(seen, [1]);
    assert_eq!(filled.report().termination, Termination::Stopped);
}

/// A marker that is an affine function of two others, which all components together hold exactly.
fn affine_take(frames: usize) -> Take {
    let curve = |t: usize, k: usize| (0.07 * (k + 1) as f64 * t as f64).sin();
    let xyz = Array3::from_shape_fn((frames, 4, 3), |(t, m, axis)| {
        let place = |m: usize| 0.1 * m as f64 + 0.05 * curve(t, 3 * m + axis);
        if m == 3 { 0.5 * (place(0) + place(1)) + 0.1 } else { place(m) }
    });
    Take::from_positions(MarkerSet::new(["A", "B", "C", "D"]).unwrap(), 100.0, xyz).unwrap()
}

#[test]
fn enough_components_recover_an_affine_marker() {
    let truth = affine_take(200);
    let visible = hide(&truth, |t, m| m == 3 && (50..120).contains(&t));
    // Nine directions hold all of the motion; the others are rounding.
    let params = PcaParams { cumulative: 1.0 - 1e-6, ramp: false, ..PcaParams::default() };
    let filled = Pca::new(params).unwrap().fill(&visible).unwrap();
    for t in 50..120 {
        let error = distance(filled.take().position(t, 3).unwrap(), truth.position(t, 3).unwrap());
        // The projection pulls towards the zero that stands for the missing marker, with its weight squared.
        assert!(error < 2e-3, "{t} {error}");
    }
}

/// The same answer from singular value decompositions of the data matrices themselves, step by step.
#[test]
fn components_agree_with_a_plain_decomposition() {
    use ndarray_linalg::SVD;
    let truth = articulated_take(150, 5);
    let (marker, gap) = (2, 60..90);
    let visible = hide(&truth, |t, m| m == marker && gap.contains(&t));
    let params = PcaParams { ramp: false, ..PcaParams::default() };
    let filled = Pca::new(params).unwrap().fill(&visible).unwrap();

    let markers = truth.marker_count();
    let others: Vec<usize> = (0..markers).filter(|&m| m != marker).collect();
    let centre = |t: usize, a: usize| {
        others.iter().map(|&m| truth.positions()[(t, m, a)]).sum::<f64>() / others.len() as f64
    };
    let local = Array2::from_shape_fn((150, 3 * markers), |(t, j)| {
        truth.positions()[(t, j / 3, j % 3)] - centre(t, j % 3)
    });
    let frames: Vec<usize> = (0..150).filter(|t| !gap.contains(t)).collect();
    let train = local.select(ndarray::Axis(0), &frames);
    let mean = train.mean_axis(ndarray::Axis(0)).unwrap();
    let spread = train.std_axis(ndarray::Axis(0), 0.0);
    let weight = Array1::from_shape_fn(3 * markers, |j| {
        if j / 3 == marker {
            return 0.02;
        }
        let d = frames.iter().map(|&t| truth.distance(t, marker, j / 3).unwrap()).sum::<f64>()
            / frames.len() as f64;
        (-d * d / (2.0 * 0.2 * 0.2)).exp()
    });
    let scaled = |x: &Array2<f64>| (x - &mean) / &spread * &weight;
    let zeroed = |mut x: Array2<f64>| {
        x.slice_mut(ndarray::s![.., 3 * marker..3 * marker + 3]).fill(0.0);
        x
    };
    let with = scaled(&train);
    let without = zeroed(with.clone());
    let basis = |x: &Array2<f64>| {
        let (_, values, directions) = x.svd(false, true).unwrap();
        let enough = 0.99 * values.sum();
        let mut sum = 0.0;
        let rank = values
            .iter()
            .position(|v| {
                sum += v;
                sum >= enough
            })
            .unwrap()
            + 1;
        (rank, directions.unwrap().t().to_owned())
    };
    let ((n, with), (k, without)) = (basis(&with), basis(&without));
    let rank = n.max(k);
    let with = with.slice(ndarray::s![.., ..rank]).to_owned();
    let without = without.slice(ndarray::s![.., ..rank]).to_owned();
    let projected =
        zeroed(scaled(&local)).dot(&without).dot(&without.t()).dot(&with).dot(&with.t());
    let expected = projected / &weight * &spread + &mean;
    for t in gap {
        for axis in 0..3 {
            let x = expected[(t, 3 * marker + axis)] + centre(t, axis);
            let found = filled.take().positions()[(t, marker, axis)];
            // Directions of values 1e-4 of the largest come from a Gram matrix with eight digits left.
            assert!((found - x).abs() < 1e-7, "{t} {axis}: {found} {x}");
        }
    }
}

#[test]
fn a_ramp_meets_the_samples() {
    let truth = articulated_take(200, 8);
    let visible = hide(&truth, |t, m| m == 1 && (80..82).contains(&t));
    let error = |ramp| {
        let filled =
            Pca::new(PcaParams { ramp, ..PcaParams::default() }).unwrap().fill(&visible).unwrap();
        distance(filled.take().position(80, 1).unwrap(), truth.position(80, 1).unwrap())
    };
    assert!(error(true) < 1e-3 && error(false) > 3.0 * error(true));
}

#[test]
fn a_black_out_is_refused() {
    let visible = hide(&articulated_take(200, 2), |t, _| (80..120).contains(&t));
    let filled = Pca::default().fill(&visible).unwrap();
    assert_eq!(filled.filled_cells().count(), 0);
    assert!(filled.report().refusals.iter().all(|r| r.reason == Refusal::NoNeighbour));
}

#[test]
fn a_marker_seen_too_seldom_is_refused() {
    let filled =
        Pca::default().fill(&hide(&articulated_take(60, 1), |t, m| m == 0 && t >= 9)).unwrap();
    let reasons: Vec<Refusal> = filled.report().refusals.iter().map(|r| r.reason).collect();
    assert_eq!(reasons, [Refusal::TooFewSamples { seen: 9, needed: 10 }]);
}

#[test]
fn parameters_out_of_range_are_named() {
    let pca = PcaParams::default();
    let msvd = MsvdParams::default();
    let field = |error: FillError| match error {
        FillError::Parameter { field, .. } => field,
        other => panic!("{other}"),
    };
    for (name, params) in [
        ("sigma_m", PcaParams { sigma_m: 0.0, ..pca }),
        ("missing_weight", PcaParams { missing_weight: f64::NAN, ..pca }),
        ("distal", PcaParams { distal: -1.0, ..pca }),
        ("cumulative", PcaParams { cumulative: 0.0, ..pca }),
        ("cumulative", PcaParams { cumulative: 1.1, ..pca }),
    ] {
        assert_eq!(field(Pca::new(params).unwrap_err()), name);
    }
    for (name, params) in [
        ("rank", MsvdParams { rank: 0, ..msvd }),
        ("iterations", MsvdParams { iterations: 0, ..msvd }),
        ("tolerance", MsvdParams { tolerance: f64::NAN, ..msvd }),
    ] {
        assert_eq!(field(Msvd::new(params).unwrap_err()), name);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Any pattern of visibility gives finite samples or refusals, never a panic.
    #[test]
    fn any_mask_is_accounted_for(seed in 0..1000_u64, share in 0.05..0.95_f64, run in 1..40_usize) {
        let truth = articulated_take(120, seed);
        // Runs of `run` frames hidden or seen by a fixed hash of marker and run.
        let visible = hide(&truth, |t, m| {
            let hash = (seed + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15)
                ^ ((t / run * 8 + m) as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
            ((hash ^ hash >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f64
                / f64::from(1 << 24) < share
        });
        prop_assume!(visible.observed().count() > 0);
        for filler in [&Pca::default() as &dyn GapFiller, &Msvd::default()] {
            let filled = filler.fill(&visible).unwrap();
            for gap in filled.gaps() {
                let refused = filled.report().refusals.iter().any(|r| r.gap == gap);
                for t in gap.frames.clone() {
                    prop_assert!(filled.take().is_observed(t, gap.marker) != refused);
                }
            }
        }
    }
}
