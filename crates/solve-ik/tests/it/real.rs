//! Real takes against the motion that the capture's own software fitted to the same markers.

use std::path::Path;

use mocap_core::{JointFrames, Rotation, Take, geometry::distance};
use mocap_io::{MarkerFile, MotionFile, ReadOptions};
use solve_ik::{Body, IkParams, IkSolver, Solution};

/// Joints that are compared: all that markers tell of, toes left out, for which the AMC files are inexact.
const JOINTS: [&str; 20] = [
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

/// Trial, skeleton, and the most that joints may be off on average in centimetres, with bones of one's own and with those of
/// the AMC file. The reference misses its own markers by 12 to 45 mm; `docs/fidelity/solve-ik.md` says what that means.
const TRIALS: [(&str, &str, [f64; 2]); 5] = [
    ("02_01", "02", [1.8, 1.5]),
    ("127_07", "127", [2.3, 2.1]),
    ("05_13", "05", [4.2, 4.0]),
    ("135_02", "135", [4.8, 4.6]),
    ("135_07", "135", [6.1, 5.9]),
];

fn markers(trial: &str, folder: &Path) -> Option<Take> {
    let file = folder.join(format!("{trial}.c3d"));
    if file.exists() {
        let read = MarkerFile::read(&file, &ReadOptions::default()).unwrap();
        return Some(read.take().clone());
    }
    mocap_testkit::motion(trial)
}

/// Mean distances in metres and angles in degrees over frames and joints.
struct Score {
    positions: Vec<f64>,
    global: Vec<f64>,
    local: Vec<f64>,
}

fn score(solution: &Solution, truth: &MotionFile) -> Score {
    let (here, there) = (solution.motion.skeleton(), truth.motion().skeleton());
    let pairs: Vec<(usize, usize)> =
        JOINTS.iter().map(|name| (here.find(name).unwrap(), there.find(name).unwrap())).collect();
    let mut score = Score { positions: vec![0.0; 20], global: vec![0.0; 20], local: vec![0.0; 20] };
    // The axes of CMU's marker files are (z, x, y) of its AMC files.
    let third = std::f64::consts::TAU / 3.0;
    let map = Rotation::about([1.0, 1.0, 1.0], third);
    let frames = truth.motion().poses().len();
    assert_eq!(solution.motion.poses().len(), frames);
    for (p, q) in solution.motion.poses().iter().zip(truth.motion().poses()) {
        let a: JointFrames = here.frames(p).unwrap();
        let b = there.frames(q).unwrap();
        for (k, &(i, j)) in pairs.iter().enumerate() {
            let [x, y, z] = b.origins_m[j];
            score.positions[k] += distance(a.origins_m[i], [z, x, y]) / frames as f64;
            let global = a.rotations[i].inverse().after(map.after(b.rotations[j]));
            score.global[k] += global.angle().to_degrees() / frames as f64;
            let turned = if k == 0 { map.after(q.rotations[j]) } else { q.rotations[j] };
            let local = p.rotations[i].inverse().after(turned);
            score.local[k] += local.angle().to_degrees() / frames as f64;
        }
    }
    score
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn joints_lie_where_the_capture_software_found_them() {
    let Some(folder) = mocap_testkit::recording("cmu/paired") else { return };
    for (trial, subject, limits) in TRIALS {
        let Some(take) = markers(trial, &folder) else { continue };
        let asf = folder.join(format!("{subject}.asf"));
        let truth = folder.join(format!("{trial}.amc"));
        let truth = MotionFile::read(&truth, Some(&asf), &ReadOptions::default()).unwrap();
        let known = Body::cmu_41().on(truth.motion().skeleton().clone()).unwrap();
        let bodies = [("own bones", Body::cmu_41()), ("bones of the AMC", known)];
        for ((variant, body), limit) in bodies.into_iter().zip(limits) {
            let solver = IkSolver::new(body, IkParams::default()).unwrap();
            let solution = solver.solve(&take).unwrap();
            let score = score(&solution, &truth);
            let (off, missed) = (100.0 * mean(&score.positions), 1e3 * mean(&solution.residual_m));
            println!(
                "{trial}, {variant}: JPE {off:.2} cm, JOE {:.1}° local, {:.1}° global, markers missed by {missed:.1} mm, \
                 {:.1} steps a frame, {} of {} frames unsettled",
                mean(&score.local),
                mean(&score.global),
                solution.steps as f64 / take.frames() as f64,
                solution.unconverged,
                take.frames(),
            );
            assert!(off < limit, "{trial}, {variant}: {off} cm");
            assert!(missed < 9.0, "{trial}, {variant}: {missed} mm");
        }
    }
}
