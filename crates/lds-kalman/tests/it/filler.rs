//! The gap fillers.

use std::sync::Arc;

use lds_kalman::{
    EStep,
    filler::{Coordinates, Dark, Hidden, LdsFiller, LdsFillerParams},
};
use mocap_core::{
    CellState, CoreError, FillError, GapFiller, Holdout, MarkerKnowledge, MarkerSet, Mask, Take,
};
use mocap_testkit::{Claims, articulated_take, conformance};
use ndarray::Array3;

fn lds(params: LdsFillerParams) -> LdsFiller {
    LdsFiller::new(params).unwrap()
}

#[test]
fn the_fillers_conform() {
    // Centred, isotropic and from the data's own subspace, every step commutes with rotations,
    // translations and permutations; a hundred iterations let rounding grow to a micrometre.
    let claims = Claims { rigid_motion_m: Some(1e-6), permutation_m: Some(1e-6) };
    conformance(&lds(LdsFillerParams::default()), &claims);
    conformance(&lds(LdsFillerParams::dynammo()), &Claims::default());
}

fn hidden_in(take: &Take, frames: std::ops::Range<usize>, marker: usize) -> Take {
    let (t, m) = (take.frames(), take.marker_count());
    take.hide(&Mask::from_fn(t, m, |t, m| m == marker && frames.contains(&t))).unwrap()
}

#[test]
fn the_exact_filler_knows_its_error_and_the_published_one_does_not() {
    let truth = articulated_take(150, 4);
    let take = hidden_in(&truth, 60..75, 2);
    let exact = lds(LdsFillerParams::default()).fill(&take).unwrap();
    let sigma: Vec<f64> = (60..75).map(|t| exact.sigma_m(t, 2).unwrap()).collect();
    assert!(sigma.iter().all(|s| *s > 0.0));
    // Uncertainty is largest away from the borders.
    assert!(sigma[7] > sigma[0] && sigma[7] > sigma[14], "{sigma:?}");
    assert_eq!(exact.sigma_m(10, 2), None);
    let published = lds(LdsFillerParams::dynammo()).fill(&take).unwrap();
    assert_eq!(published.sigma_m(65, 2), None);
    assert_eq!(published.report().objective.len(), published.report().iterations);
}

#[test]
fn short_takes_get_a_model_that_fits_them_and_greedy_users_an_error() {
    let take = hidden_in(&articulated_take(4, 1), 1..2, 0);
    let filled = lds(LdsFillerParams::default()).fill(&take).unwrap();
    assert_eq!(filled.state(1, 0), CellState::Filled);
    let greedy = lds(LdsFillerParams { hidden: Hidden::Exactly(25), ..LdsFillerParams::default() });
    let error = greedy.fill(&take).unwrap_err();
    let FillError::Method { method: "lds", source } = error else { panic!("{error}") };
    assert!(source.to_string().contains("at most 24"), "{source}");
}

#[test]
fn a_take_with_dark_frames_keeps_its_pace_and_asks_for_no_further_iteration() {
    let truth = articulated_take(200, 4);
    let dark = |span: std::ops::Range<usize>| {
        Mask::from_fn(200, truth.marker_count(), move |t, _| span.contains(&t))
    };
    let hidden = Holdout::new(truth.clone(), &dark(90..110)).unwrap();
    let error = |params: LdsFillerParams| {
        let filled = lds(params).fill(hidden.visible()).unwrap();
        (mocap_testkit::mse(&hidden, filled.take()), filled.report().iterations)
    };
    let (steady, iterations) = error(LdsFillerParams::default());
    assert_eq!(iterations, 1);
    let (learnt, more) =
        error(LdsFillerParams { dark: Dark::Learnt, ..LdsFillerParams::default() });
    assert!(more > 1);
    assert!(steady < learnt, "steady {steady:.1e} m², learnt {learnt:.1e} m²");
    // One hidden marker of eight leaves enough to learn from.
    let one = hidden_in(&truth, 90..110, 2);
    assert!(lds(LdsFillerParams::default()).fill(&one).unwrap().report().iterations > 1);
}

#[test]
fn parameters_are_checked_when_the_filler_is_made() {
    let refused = |params: LdsFillerParams| match LdsFiller::new(params) {
        Err(FillError::Parameter { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    let defaults = LdsFillerParams::default;
    assert_eq!(refused(LdsFillerParams { hidden: Hidden::Exactly(0), ..defaults() }), "hidden");
    assert_eq!(refused(LdsFillerParams { iterations: 0, ..defaults() }), "iterations");
    assert_eq!(refused(LdsFillerParams { tolerance: -1.0, ..defaults() }), "tolerance");
}

/// Markers of the CMU set on a body that walks round a circle of two metres.
fn walker(frames: usize) -> Take {
    let names = ["C7", "T10", "LBWT", "RBWT", "CLAV", "STRN", "LFWT", "RFWT", "LKNE", "RKNE"];
    let positions = Array3::from_shape_fn((frames, names.len(), 3), |(t, m, a)| {
        let phase = t as f64 / 40.0;
        let side = if m % 2 == 0 { 0.15 } else { -0.15 };
        let swing = if m >= 8 { 0.3 * (5.0 * phase + m as f64).sin() } else { 0.0 };
        let forward = swing + if (4..8).contains(&m) { 0.12 } else { -0.12 };
        let (sin, cos) = phase.sin_cos();
        let local = [
            2.0 * cos - forward * sin - side * cos,
            2.0 * sin + forward * cos - side * sin,
            1.4 - 0.1 * m as f64 + 0.02 * (10.0 * phase).sin(),
        ];
        local[a]
    });
    Take::from_positions(MarkerSet::new(names).unwrap(), 120.0, positions).unwrap()
}

#[test]
fn body_coordinates_need_reference_markers_and_return_to_the_world() {
    let truth = walker(200);
    let take = hidden_in(&truth, 80..120, 9);
    let body = LdsFillerParams {
        hidden: Hidden::Exactly(6),
        coordinates: Coordinates::Body(Arc::new(MarkerKnowledge::cmu_41())),
        ..LdsFillerParams::default()
    };
    let filled = lds(body.clone()).fill(&take).unwrap();
    for t in 80..120 {
        let (p, q) = (filled.take().position(t, 9).unwrap(), truth.position(t, 9).unwrap());
        let error = mocap_core::geometry::distance(p, q);
        // The knee swings by 0.3 m either way on a sine, nearly a linear system in body coordinates.
        assert!(error < 0.03, "frame {t}: {error} m");
    }
    let nameless = hidden_in(&articulated_take(50, 1), 10..20, 0);
    let error = lds(body).fill(&nameless).unwrap_err();
    assert!(matches!(error, FillError::Core(CoreError::NoBodyFrame)), "{error}");
}

#[test]
fn names_follow_the_e_step() {
    let name =
        |e_step| lds(LdsFillerParams { e_step, ..LdsFillerParams::default() }).name().to_owned();
    assert_eq!(name(EStep::Exact), "lds");
    assert_eq!(name(EStep::Dynammo), "dynammo");
    assert_eq!(name(EStep::FilledAsObserved), "lds-filled");
}
