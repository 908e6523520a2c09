use mocap_core::{
    BodyFrame, BodyMarkers, CoreError, MarkerKnowledge, Mask, RigidTransform, Rotation, Take,
    UpAxis, geometry::distance,
};
use proptest::prelude::*;

use crate::take;

const REFERENCE: [[f64; 3]; 4] =
    [[-0.1, 0.1, 1.2], [-0.1, -0.1, 1.0], [0.1, 0.05, 1.3], [0.1, -0.05, 1.1]];

fn markers() -> BodyMarkers {
    BodyMarkers { back: vec![0, 1], front: vec![2, 3] }
}

/// A rigid body that walks a circle, turning through ±180°.
fn placement(t: usize, up: [f64; 3]) -> RigidTransform {
    let angle = t as f64 / 10.0;
    let (sin, cos) = angle.sin_cos();
    // A point of the horizontal plane: perpendicular to `up`, whichever axis that is.
    let (p, q) = if up[2] > 0.5 {
        ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    } else {
        ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    };
    let translation = std::array::from_fn(|a| 2.0 * cos * p[a] + 3.0 * sin * q[a]);
    RigidTransform { rotation: Rotation::about(up, angle), translation }
}

fn walking(up: [f64; 3]) -> Take {
    take(100, 4, |t, m| {
        let [x, y, z] = REFERENCE[m];
        let local = if up[2] > 0.5 { [x, y, z] } else { [y, z, x] };
        Some(placement(t, up).apply(local))
    })
}

#[test]
fn a_rigid_walker_stands_still_in_its_own_frame() {
    for (axis, up) in [([0.0, 0.0, 1.0], UpAxis::Z), ([0.0, 1.0, 0.0], UpAxis::Y)] {
        let world = walking(axis);
        let frame = BodyFrame::estimate(&world, &markers(), up).unwrap();
        let local = frame.localise(&world).unwrap();
        for (m, reference) in REFERENCE.iter().enumerate() {
            let first = local.position(0, m).unwrap();
            for t in 0..100 {
                assert!(distance(local.position(t, m).unwrap(), first) < 1e-12, "{t} {m}");
            }
            let height = if up == UpAxis::Z { first[2] } else { first[1] };
            assert!((height - reference[2]).abs() < 1e-15, "heights stay");
        }
        let mut back = local.positions().to_owned();
        frame.globalise(&mut back).unwrap();
        let error = (&back - &world.positions()).iter().fold(0.0_f64, |e, d| e.max(d.abs()));
        assert!(error < 1e-12);
    }
}

proptest! {
    /// With some reference markers hidden, a rigid body is still found exactly wherever two are seen.
    #[test]
    fn partly_hidden_references_are_fitted(
        hidden in prop::collection::vec((1_usize..100, 0_usize..4), 0..60),
    ) {
        let truth = walking([0.0, 0.0, 1.0]);
        let mask = Mask::from_fn(100, 4, |t, m| hidden.contains(&(t, m)));
        let seen = truth.hide(&mask).unwrap();
        let frame = BodyFrame::estimate(&seen, &markers(), UpAxis::Z).unwrap();
        let still = frame.localise(&truth).unwrap();
        for t in 0..100 {
            let shown = (0..4).filter(|&m| seen.is_observed(t, m)).count();
            if shown >= 2 {
                for m in 0..4 {
                    let moved = distance(still.position(t, m).unwrap(), still.position(0, m).unwrap());
                    // Two markers 0.2 m apart determine the heading to about 1e-15 / 0.2.
                    prop_assert!(moved < 1e-12, "frame {} marker {}: {}", t, m, moved);
                }
            }
        }
    }
}

#[test]
fn a_short_black_out_is_bridged() {
    let truth = walking([0.0, 0.0, 1.0]);
    let dark = Mask::from_fn(100, 4, |t, _| (30..34).contains(&t));
    let frame = BodyFrame::estimate(&truth.hide(&dark).unwrap(), &markers(), UpAxis::Z).unwrap();
    let still = frame.localise(&truth).unwrap();
    for t in 30..34 {
        // Five moves of 0.3 m on a circle of 3 m, 0.1 rad a move, whose direction the last two moves
        // tell 0.1 rad late: a fifth of the chord's sagitta, 3·(1 − cos 0.25) ≈ 0.09 m, and 1.5·0.1/8.
        assert!(distance(still.position(t, 0).unwrap(), still.position(0, 0).unwrap()) < 0.04);
    }
}

#[test]
fn a_take_without_reference_markers_has_no_body_frame() {
    let input = take(3, 4, |_, m| (m < 2).then_some([0.0; 3]));
    let error = BodyFrame::estimate(&input, &markers(), UpAxis::Z);
    assert_eq!(error, Err(CoreError::NoBodyFrame));
}

#[test]
fn the_floor_tells_which_axis_is_up() {
    // Two markers jog along the other axes while the lowest keeps its height.
    let hop = |t: usize| (t as f64 / 5.0).sin();
    let z_up = take(50, 2, |t, m| Some([hop(t), hop(t) * 2.0, m as f64]));
    let y_up = take(50, 2, |t, m| Some([hop(t), m as f64, hop(t) * 2.0]));
    let known = MarkerKnowledge::cmu_41();
    assert_eq!(UpAxis::guess(&z_up, &known), Some(UpAxis::Z));
    assert_eq!(UpAxis::guess(&y_up, &known), Some(UpAxis::Y));
    let nothing = take(2, 1, |_, _| None);
    assert_eq!(UpAxis::guess(&nothing, &known), None);
}
