//! Body files: what they say, and what they may not say.

use std::sync::Arc;

use mocap_core::{CoreError, Joint, Motion, RigidTransform, Rotation, Skeleton};
use mocap_synth::Activity;
use solve_ik::{Body, IkError};

use crate::worn::{record, synthetic_body};

const SMALL: &str = "joint hips\njoint knee hips 0 -0.4 0\nspread knee 70 6 1 0 0\nlimit knee -5 160\nt-pose knee 0 0 -20\n\
    marker A hips 0.1 0 0\nmarker B hips 0 0 0.1 share knee 0.5\nalias B Bee\n";

#[test]
fn a_written_body_is_read_back() {
    for body in [Body::cmu_41(), synthetic_body(), Body::parse(SMALL, "small").unwrap()] {
        let text = body.to_string();
        let again = Body::parse(&text, "again").unwrap();
        assert_eq!(again.to_string(), text);
        assert!(body.markers().eq(again.markers()));
        assert_eq!(body.skeleton().joints().len(), again.skeleton().joints().len());
    }
}

#[test]
fn a_wrong_line_is_named() {
    let broken = |line: &str, expected: &str| {
        let error = Body::parse(&format!("{SMALL}{line}\n"), "my.body").unwrap_err();
        let IkError::BodyLine { line: 9, ref file, rule, .. } = error else { panic!("{error}") };
        assert_eq!(file, "my.body");
        assert!(rule.contains(expected), "{line}: {error}");
    };
    broken("joint toe ankle 0 0 0", "parents come first");
    broken("joint knee hips 0 0 0", "unique");
    broken("joint toe toe 0 0 0", "parents come first");
    broken("joint other", "one joint is the root");
    broken("joint toe knee 0 nan 0", "finite");
    broken("joint toe knee 0 0", "three numbers");
    broken("spread knee 0", "above 0");
    broken("spread knee 10 5 0 0 0", "direction");
    broken("limit knee 9 9", "below");
    broken("t-pose knee 20", "three numbers");
    broken("marker a hips 0 0 0", "unique");
    broken("marker C hips 0 0 0 share knee 1", "between 0 and 1");
    broken("marker C hips 0 0 0 spread -1", "above 0");
    broken("marker C hips 0 0 0 stuck", "share JOINT SHARE");
    broken("alias D Dee", "before it is used");
    broken("bone A B", "a line is");
    assert!(matches!(Body::parse("", "x"), Err(IkError::EmptyBody { what: "joint", .. })));
    assert!(matches!(Body::parse("joint a", "x"), Err(IkError::EmptyBody { what: "marker", .. })));
    let apart = "joint a\njoint b a 0 0 0\njoint c a 0 0 0\nmarker M b 0 0 0 share c 0.5";
    assert!(matches!(Body::parse(apart, "x"), Err(IkError::NotNeighbours { .. })));
}

#[test]
fn markers_move_to_a_skeleton_of_the_same_names_only() {
    let body = Body::parse(SMALL, "small").unwrap();
    let joint =
        |name: &str, parent| Joint { name: name.into(), parent, offset_m: [0.0, -0.5, 0.0] };
    let skeleton =
        Skeleton::new(vec![joint("hips", None), joint("spine", Some(0)), joint("knee", Some(0))]);
    let on = body.clone().on(Arc::new(skeleton.unwrap())).unwrap();
    assert_eq!(on.skeleton().joints()[2].offset_m[1], -0.5);
    let error = body.on(Skeleton::new(vec![joint("hips", None)]).unwrap()).unwrap_err();
    assert!(
        matches!(&error, IkError::NoSuchJoint { marker, joint } if marker == "B" && joint == "knee")
    );
    // A ring of joints is no skeleton to begin with, in a body file neither.
    let error =
        Body::parse("joint r\njoint a b 0 0 0\njoint b a 0 0 0\n", "ring.body").unwrap_err();
    assert!(matches!(error, IkError::BodyLine { line: 2, .. }), "{error}");
    let ring = Skeleton::new(vec![joint("a", Some(1)), joint("b", Some(0))]);
    assert!(matches!(ring, Err(CoreError::JointOrder { .. })));
}

#[test]
fn a_motion_that_is_not_of_the_take_teaches_no_body() {
    let recorded = record(Activity::Walk, 40, 1);
    let learn = |motion: &Motion| synthetic_body().worn(recorded.take(), motion);
    assert!(learn(recorded.motion()).is_ok());
    let lying = RigidTransform {
        rotation: Rotation::about([1.0, 0.0, 0.0], std::f64::consts::FRAC_PI_2),
        translation: [0.0; 3],
    };
    let error = learn(&recorded.motion().transformed(&lying).unwrap()).unwrap_err();
    assert!(matches!(error, IkError::Apart { rms_m } if rms_m > 0.5), "{error}");
    assert!(error.to_string().contains("same units and axes"), "{error}");
    let shorter = record(Activity::Walk, 39, 1);
    let error = learn(shorter.motion()).unwrap_err();
    assert!(matches!(error, IkError::Frames { frames: 40, poses: 39 }), "{error}");
}
