//! Takes that begin with a T-pose.

use mocap_core::{Motion, Pose, Rotation, geometry::distance};
use mocap_synth::{Activity, Synth, SynthParams, SyntheticTake};
use solve_ik::{Body, IkError, IkParams, IkSolver};

use crate::worn::{record_with, synthetic_body};

const POSE: usize = 40;
const FRAMES: usize = 400;

/// A person who stands in a T-pose, joints off by some degrees as people's are, and then moves.
fn begun_in_t_pose(motion: Activity, seed: u64) -> SyntheticTake {
    let params = SynthParams { motion, frames: FRAMES, seed, ..SynthParams::default() };
    let recorded = record_with(&params);
    let skeleton = recorded.motion().skeleton();
    let first = &recorded.motion().poses()[0];
    let mut standing = Pose::rest(skeleton);
    standing.root_m = first.root_m;
    for (j, turn) in standing.rotations.iter_mut().enumerate() {
        let by = |k: f64| 0.05 * (7.3 * k * (j as f64 + 1.0) + seed as f64).sin();
        let off = Rotation::exp([by(1.0), by(2.0), by(3.0)]);
        let raised = match skeleton.joints()[j].name.as_str() {
            "left_shoulder" => std::f64::consts::FRAC_PI_2,
            "right_shoulder" => -std::f64::consts::FRAC_PI_2,
            _ => 0.0,
        };
        *turn = off.after(Rotation::exp([raised, 0.0, 0.0]));
    }
    standing.rotations[0] = Rotation::IDENTITY;
    let poses =
        std::iter::repeat_n(standing, POSE).chain(recorded.motion().poses().iter().cloned());
    let whole = Motion::new(skeleton.clone(), 120.0, poses.collect()).unwrap();
    let params = SynthParams { frames: POSE + FRAMES, ..params };
    Synth::retarget(params, &whole).unwrap().take().unwrap()
}

/// Mean distance of the joints from where they really are once the wearer moves, in metres.
fn off(body: &Body, rounds: usize, recorded: &SyntheticTake) -> f64 {
    let params = IkParams { calibration_rounds: rounds, ..IkParams::default() };
    let solution = IkSolver::new(body.clone(), params).unwrap().solve(recorded.take()).unwrap();
    let (found, truth) = (&solution.motion, recorded.motion());
    let (mut sum, mut count) = (0.0, 0.0);
    for (p, q) in found.poses().iter().zip(truth.poses()).skip(POSE) {
        let p = found.skeleton().positions(p).unwrap();
        let q = truth.skeleton().positions(q).unwrap();
        sum += p.iter().zip(&q).map(|(a, b)| distance(*a, *b)).sum::<f64>();
        count += p.len() as f64;
    }
    sum / count
}

fn solver(body: Body) -> IkSolver {
    IkSolver::new(body, IkParams::default()).unwrap()
}

#[test]
fn a_t_pose_gives_a_body() {
    for (motion, seed) in [(Activity::Kick, 2), (Activity::Throw, 4), (Activity::Run, 3)] {
        let recorded = begun_in_t_pose(motion, seed);
        let generic = solver(synthetic_body());
        let told = generic.calibrate_in_t_pose(recorded.take(), 0..POSE).unwrap();
        let fitted = generic.calibrate_on(recorded.take(), 0..POSE).unwrap();
        let [by_motion, by_pose, by_both, by_frames] = [
            off(&synthetic_body(), 2, &recorded),
            off(&told, 0, &recorded),
            off(&told, 2, &recorded),
            off(&fitted, 0, &recorded),
        ]
        .map(|m| 100.0 * m);
        println!(
            "{motion}: JPE calibrated on the motion {by_motion:.2} cm, in the T-pose {by_pose:.2} cm, on both {by_both:.2} cm; \
             on the same frames as any others {by_frames:.2} cm"
        );
        // No motion was needed, and none would have told more: four markers on a pelvis leave its joint open by 7 mm.
        assert!(by_pose < by_motion + 0.15, "{motion}: {by_pose} cm");
    }
}

#[test]
fn a_single_frame_moves_markers_to_where_they_sit() {
    let recorded = record_with(&SynthParams {
        motion: Activity::Kick,
        frames: 300,
        seed: 1,
        ..SynthParams::default()
    });
    let body = solver(Body::cmu_41()).calibrate_on(recorded.take(), 0..1).unwrap();
    let fixed = IkParams { calibration_rounds: 0, ..IkParams::default() };
    let solution = IkSolver::new(body, fixed).unwrap().solve(recorded.take()).unwrap();
    let mean = solution.residual_m.iter().sum::<f64>() / 300.0;
    println!("one frame of a kick: markers missed by {:.1} mm", 1e3 * mean);
    // Where they would stay if the template counted like twenty frames, they are missed by 30 mm.
    assert!(mean < 0.012, "{mean} m");
}

#[test]
fn frames_that_are_no_t_pose_are_refused() {
    let recorded = begun_in_t_pose(Activity::Throw, 4);
    let solver = solver(synthetic_body());
    let refused = |frames| solver.calibrate_in_t_pose(recorded.take(), frames).unwrap_err();
    assert!(matches!(refused(100..101), IkError::NotTPose { .. }), "{}", refused(100..101));
    assert!(matches!(refused(0..300), IkError::NotStill { .. }), "{}", refused(0..300));
    assert!(matches!(refused(40..40), IkError::NoFrames));
    assert!(matches!(refused(0..POSE + FRAMES + 1), IkError::NoFrames));
}
