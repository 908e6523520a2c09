//! Figures of solved motions.

use std::path::Path;

use mocap_core::{Joint, Motion, Pose, Rotation, Skeleton, Take, UpAxis};
use mocap_report::{MotionPlot, ReportError, animate_motion, plot_motion};

use crate::{gap, hide, take, xml};

/// A leg that swings while it walks, of as many frames as a take.
fn motion(frames: usize) -> Motion {
    let joint =
        |name: &str, parent, z| Joint { name: name.into(), parent, offset_m: [0.0, 0.0, z] };
    let skeleton = Skeleton::new(vec![
        joint("hip", None, 0.0),
        joint("knee", Some(0), -0.4),
        joint("ankle", Some(1), -0.4),
    ]);
    let pose = |t: usize| Pose {
        root_m: [0.02 * t as f64, 0.0, 0.9],
        rotations: vec![Rotation::exp([0.0, 0.3 * (0.2 * t as f64).sin(), 0.0]); 3],
    };
    Motion::new(skeleton.unwrap(), 100.0, (0..frames).map(pose).collect()).unwrap()
}

fn plot<'a>(motion: &'a Motion, take: &'a Take, residual_m: &'a [f64]) -> MotionPlot<'a> {
    MotionPlot { title: "a <leg> & more", motion, take, residual_m, up: UpAxis::Z }
}

#[test]
fn stills_and_animation_are_well_formed_and_show_bones_and_markers() {
    let take = take(&["A", "B"], 50);
    let gappy = hide(&take, &[gap(0, 10..20), gap(1, 10..20)]);
    let motion = motion(50);
    let residual_m: Vec<f64> =
        (0..50).map(|t| if (10..20).contains(&t) { f64::NAN } else { 0.002 }).collect();
    let plot = plot(&motion, &gappy, &residual_m);
    let still = String::from_utf8(plot_motion(&plot, Path::new("a.svg")).unwrap()).unwrap();
    xml::check(&still).unwrap();
    // Two bones and two markers at six moments, one of them in the dark, and frame, grid and curve.
    assert_eq!(
        still.matches("<circle").count() + still.matches("<ellipse").count(),
        2 * 5,
        "{still}"
    );
    assert!(plot_motion(&plot, Path::new("a.png")).unwrap().starts_with(b"\x89PNG"));
    let film = String::from_utf8(animate_motion(&plot).unwrap()).unwrap();
    xml::check(&film).unwrap();
    let values = film.split("values=\"").nth(1).unwrap().split('"').next().unwrap();
    assert_eq!(values.split(';').count(), 10, "50 frames at 100 Hz are ten pictures at 20 Hz");
    assert!(values.split(';').all(|picture| picture.matches('M').count() == 2));
}

#[test]
fn a_motion_of_another_length_is_refused_and_an_empty_one_is_not() {
    let take = take(&["A"], 50);
    let motion = motion(49);
    let error = plot_motion(&plot(&motion, &take, &[0.0; 49]), Path::new("a.svg")).unwrap_err();
    assert!(matches!(error, ReportError::Shape { .. }));
    let error = plot_motion(&plot(&motion, &take, &[0.0; 49]), Path::new("a.gif")).unwrap_err();
    assert!(matches!(error, ReportError::Format { .. }));
    let none = self::motion(0);
    let empty = crate::take(&["A"], 0);
    assert!(plot_motion(&plot(&none, &empty, &[]), Path::new("a.svg")).is_ok());
    assert!(animate_motion(&plot(&none, &empty, &[])).is_ok());
}
