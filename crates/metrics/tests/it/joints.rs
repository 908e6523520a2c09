use std::f64::consts::PI;

use metrics::{JointChoice, JointErrors, JointFrame, JointPoses, MetricError, joint_errors};
use mocap_core::Rotation;
use ndarray::{Array3, Array4};
use proptest::prelude::*;

/// A root, a joint 1 m up, and a leaf 1 m further.
const PARENTS: [Option<usize>; 3] = [None, Some(0), Some(1)];

struct Poses {
    positions: Array3<f64>,
    rotations: Array4<f64>,
}

impl Poses {
    /// One frame of the chain: each joint turned relative to its parent about x.
    fn chain(radians: [f64; 3]) -> Self {
        Self::of(Rotation::IDENTITY, [0.0; 3], radians.map(|a| Rotation::about([1.0, 0.0, 0.0], a)))
    }

    fn of(world: Rotation, root: [f64; 3], turns: [Rotation; 3]) -> Self {
        let (mut positions, mut rotations) =
            (Array3::zeros((1, 3, 3)), Array4::zeros((1, 3, 3, 3)));
        let (mut at, mut turned) = (root, world);
        for (j, turn) in turns.into_iter().enumerate() {
            if j > 0 {
                let bone = turned.apply([0.0, 0.0, 1.0]);
                at = std::array::from_fn(|a| at[a] + bone[a]);
            }
            turned = turned.after(turn);
            for a in 0..3 {
                positions[(0, j, a)] = at[a];
                for b in 0..3 {
                    rotations[(0, j, a, b)] = turned.matrix()[a][b];
                }
            }
        }
        Self { positions, rotations }
    }

    fn view(&self) -> JointPoses<'_> {
        JointPoses::new(self.positions.view(), self.rotations.view()).unwrap()
    }
}

fn errors(truth: &Poses, found: &Poses, frame: JointFrame, choice: &JointChoice) -> JointErrors {
    joint_errors(&truth.view(), &found.view(), &PARENTS, frame, choice).unwrap()
}

fn each(errors: &JointErrors) -> Vec<(f64, f64)> {
    errors.per_joint.iter().map(|joint| (joint.jpe_mean_mm, joint.joe_mean_deg)).collect()
}

#[track_caller]
fn assert_each(found: &JointErrors, expected: &[(f64, f64)]) {
    let found = each(found);
    assert_eq!(found.len(), expected.len());
    for ((p, q), (x, y)) in found.iter().zip(expected) {
        // Some roundings of a metre and of a right angle.
        assert!((p - x).abs() < 1e-9 && (q - y).abs() < 1e-9, "({p}, {q}) for ({x}, {y})");
    }
}

#[test]
fn an_error_of_one_joint_by_hand() {
    // The middle joint is turned by a right angle: what hangs on it swings, and turns along.
    let (truth, bent) = (Poses::chain([0.0; 3]), Poses::chain([0.0, PI / 2.0, 0.0]));
    let (all, swing) = (JointChoice::All, 1000.0 * 2.0_f64.sqrt());
    let world = errors(&truth, &bent, JointFrame::World, &all);
    assert_each(&world, &[(0.0, 0.0), (0.0, 90.0), (swing, 90.0)]);
    assert!((world.jpe_mean_mm - swing / 3.0).abs() < 1e-9);
    assert!((world.joe_median_deg - 90.0).abs() < 1e-9 && world.jpe_median_mm.abs() < 1e-9);
    // Seen from its parent, no other joint is wrong.
    assert_each(
        &errors(&truth, &bent, JointFrame::Parent, &all),
        &[(0.0, 0.0), (0.0, 90.0), (0.0, 0.0)],
    );
    // Seen from the bent joint, as a hand from its wrist, it is the rest that is turned.
    assert_each(
        &errors(&truth, &bent, JointFrame::Joint(1), &all),
        &[(swing, 90.0), (0.0, 0.0), (0.0, 0.0)],
    );
}

#[test]
fn choices_of_joints() {
    let (truth, bent) = (Poses::chain([0.0; 3]), Poses::chain([0.0, PI / 2.0, 0.0]));
    let inner = errors(&truth, &bent, JointFrame::World, &JointChoice::WithoutLeaves);
    assert_each(&inner, &[(0.0, 0.0), (0.0, 90.0)]);
    let leaf = errors(&truth, &bent, JointFrame::World, &JointChoice::These(vec![2]));
    assert_eq!((leaf.samples, leaf.per_joint[0].joint), (1, 2));
}

#[test]
fn small_and_straight_angles_are_exact() {
    // The arc cosine would lose the first in rounding.
    for angle in [0.0, 1e-9, 1e-4, 3.0, PI - 1e-7, PI] {
        let found = errors(
            &Poses::chain([0.0; 3]),
            &Poses::chain([angle, 0.0, 0.0]),
            JointFrame::Parent,
            &JointChoice::All,
        );
        assert!((found.per_joint[0].joe_mean_deg - angle.to_degrees()).abs() < 1e-10, "{angle}");
    }
}

#[test]
fn unknown_joints_are_counted_apart() {
    let (truth, mut found) = (Poses::chain([0.0; 3]), Poses::chain([0.0; 3]));
    found.positions[(0, 1, 0)] = f64::NAN;
    let world = errors(&truth, &found, JointFrame::World, &JointChoice::All);
    assert_eq!((world.samples, world.unknown, world.per_joint[1].frames), (2, 1, 0));
    assert!(world.per_joint[1].jpe_mean_mm.is_nan() && world.jpe_mean_mm.abs() < 1e-9);
    // The leaf cannot be seen from a parent whose place is unknown.
    let local = errors(&truth, &found, JointFrame::Parent, &JointChoice::All);
    assert_eq!((local.samples, local.unknown), (1, 2));
}

#[test]
fn what_does_not_fit_is_refused() {
    let (poses, choice) = (Poses::chain([0.0; 3]), JointChoice::All);
    let refused = |parents: &[Option<usize>], frame, choice: &JointChoice| {
        joint_errors(&poses.view(), &poses.view(), parents, frame, choice).unwrap_err()
    };
    assert!(matches!(
        refused(&PARENTS[..2], JointFrame::World, &choice),
        MetricError::JointShape { what: "the list of parents", .. }
    ));
    let no_joint = MetricError::Joint { joint: 7, joints: 3 };
    assert_eq!(refused(&PARENTS, JointFrame::Joint(7), &choice), no_joint);
    assert_eq!(refused(&[None, Some(7), None], JointFrame::World, &choice), no_joint);
    assert_eq!(refused(&PARENTS, JointFrame::World, &JointChoice::These(vec![7])), no_joint);
    let none = JointChoice::These(Vec::new());
    assert_eq!(refused(&PARENTS, JointFrame::World, &none), MetricError::NoJoint);

    let mut mirror = Poses::chain([0.0; 3]);
    mirror.rotations[(0, 2, 0, 0)] = -1.0;
    let error = JointPoses::new(mirror.positions.view(), mirror.rotations.view()).unwrap_err();
    assert!(matches!(error, MetricError::Rotation { frame: 0, joint: 2, .. }), "{error}");
    let (flat, wide) = (Array3::zeros((1, 3, 2)), Array4::zeros((1, 3, 3, 3)));
    assert!(JointPoses::new(flat.view(), wide.view()).is_err());
    let (short, long) = (Array3::zeros((1, 2, 3)), Array4::zeros((1, 3, 3, 3)));
    assert!(JointPoses::new(short.view(), long.view()).is_err());
    let two = Poses { positions: Array3::zeros((0, 3, 3)), rotations: Array4::zeros((0, 3, 3, 3)) };
    let frames = joint_errors(&poses.view(), &two.view(), &PARENTS, JointFrame::World, &choice);
    assert!(matches!(frames, Err(MetricError::JointShape { what: "the solved motion", .. })));
    let empty = errors(&two, &two, JointFrame::World, &choice);
    assert!(empty.samples == 0 && empty.jpe_mean_mm.is_nan());
}

fn rotation() -> impl Strategy<Value = Rotation> {
    ([-1.0..1.0, -1.0..1.0, -1.0..1.0], -3.0..3.0_f64)
        .prop_map(|(axis, angle)| Rotation::about(axis, angle))
}

proptest! {
    /// Local and wrist-relative errors do not know where the body stands; global ones do not if both do.
    #[test]
    fn moving_the_body_changes_what_it_should(
        a in [rotation(), rotation(), rotation()],
        b in [rotation(), rotation(), rotation()],
        world in rotation(),
        root in [-2.0..2.0, -2.0..2.0, -2.0..2.0],
    ) {
        let here = |turns| Poses::of(Rotation::IDENTITY, [0.0; 3], turns);
        let there = |turns| Poses::of(world, root, turns);
        let all = JointChoice::All;
        let close = |x: &JointErrors, y: &JointErrors| {
            // Angles near 180° amplify rounding: a sine of 1e-15 stands beside a cosine of 1.
            each(x).iter().zip(each(y)).all(|((p, q), (r, s))| {
                (p - r).abs() < 1e-8 && (q - s).abs() < 1e-5
            })
        };
        for frame in [JointFrame::World, JointFrame::Parent, JointFrame::Joint(1)] {
            let both = errors(&there(a), &there(b), frame, &all);
            prop_assert!(close(&errors(&here(a), &here(b), frame, &all), &both));
        }
        let hand = JointChoice::These(vec![2]);
        let moved = errors(&here(a), &there(b), JointFrame::Joint(1), &hand);
        prop_assert!(close(&errors(&here(a), &here(b), JointFrame::Joint(1), &hand), &moved));
        // From either side the error is the same, and a motion has none against itself.
        let there_and_back = errors(&here(b), &here(a), JointFrame::World, &all);
        prop_assert!(close(&errors(&here(a), &here(b), JointFrame::World, &all), &there_and_back));
        let own = errors(&here(a), &here(a), JointFrame::Parent, &all);
        prop_assert!(own.jpe_p95_mm < 1e-8 && own.joe_p95_deg < 1e-5);
    }

    /// The formula of the docs, where it is well conditioned.
    #[test]
    fn angles_are_the_arc_cosine_of_the_trace(a in rotation(), b in rotation()) {
        let i = Rotation::IDENTITY;
        let found = errors(
            &Poses::of(i, [0.0; 3], [a, i, i]),
            &Poses::of(i, [0.0; 3], [b, i, i]),
            JointFrame::World,
            &JointChoice::These(vec![0]),
        );
        let between = b.inverse().after(a).matrix();
        let cosine = 0.5 * (between[0][0] + between[1][1] + between[2][2] - 1.0);
        prop_assume!(cosine.abs() < 0.999);
        prop_assert!((found.joe_mean_deg - cosine.acos().to_degrees()).abs() < 1e-9);
    }
}
