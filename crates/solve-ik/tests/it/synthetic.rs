//! Synthetic takes, whose joints are known.

use metrics::{JointChoice, JointErrors, JointFrame, joint_errors};
use mocap_core::{RigidTransform, Rotation, Take, geometry::distance};
use mocap_synth::{Activity, Hands, Layout, SynthParams, SyntheticTake};
use solve_ik::{Body, IkParams, IkSolver, Solution};

use crate::worn::{self, Tracks, generic_body, record, record_with, synthetic_body, true_layout};

fn solve(take: &Take) -> Solution {
    solve_with(synthetic_body(), take)
}

fn solve_with(body: Body, take: &Take) -> Solution {
    IkSolver::new(body, IkParams::default()).unwrap().solve(take).unwrap()
}

/// Errors of the chosen joints in a frame of reference.
fn errors_in(
    solution: &Solution,
    truth: &SyntheticTake,
    frame: JointFrame,
    choice: &JointChoice,
) -> JointErrors {
    let (found, real) = (Tracks::of(&solution.motion), Tracks::of(truth.motion()));
    let parents: Vec<Option<usize>> =
        truth.motion().skeleton().joints().iter().map(|joint| joint.parent).collect();
    joint_errors(&real.poses(), &found.poses(), &parents, frame, choice).unwrap()
}

/// Mean distance of the joints from where they really are, in metres, and the mean local angle in degrees.
fn errors(solution: &Solution, truth: &SyntheticTake) -> (f64, f64) {
    let world = errors_in(solution, truth, JointFrame::World, &JointChoice::All);
    let local = errors_in(solution, truth, JointFrame::Parent, &JointChoice::All);
    (1e-3 * world.jpe_mean_mm, local.joe_mean_deg)
}

#[test]
fn joints_of_synthetic_takes_are_found_from_markers_alone() {
    for (activity, seed) in
        [(Activity::Walk, 1), (Activity::Run, 2), (Activity::Jump, 3), (Activity::Throw, 4)]
    {
        let recorded = record(activity, 600, seed);
        let solution = solve(recorded.take());
        let (off, turned) = errors(&solution, &recorded);
        let gappy = worn::tenth_hidden(recorded.take(), seed);
        let (hidden_off, hidden_turned) = errors(&solve(gappy.visible()), &recorded);
        println!(
            "{activity}: JPE {:.2} cm, JOE {turned:.1}°; a tenth hidden: {:.2} cm, {hidden_turned:.1}°",
            100.0 * off,
            100.0 * hidden_off
        );
        // Where markers are stuck on varies by 8 mm, and what a joint hardly turns about is not to be told from one motion.
        assert!(off < 0.011, "{activity}: {off} m");
        assert!(hidden_off < off + 0.0008, "{activity}: {hidden_off} m where a tenth is hidden");
    }
}

#[test]
fn a_moved_take_gives_a_moved_motion() {
    let recorded = record(Activity::Throw, 150, 5);
    let by =
        RigidTransform { rotation: Rotation::exp([0.4, -1.9, 0.8]), translation: [3.0, -1.0, 0.5] };
    let moved = recorded.take().map_positions(|_, _, p| by.apply(p)).unwrap();
    let (first, second) = (solve(recorded.take()), solve(&moved));
    let mut worst = 0.0_f64;
    for (p, q) in first.motion.poses().iter().zip(second.motion.poses()) {
        let here = first.motion.skeleton().positions(p).unwrap();
        let there = second.motion.skeleton().positions(q).unwrap();
        for (a, b) in here.into_iter().zip(there) {
            worst = worst.max(distance(by.apply(a), b));
        }
    }
    println!("{worst:e} m");
    // Calibration ends where a step gains less than 1e-5 of the cost, and rounding may move that by a step.
    assert!(worst < 1e-4, "{worst} m");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let recorded = record(Activity::Walk, 700, 6);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solve(recorded.take()))
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one.motion, three.motion);
    assert_eq!(one.body, three.body);
    assert!(one.markers.iter().zip(&three.markers).all(|(a, b)| a.to_bits() == b.to_bits()));
}

#[test]
fn bones_are_found_where_the_places_of_the_markers_are_known() {
    for (activity, seed) in
        [(Activity::Walk, 1), (Activity::Run, 2), (Activity::Jump, 3), (Activity::Throw, 4)]
    {
        let recorded = record(activity, 600, seed);
        // The bones that the calibration starts from are those of the mean of many people.
        let body = true_layout(&recorded, &synthetic_body());
        let (off, turned) = errors(&solve_with(body.clone(), recorded.take()), &recorded);
        let gappy = worn::tenth_hidden(recorded.take(), seed);
        let (hidden_off, _) = errors(&solve_with(body, gappy.visible()), &recorded);
        let known = synthetic_body().on(recorded.motion().skeleton().clone()).unwrap();
        let (known_off, _) = errors(&solve_with(known, recorded.take()), &recorded);
        println!(
            "{activity}, true layout: JPE {:.2} cm, JOE {turned:.1}°; a tenth hidden: {:.2} cm; true bones, generic layout: {:.2} cm",
            100.0 * off,
            100.0 * hidden_off,
            100.0 * known_off
        );
        assert!(off < 0.006, "{activity}: {off} m");
        assert!(hidden_off < 0.007, "{activity}: {hidden_off} m where a tenth is hidden");
    }
}

/// What one person does not show: the mean over ten, of the motion whose joints are hardest to find.
#[test]
fn joints_of_ten_people_who_run_are_found_where_the_places_of_the_markers_are_known() {
    const PEOPLE: u64 = 10;
    let off = |seed| {
        let recorded = record(Activity::Run, 600, seed);
        let body = true_layout(&recorded, &synthetic_body());
        errors(&solve_with(body, recorded.take()), &recorded).0
    };
    let offs: Vec<f64> = (70..70 + PEOPLE).map(off).collect();
    let mean = offs.iter().sum::<f64>() / PEOPLE as f64;
    let worst = offs.iter().copied().fold(0.0, f64::max);
    println!("ten who run: JPE {:.2} cm, at most {:.2} cm", 100.0 * mean, 100.0 * worst);
    assert!(mean < 0.005, "{mean} m");
}

#[test]
fn fingers_are_solved_from_their_markers() {
    for (hands, limit_mm) in [(Hands::Five, 10.0), (Hands::Ten, 8.0)] {
        let params = SynthParams {
            motion: Activity::Reach,
            frames: 240,
            seed: 5,
            layout: Layout::FrontWaist53,
            hands,
            ..SynthParams::default()
        };
        let recorded = record_with(&params);
        let solution = solve_with(generic_body(&params), recorded.take());
        let skeleton = recorded.motion().skeleton();
        let mut sum = 0.0;
        for side in ["left", "right"] {
            let wrist = skeleton.find(&format!("{side}_wrist")).unwrap();
            let below = |j: usize| j != wrist && skeleton.ancestry(j).any(|a| a == wrist);
            let fingers: Vec<usize> = (0..skeleton.joints().len()).filter(|&j| below(j)).collect();
            assert_eq!(fingers.len(), 15);
            let choice = JointChoice::These(fingers);
            sum += 0.5
                * errors_in(&solution, &recorded, JointFrame::Joint(wrist), &choice).jpe_mean_mm;
        }
        println!(
            "{hands:?} markers a hand: fingers {sum:.1} mm from where they are, seen from the wrist"
        );
        assert!(sum < limit_mm, "{hands:?}: {sum} mm");
    }
}
