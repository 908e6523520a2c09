//! Takes that cannot be solved are refused with the way out, and poor ones are not.

use mocap_core::{MarkerSet, Mask, MotionSolver, Skeleton, SolveError, Take, Termination};
use mocap_synth::Activity;
use ndarray::Array3;
use solve_ik::{Body, IkError, IkParams, IkSolver};

use crate::worn::{record, synthetic_body};

fn named(names: &[&str]) -> Take {
    let xyz = Array3::from_shape_fn((4, names.len(), 3), |(_, m, a)| 0.1 * (m * 3 + a) as f64);
    Take::from_positions(MarkerSet::new(names.iter().copied()).unwrap(), 120.0, xyz).unwrap()
}

fn solver(body: Body) -> IkSolver {
    IkSolver::new(body, IkParams::default()).unwrap()
}

#[test]
fn labels_that_the_map_does_not_know_are_refused_or_named() {
    let error = solver(Body::cmu_41()).solve(&named(&["*0", "*1", "*2", "*3"])).unwrap_err();
    assert!(matches!(error, IkError::RootMarkers { found: 0, .. }));
    let text = error.to_string();
    assert!(text.contains("LFWT, RFWT, LBWT, RBWT") && text.contains("alias"), "{text}");
    assert!(text.contains("the take has *0, *1, *2, *3;"), "{text}");
    let two = named(&["LFWT", "RFWT", "C7"]);
    assert!(matches!(
        solver(Body::cmu_41()).solve(&two),
        Err(IkError::RootMarkers { found: 2, .. })
    ));
    let twice = named(&["a:LFWT", "b:LFWT", "RFWT", "LBWT"]);
    let error = solver(Body::cmu_41()).solve(&twice).unwrap_err();
    assert!(matches!(&error, IkError::TwoLabels { marker, .. } if marker == "LFWT"), "{error}");
    // Plug-in Gait names, in any case and under a subject's name, are known; others are listed.
    let other = named(&["kim:lasi", "kim:rasi", "kim:lpsi", "kim:rpsi", "kim:hat"]);
    let solution = solver(Body::cmu_41()).solve(&other).unwrap();
    assert_eq!(solution.unmapped, ["kim:hat"]);
    let error = solver(Body::cmu_41()).check_markers(&other).unwrap_err();
    assert!(matches!(&error, IkError::Unmapped { labels, .. } if labels == "kim:hat"), "{error}");
    // An alias and the name it stands for are one marker; the name wins.
    let both = named(&["LASI", "LFWT", "RFWT", "LBWT"]);
    assert_eq!(solver(Body::cmu_41()).solve(&both).unwrap().unmapped, ["LASI"]);
}

#[test]
fn takes_without_a_visible_root_are_refused() {
    let take = record(Activity::Walk, 50, 1).into_take();
    let root = ["LFWT", "RFWT", "LBWT", "RBWT"].map(|name| take.markers().find(name).unwrap());
    // Each frame shows two of the four.
    let hidden = Mask::from_fn(50, take.marker_count(), |t, m| {
        root.iter().position(|&r| r == m).is_some_and(|k| (k + t) % 2 == 0)
    });
    let body = Body::parse(
        &Body::cmu_41()
            .to_string()
            .replace(" share ltibia 0.3", "")
            .replace(" share rtibia 0.3", ""),
        "plain",
    );
    let error = solver(body.unwrap()).solve(&take.hide(&hidden).unwrap()).unwrap_err();
    assert!(matches!(error, IkError::RootNeverSeen { .. }), "{error}");
    let empty =
        Take::from_positions(take.markers().clone(), 120.0, Array3::zeros((0, 41, 3))).unwrap();
    assert!(matches!(solver(Body::cmu_41()).solve(&empty), Err(IkError::NoFrames)));
    let beyond = solver(Body::cmu_41()).calibrate_on(&take, 40..51);
    assert!(matches!(beyond, Err(IkError::NoFrames)));
    assert!(solver(Body::cmu_41()).calibrate_on(&take, 0..1).is_ok());
}

#[test]
fn numbers_that_are_none_are_gaps_in_a_take_and_errors_elsewhere() {
    let take = record(Activity::Walk, 60, 1).into_take();
    let knee = take.markers().find("LKNE").unwrap();
    let mut xyz = take.positions().to_owned();
    xyz[(30, knee, 1)] = f64::NAN;
    let holed = Take::from_positions(take.markers().clone(), 120.0, xyz).unwrap();
    assert!(!holed.is_observed(30, knee));
    let solution = solver(Body::cmu_41()).solve(&holed).unwrap();
    assert!(solution.markers.iter().all(|c| c.is_finite()));
    let mut joints = Body::cmu_41().skeleton().joints().to_vec();
    joints[3].offset_m[2] = f64::NAN;
    let error = Body::cmu_41().on(Skeleton::new(joints).unwrap()).unwrap_err();
    assert!(matches!(&error, IkError::NoPlace { joint } if joint == "ltibia"), "{error}");
}

#[test]
fn parameters_are_checked() {
    for (params, name) in [
        (IkParams { marker_m: 0.0, ..IkParams::default() }, "marker_m"),
        (IkParams { robust_m: f64::NAN, ..IkParams::default() }, "robust_m"),
        (IkParams { turn_rad_s: f64::INFINITY, ..IkParams::default() }, "turn_rad_s"),
        (IkParams { iterations: 0, ..IkParams::default() }, "iterations"),
        (IkParams { calibration_frames: 0, ..IkParams::default() }, "calibration_frames"),
    ] {
        let error = IkSolver::new(Body::cmu_41(), params).unwrap_err();
        assert!(matches!(error, IkError::Parameter { field, .. } if field == name), "{error}");
    }
}

#[test]
fn black_outs_one_frame_and_stops_give_poses_all_the_same() {
    let recorded = record(Activity::Walk, 300, 2);
    let take = recorded.take();
    let dark = Mask::from_fn(300, 41, |t, _| (100..140).contains(&t) || !(5..=290).contains(&t));
    let solution = solver(synthetic_body()).solve(&take.hide(&dark).unwrap()).unwrap();
    let finite = |p: &mocap_core::Pose| p.root_m.iter().all(|c| c.is_finite());
    assert!(solution.motion.poses().iter().all(finite));
    assert!(solution.markers.iter().all(|c| c.is_finite()));
    assert!(solution.residual_m[120].is_nan() && solution.residual_m[50] < 0.02);
    let one = record(Activity::Walk, 1, 2);
    assert_eq!(solver(synthetic_body()).solve(one.take()).unwrap().motion.poses().len(), 1);
    let stopped = solver(synthetic_body())
        .solve_observed(take, &mut |_| std::ops::ControlFlow::Break(()))
        .unwrap();
    assert_eq!(stopped.termination, Termination::Stopped);
    assert_eq!(stopped.motion.poses().len(), 300);
}

#[test]
fn the_trait_solves_on_a_given_skeleton() {
    let recorded = record(Activity::Run, 120, 3);
    let truth = recorded.motion().skeleton();
    let solver = solver(synthetic_body());
    let solved = MotionSolver::solve(&solver, recorded.take(), truth).unwrap();
    assert_eq!(solved.motion.skeleton().joints(), truth.joints(), "its bones are known");
    let joint = mocap_core::Joint { name: "box".into(), parent: None, offset_m: [0.0; 3] };
    let error = MotionSolver::solve(&solver, recorded.take(), &Skeleton::new(vec![joint]).unwrap());
    assert!(matches!(error, Err(SolveError::Method { method: "ik", .. })));
}
