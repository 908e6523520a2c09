//! Forward kinematics against matrices by hand, its Jacobian against finite differences.

use mocap_core::{Joint, Motion, Pose, RigidTransform, Rotation, Skeleton, geometry::distance};
use proptest::prelude::*;

fn tree() -> Skeleton {
    let joint = |name: &str, parent, offset_m| Joint { name: name.into(), parent, offset_m };
    Skeleton::new(vec![
        joint("root", None, [0.1, 0.9, 0.0]),
        joint("left", Some(0), [0.3, 0.0, 0.1]),
        joint("right", Some(0), [-0.3, 0.0, 0.1]),
        joint("left hand", Some(1), [0.4, -0.2, 0.0]),
        joint("left thumb", Some(3), [0.1, 0.0, 0.05]),
    ])
    .unwrap()
}

fn pose() -> impl Strategy<Value = Pose> {
    let three = |size: f64| prop::array::uniform3(-size..size);
    (three(5.0), prop::collection::vec(three(2.0), 5)).prop_map(|(root_m, vectors)| Pose {
        root_m,
        rotations: vectors.into_iter().map(Rotation::exp).collect(),
    })
}

proptest! {
    #[test]
    fn frames_chain_transforms(pose in pose(), local in prop::array::uniform3(-0.5..0.5_f64)) {
        let skeleton = tree();
        let frames = skeleton.frames(&pose).unwrap();
        for joint in 0..5 {
            let mut point = local;
            for j in skeleton.ancestry(joint) {
                let m = pose.rotations[j].matrix();
                let offset = skeleton.joints()[j].offset_m;
                point = std::array::from_fn(|r| {
                    offset[r] + (0..3).map(|c| m[r][c] * point[c]).sum::<f64>()
                });
            }
            let expected: [f64; 3] = std::array::from_fn(|a| point[a] + pose.root_m[a]);
            // Some dozen roundings of numbers up to 7.
            prop_assert!(distance(frames.point(joint, local), expected) < 1e-13);
        }
        prop_assert_eq!(skeleton.positions(&pose).unwrap(), frames.origins_m);
    }

    #[test]
    fn a_transformed_motion_moves_every_joint(
        pose in pose(),
        turn in prop::array::uniform3(-3.0..3.0_f64),
        by in prop::array::uniform3(-3.0..3.0_f64),
    ) {
        let motion = Motion::new(tree(), 120.0, vec![pose]).unwrap();
        let by = RigidTransform { rotation: Rotation::exp(turn), translation: by };
        let moved = motion.transformed(&by).unwrap();
        let places = |m: &Motion| m.skeleton().positions(&m.poses()[0]).unwrap();
        for (before, after) in places(&motion).into_iter().zip(places(&moved)) {
            prop_assert!(distance(by.apply(before), after) < 1e-13);
        }
    }

    #[test]
    fn the_jacobian_agrees_with_finite_differences(
        pose in pose(),
        local in prop::array::uniform3(-0.5..0.5_f64),
        joint in 0..5_usize,
    ) {
        let skeleton = tree();
        let frames = skeleton.frames(&pose).unwrap();
        let jacobian = skeleton.jacobian(&frames, joint, frames.point(joint, local));
        let h = 1e-5;
        for column in 0..18 {
            let at = |by: f64| {
                let mut step = [0.0; 18];
                step[column] = by;
                let moved = skeleton.moved(&pose, &frames, &step);
                skeleton.frames(&moved).unwrap().point(joint, local)
            };
            let (plus, minus) = (at(h), at(-h));
            for axis in 0..3 {
                let slope = (plus[axis] - minus[axis]) / (2.0 * h);
                // Central differences of arms below 2 m: h² / 6 and roundings over h.
                prop_assert!((slope - jacobian[(axis, column)]).abs() < 1e-9);
            }
        }
    }
}
