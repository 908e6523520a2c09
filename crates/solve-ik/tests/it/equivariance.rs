//! Where the recording's origin lies, which way its axes point and in which order its markers come is nothing to a body.

use std::sync::LazyLock;

use mocap_core::{RigidTransform, Rotation, Take, geometry::distance};
use mocap_synth::Activity;
use proptest::prelude::*;
use solve_ik::{Body, IkParams, IkSolver, Solution};

use crate::worn::{record, synthetic_body, tenth_hidden};

/// A take with gaps, and the body of its wearer as calibrated on it.
static GAPPY: LazyLock<(Take, Body)> = LazyLock::new(|| {
    let take = tenth_hidden(record(Activity::Throw, 90, 5).take(), 5).visible().clone();
    let body = solve(&take, synthetic_body(), 2).body;
    (take, body)
});

fn solve(take: &Take, body: Body, rounds: usize) -> Solution {
    let params = IkParams { calibration_rounds: rounds, ..IkParams::default() };
    IkSolver::new(body, params).unwrap().solve(take).unwrap()
}

fn transform() -> impl Strategy<Value = RigidTransform> {
    // Rotation vectors up to half a circle about any axis, and a laboratory of some size.
    let axis = prop::array::uniform3(-1.0..1.0_f64)
        .prop_filter("a direction", |v| v.iter().map(|c| c * c).sum::<f64>() > 1e-2);
    (axis, 0.0..std::f64::consts::PI, prop::array::uniform3(-5.0..5.0_f64)).prop_map(
        |(axis, angle, translation)| RigidTransform {
            rotation: Rotation::about(axis, angle),
            translation,
        },
    )
}

/// The largest distance between a joint of the moved solve and that joint of the first one moved along, in metres, and the largest
/// angle between turns of any joint but the root, in radians.
fn apart(first: &Solution, second: &Solution, by: &RigidTransform) -> (f64, f64) {
    let (mut metres, mut radians) = (0.0_f64, 0.0_f64);
    for (p, q) in first.motion.poses().iter().zip(second.motion.poses()) {
        let here = first.motion.skeleton().positions(p).unwrap();
        let there = second.motion.skeleton().positions(q).unwrap();
        for (a, b) in here.into_iter().zip(there) {
            metres = metres.max(distance(by.apply(a), b));
        }
        for (a, b) in p.rotations.iter().zip(&q.rotations).skip(1) {
            radians = radians.max(a.inverse().after(*b).angle());
        }
        let root = by.rotation.after(p.rotations[0]);
        radians = radians.max(root.inverse().after(q.rotations[0]).angle());
    }
    (metres, radians)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Frames end with a step below 1e-4 rad, and rounding may add or spare one of these.
    #[test]
    fn a_known_body_moves_with_its_take(by in transform()) {
        let (take, body) = &*GAPPY;
        let moved = take.map_positions(|_, _, p| by.apply(p)).unwrap();
        let (first, second) = (solve(take, body.clone(), 0), solve(&moved, body.clone(), 0));
        let (metres, radians) = apart(&first, &second, &by);
        prop_assert!(metres < 2e-5 && radians < 1e-4, "{metres:e} m, {radians:e} rad");
    }

    #[test]
    fn the_order_of_markers_changes_no_bit(order in Just((0..41).collect::<Vec<usize>>()).prop_shuffle()) {
        let (take, body) = &*GAPPY;
        let shuffled = take.select(&order).unwrap();
        let (first, second) = (solve(take, body.clone(), 1), solve(&shuffled, body.clone(), 1));
        prop_assert_eq!(&first.motion, &second.motion);
        prop_assert_eq!(&first.body, &second.body);
        for (to, &from) in order.iter().enumerate() {
            prop_assert_eq!(
                first.markers[(45, from, 1)].to_bits(),
                second.markers[(45, to, 1)].to_bits()
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// Calibration ends where a step gains less than 1e-5 of the cost, and rounding may move that by a step.
    #[test]
    fn a_calibrated_body_moves_with_its_take(by in transform()) {
        let (take, body) = &*GAPPY;
        let moved = take.map_positions(|_, _, p| by.apply(p)).unwrap();
        let first = solve(take, synthetic_body(), 2);
        let second = solve(&moved, synthetic_body(), 2);
        let (metres, radians) = apart(&first, &second, &by);
        prop_assert!(metres < 1e-4 && radians < 1e-3, "{metres:e} m, {radians:e} rad");
        prop_assert_eq!(&first.body, body);
    }
}
