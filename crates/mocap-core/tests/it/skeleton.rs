use mocap_core::{
    CoreError, Joint, Pose, RigidTransform, Rotation, Skeleton,
    geometry::{cross, distance, norm, scale},
};
use proptest::prelude::*;

fn joint(name: &str, parent: Option<usize>, offset_m: [f64; 3]) -> Joint {
    Joint { name: name.into(), parent, offset_m }
}

#[test]
fn joints_form_one_tree_in_order() {
    let error = Skeleton::new(vec![joint("a", None, [0.0; 3]), joint("b", None, [0.0; 3])]);
    assert!(matches!(error, Err(CoreError::JointOrder { joint: 1, .. })));
    let error = Skeleton::new(vec![joint("a", Some(0), [0.0; 3])]);
    assert!(matches!(error, Err(CoreError::JointOrder { joint: 0, .. })));
    let error = Skeleton::new(vec![joint("a", None, [0.0; 3]), joint("a", Some(0), [0.0; 3])]);
    assert!(matches!(error, Err(CoreError::DuplicateMarkerName { .. })));
}

#[test]
fn a_bent_elbow_is_where_it_should_be() {
    let skeleton = Skeleton::new(vec![
        joint("shoulder", None, [0.0; 3]),
        joint("elbow", Some(0), [0.3, 0.0, 0.0]),
        joint("wrist", Some(1), [0.25, 0.0, 0.0]),
    ])
    .unwrap();
    let quarter = std::f64::consts::FRAC_PI_2;
    let pose = Pose {
        root_m: [0.0, 0.0, 1.4],
        rotations: vec![
            Rotation::IDENTITY,
            Rotation::about([0.0, 0.0, 1.0], quarter),
            Rotation::IDENTITY,
        ],
    };
    let positions = skeleton.positions(&pose).unwrap();
    assert!(distance(positions[1], [0.3, 0.0, 1.4]) < 1e-15);
    assert!(distance(positions[2], [0.3, 0.25, 1.4]) < 1e-15);
    let short = Pose { rotations: vec![], ..pose };
    assert!(matches!(skeleton.positions(&short), Err(CoreError::PoseLength { .. })));
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-3.0..3.0_f64)
}

proptest! {
    #[test]
    fn rotations_agree_with_rodrigues(axis in vector(), angle in -7.0..7.0_f64, p in vector()) {
        prop_assume!(norm(axis) > 1e-3);
        let k = scale(1.0 / norm(axis), axis);
        let (s, c) = angle.sin_cos();
        let kp = cross(k, p);
        let along = (1.0 - c) * (k[0] * p[0] + k[1] * p[1] + k[2] * p[2]);
        let expected: [f64; 3] = std::array::from_fn(|a| c * p[a] + s * kp[a] + along * k[a]);
        let rotation = Rotation::about(axis, angle);
        // A few dozen roundings of numbers up to 10.
        prop_assert!(distance(rotation.apply(p), expected) < 1e-13);
        let m = rotation.matrix();
        let by_matrix: [f64; 3] = std::array::from_fn(|r| (0..3).map(|a| m[r][a] * p[a]).sum());
        prop_assert!(distance(by_matrix, expected) < 1e-13);
    }

    #[test]
    fn transforms_undo(axis in vector(), angle in -7.0..7.0_f64, p in vector(), by in vector()) {
        let moved = RigidTransform { rotation: Rotation::about(axis, angle), translation: by };
        prop_assert!(distance(moved.undo(moved.apply(p)), p) < 1e-13);
        let twice = moved.rotation.after(moved.rotation);
        prop_assert!(distance(twice.apply(p), moved.rotation.apply(moved.rotation.apply(p))) < 1e-13);
    }
}
