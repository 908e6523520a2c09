//! Five real takes whose joint motion the capture's own software fitted to the same markers.

use std::path::Path;

use mocap_core::{Motion, RigidTransform, Rotation, Take};
use mocap_io::{MarkerFile, MotionFile, ReadOptions};

/// Joints that are compared: all that markers tell of, toes left out, for which the AMC files are inexact.
pub const JOINTS: [&str; 20] = [
    "root",
    "upperback",
    "thorax",
    "lowerneck",
    "upperneck",
    "head",
    "lfemur",
    "ltibia",
    "lfoot",
    "rfemur",
    "rtibia",
    "rfoot",
    "lhumerus",
    "lradius",
    "lwrist",
    "lhand",
    "rhumerus",
    "rradius",
    "rwrist",
    "rhand",
];

/// Names of the trials and of their subjects' skeletons.
pub const TRIALS: [(&str, &str); 5] =
    [("02_01", "02"), ("127_07", "127"), ("05_13", "05"), ("135_02", "135"), ("135_07", "135")];

/// A take, and the reference motion in the axes of the marker files: (z, x, y) of those of the AMC files. `None` where the
/// markers are not there.
pub fn read((trial, subject): (&str, &str), folder: &Path) -> Option<(Take, Motion)> {
    let take = markers(trial, folder)?;
    let [asf, amc] =
        [format!("{subject}.asf"), format!("{trial}.amc")].map(|file| folder.join(file));
    let read = MotionFile::read(&amc, Some(&asf), &ReadOptions::default()).unwrap();
    let rotation = Rotation::about([1.0; 3], std::f64::consts::TAU / 3.0);
    let by = RigidTransform { rotation, translation: [0.0; 3] };
    Some((take, read.motion().transformed(&by).unwrap()))
}

fn markers(trial: &str, folder: &Path) -> Option<Take> {
    let file = folder.join(format!("{trial}.c3d"));
    if file.exists() {
        let read = MarkerFile::read(&file, &ReadOptions::default()).unwrap();
        return Some(read.take().clone());
    }
    mocap_testkit::motion(trial)
}
