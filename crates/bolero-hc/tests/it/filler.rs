//! The filler against its contract and its claims.

use std::ops::ControlFlow;

use bolero_hc::{BoleroHc, BoleroHcParams};
use lds_kalman::{
    EStep,
    filler::{LdsFiller, LdsFillerParams},
};
use mocap_core::{
    Bone, BoneReport, BoneRule, BoneSet, BoneSource, CoreError, FillError, Filled, GapFiller, Mask,
    RigidPairs, Take, Termination,
};
use mocap_testkit::{Claims, articulated_take, conformance};
use proptest::prelude::*;

fn filler(params: BoleroHcParams) -> BoleroHc {
    BoleroHc::new(params).unwrap()
}

fn fill(params: BoleroHcParams, take: &Take) -> (Filled, BoneReport) {
    reported(filler(params).fill(take).unwrap())
}

fn reported(filled: Filled) -> (Filled, BoneReport) {
    let report = filled.report().bones.clone().unwrap();
    (filled, report)
}

#[test]
fn the_filler_conforms() {
    // Every step commutes with rotations, translations and permutations when the model is
    // isotropic and starts from the data's own subspace; a hundred iterations let rounding grow.
    let claims = Claims { rigid_motion_m: Some(1e-6), permutation_m: Some(1e-6) };
    conformance(&BoleroHc::default(), &claims);
}

/// These markers hidden in the given frames.
fn with_gap(truth: &Take, markers: &[usize], frames: std::ops::Range<usize>) -> Take {
    let hidden = Mask::from_fn(truth.frames(), truth.marker_count(), |t, m| {
        markers.contains(&m) && frames.contains(&t)
    });
    truth.hide(&hidden).unwrap()
}

fn given(bones: &[(usize, usize, f64)]) -> BoneSource {
    let bones = bones.iter().map(|&(a, b, d)| Bone::new(a, b, d).unwrap());
    BoneSource::Given(BoneSet::new(bones).unwrap())
}

/// Two bones at each of the markers 2 and 3, and one between them: six unknown coordinates.
fn hinge(truth: &Take) -> BoneSource {
    let rule = BoneRule::Pairs(vec![(0, 2), (1, 2), (0, 3), (1, 3), (2, 3)]);
    BoneSource::Given(BoneSet::estimate(truth, &rule).unwrap())
}

#[test]
fn bones_have_their_length_in_every_frame() {
    let truth = articulated_take(200, 9);
    let take = with_gap(&truth, &[2, 3], 60..140);
    for bones in [hinge(&truth), given(&[(0, 2, 0.2), (2, 3, 0.1)])] {
        for e_step in [EStep::Exact, EStep::FilledAsObserved, EStep::Dynammo] {
            let default = BoleroHcParams::default();
            let model = LdsFillerParams { e_step, ..default.model };
            let (filled, report) =
                fill(BoleroHcParams { model, bones: bones.clone(), ..default }, &take);
            assert_eq!(report.constrained, 80);
            assert!(report.infeasible.is_empty(), "{report:?}");
            assert_eq!(filled.report().method, "bolero-hc");
        }
    }
}

#[test]
fn without_bones_it_is_the_plain_system() {
    let take = with_gap(&articulated_take(100, 3), &[2, 3], 40..60);
    let params = BoleroHcParams { bones: given(&[]), ..BoleroHcParams::default() };
    let plain = LdsFiller::new(params.model.clone()).unwrap().fill(&take).unwrap();
    let (filled, report) = fill(params, &take);
    assert!(filled.take().bit_eq(plain.take()));
    assert_eq!(report, BoneReport::default());
}

#[test]
fn markers_without_a_bone_are_filled_too() {
    let truth = articulated_take(80, 4);
    let take = with_gap(&truth, &[1, 3], 20..40);
    let bones = given(&[(0, 1, truth.distance(0, 0, 1).unwrap())]);
    let (filled, report) = fill(BoleroHcParams { bones, ..BoleroHcParams::default() }, &take);
    assert!(report.infeasible.is_empty());
    assert!((20..40).all(|t| filled.take().is_observed(t, 3)));
}

#[test]
fn contradicting_bones_are_listed_with_their_least_squares_residual() {
    let truth = articulated_take(60, 2);
    let take = with_gap(&truth, &[2], 20..30);
    // Out of reach of both known ends: the marker ends between them, each bone equally short.
    let bones = given(&[(0, 2, 0.001), (1, 2, 0.001)]);
    let (_, report) = fill(BoleroHcParams { bones, ..BoleroHcParams::default() }, &take);
    let frames: Vec<usize> = report.infeasible.iter().map(|broken| broken.frame).collect();
    assert_eq!(frames, (20..30).collect::<Vec<_>>());
    for broken in report.infeasible {
        let expected = truth.distance(broken.frame, 0, 1).unwrap() / 2.0 - 0.001;
        // In a compromise the prediction weighs a millionth before the bones alone decide.
        assert!((broken.residual_m - expected).abs() < 1e-6, "{broken:?}, expected {expected}");
    }
}

#[test]
fn bones_act_wherever_learning_ends() {
    let truth = articulated_take(80, 7);
    let take = with_gap(&truth, &[2, 3], 20..60);
    let default = || BoleroHcParams { bones: hinge(&truth), ..BoleroHcParams::default() };
    let early = |iterations, tolerance| {
        let model = LdsFillerParams { iterations, tolerance, ..default().model };
        fill(BoleroHcParams { model, ..default() }, &take)
    };
    for (iterations, tolerance) in [(2, 0.0), (5, 0.0), (100, 1e9)] {
        let (_, report) = early(iterations, tolerance);
        assert!(report.constrained == 40 && report.infeasible.is_empty(), "{iterations}");
    }
    for stop in [1, 3, 12] {
        let mut told = Vec::new();
        let observer = &mut |report: &mocap_core::IterReport| {
            told.push(report.iteration);
            if report.iteration == stop {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let (filled, report) = reported(filler(default()).fill_observed(&take, observer).unwrap());
        assert_eq!(filled.report().termination, Termination::Stopped);
        assert_eq!(told, (1..=stop).collect::<Vec<_>>());
        assert!(report.constrained == 40 && report.infeasible.is_empty(), "{stop}");
    }
}

#[test]
fn blackouts_and_never_seen_markers_end_finite() {
    let truth = articulated_take(90, 8);
    let all: Vec<usize> = (0..truth.marker_count()).collect();
    let dark = with_gap(&truth, &all, 30..50);
    let unseen = with_gap(&dark, &[3], 0..90);
    for take in [dark, unseen] {
        let bones = hinge(&truth);
        let (filled, report) = fill(BoleroHcParams { bones, ..BoleroHcParams::default() }, &take);
        assert!(report.infeasible.is_empty(), "{report:?}");
        assert_eq!(report.constrained, 20);
        let near = |(t, m): (usize, usize)| {
            let [p, q] = [filled.take(), &truth].map(|take| take.position(t, m).unwrap());
            // The body moves within a few metres.
            mocap_core::geometry::distance(p, q) < 5.0
        };
        assert!(filled.filled_cells().iter().all(near));
    }
}

fn on_threads(threads: usize, take: &Take) -> (Filled, BoneReport) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| fill(BoleroHcParams::default(), take))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, ..ProptestConfig::default() })]

    #[test]
    fn any_number_of_threads_gives_the_same_bits_and_keeps_observed_ones(
        seed in 0_u64..1000,
        start in 5_usize..40,
        length in 1_usize..40,
    ) {
        let truth = articulated_take(90, seed);
        let take = with_gap(&truth, &[2, 3], start..start + length);
        let (one, report) = on_threads(1, &take);
        let (two, same_report) = on_threads(2, &take);
        prop_assert!(one.take().bit_eq(two.take()));
        prop_assert_eq!(report, same_report);
        for (t, m) in take.observed().iter() {
            let bits = |take: &Take| take.position(t, m).unwrap().map(f64::to_bits);
            prop_assert_eq!(bits(one.take()), bits(&take));
        }
    }
}

#[test]
fn bad_parameters_and_bones_are_refused() {
    let error = BoleroHc::new(BoleroHcParams { first_iteration: 0, ..BoleroHcParams::default() });
    assert!(matches!(error, Err(FillError::Parameter { field: "first_iteration", .. })));
    for (iterations, params) in [
        (0, BoleroHcParams::default()),
        (0, BoleroHcParams::published()),
        (1, BoleroHcParams::published()),
    ] {
        let model = LdsFillerParams { iterations, ..params.model };
        let error = BoleroHc::new(BoleroHcParams { model, ..params });
        assert!(matches!(error, Err(FillError::Parameter { field: "iterations", .. })));
    }
    let take = with_gap(&articulated_take(50, 1), &[2], 10..20);
    let params = BoleroHcParams { bones: given(&[(0, 99, 0.3)]), ..BoleroHcParams::default() };
    let error = filler(params).fill(&take).unwrap_err();
    assert!(matches!(error, FillError::Core(CoreError::OutOfRange { marker: 99, .. })), "{error}");
}

#[test]
fn unnamed_markers_get_their_bones_from_rigidity() {
    let take = with_gap(&articulated_take(100, 6), &[2, 3], 40..50);
    let found = BoneSource::default().find(&take).unwrap();
    let rule = BoneRule::Rigid(RigidPairs::default());
    assert_eq!(found, BoneSet::estimate(&take, &rule).unwrap());
    assert!(found.touching(2).count() > 0);
}
