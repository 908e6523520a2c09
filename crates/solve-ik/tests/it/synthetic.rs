//! Synthetic takes, whose joints are known.

use augment::{GapSampler, GapSamplerParams, Preset, Unlisted};
use mocap_core::{RigidTransform, Rotation, Take, geometry::distance};
use mocap_synth::{Activity, SyntheticTake};
use solve_ik::{IkParams, IkSolver, Solution};

use crate::worn::{record, synthetic_body};

fn solve(take: &Take) -> Solution {
    IkSolver::new(synthetic_body(), IkParams::default()).unwrap().solve(take).unwrap()
}

/// Mean distance of the joints from where they really are, in metres, and the mean angle in degrees.
fn errors(solution: &Solution, truth: &SyntheticTake) -> (f64, f64) {
    let skeleton = solution.motion.skeleton();
    let (mut off, mut turned, mut count) = (0.0, 0.0, 0.0);
    for (t, (pose, true_pose)) in
        solution.motion.poses().iter().zip(truth.motion().poses()).enumerate()
    {
        for (j, at) in skeleton.positions(pose).unwrap().into_iter().enumerate() {
            off += distance(at, std::array::from_fn(|a| truth.joints()[(t, j, a)]));
            turned +=
                pose.rotations[j].inverse().after(true_pose.rotations[j]).angle().to_degrees();
            count += 1.0;
        }
    }
    (off / count, turned / count)
}

#[test]
fn joints_of_synthetic_takes_are_found_from_markers_alone() {
    for (activity, seed) in
        [(Activity::Walk, 1), (Activity::Run, 2), (Activity::Jump, 3), (Activity::Throw, 4)]
    {
        let recorded = record(activity, 600, seed);
        let solution = solve(recorded.take());
        let (off, turned) = errors(&solution, &recorded);
        let params = GapSamplerParams {
            occlusion: 0.1,
            seed,
            unlisted: Unlisted::Mean,
            ..GapSamplerParams::default()
        };
        let sampler = GapSampler::new(Preset::FrontWaist.model().unwrap(), params).unwrap();
        let gappy = sampler.sample(recorded.take()).unwrap().holdout;
        let (hidden_off, hidden_turned) = errors(&solve(gappy.visible()), &recorded);
        println!(
            "{activity}: JPE {:.2} cm, JOE {turned:.1}°; a tenth hidden: {:.2} cm, {hidden_turned:.1}°",
            100.0 * off,
            100.0 * hidden_off
        );
        // Places of joints along a bone that turns little are not to be told from a walk, and skin slides.
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
