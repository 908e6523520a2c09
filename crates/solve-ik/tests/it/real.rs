//! Real takes against the motion that the capture's own software fitted to the same markers.

use metrics::{JointChoice, JointFrame, joint_errors};
use mocap_core::{Motion, Rotation};
use solve_ik::{Body, IkParams, IkSolver};

use crate::{
    trials::{self, JOINTS, TRIALS},
    worn::Tracks,
};

/// Index of the joint above each of them; the root has none.
const PARENTS: [usize; 20] = [20, 0, 1, 2, 3, 4, 0, 6, 7, 0, 9, 10, 2, 12, 13, 14, 2, 16, 17, 18];

/// The most that joints of each trial may be off on average in centimetres, with bones of one's own and with those of the AMC
/// file. The reference misses its own markers by 12 to 45 mm; `docs/fidelity/solve-ik.md` says what that means.
const LIMITS: [[f64; 2]; 5] = [[1.8, 1.5], [2.3, 2.1], [4.2, 4.0], [4.8, 4.6], [6.1, 5.9]];

/// Mean position error in cm, and mean local and global orientation errors in degrees.
fn score(found: &Motion, truth: &Motion) -> [f64; 3] {
    let joints = |motion: &Motion| JOINTS.map(|name| motion.skeleton().find(name).unwrap());
    let track = |motion: &Motion| Tracks::some(motion, &joints(motion), Rotation::IDENTITY);
    let (found, truth) = (track(found), track(truth));
    // The nearest compared joint above each; local angles are between those.
    let parents: Vec<Option<usize>> = PARENTS.iter().map(|&p| (p < 20).then_some(p)).collect();
    let errors = |frame| {
        joint_errors(&truth.poses(), &found.poses(), &parents, frame, &JointChoice::All).unwrap()
    };
    let (world, local) = (errors(JointFrame::World), errors(JointFrame::Parent));
    [0.1 * world.jpe_mean_mm, local.joe_mean_deg, world.joe_mean_deg]
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn joints_lie_where_the_capture_software_found_them() {
    let Some(folder) = mocap_testkit::recording("cmu/paired") else { return };
    for (names, limits) in TRIALS.into_iter().zip(LIMITS) {
        let Some((take, truth)) = trials::read(names, &folder) else { continue };
        let trial = names.0;
        let known = Body::cmu_41().on(truth.skeleton().clone()).unwrap();
        let bodies = [("own bones", Body::cmu_41()), ("bones of the AMC", known)];
        for ((variant, body), limit) in bodies.into_iter().zip(limits) {
            let solver = IkSolver::new(body, IkParams::default()).unwrap();
            let solution = solver.solve(&take).unwrap();
            let [off, local, global] = score(&solution.motion, &truth);
            let missed = 1e3 * mean(&solution.residual_m);
            println!(
                "{trial}, {variant}: JPE {off:.2} cm, JOE {local:.1}° local, {global:.1}° global, markers missed by {missed:.1} mm, \
                 {:.1} steps a frame, {} of {} frames unsettled",
                solution.steps as f64 / take.frames() as f64,
                solution.unconverged,
                take.frames(),
            );
            assert!(off < limit, "{trial}, {variant}: {off} cm");
            assert!(missed < 9.0, "{trial}, {variant}: {missed} mm");
        }
    }
}

/// What no solver can beat that explains the markers: bones, and the places of the markers on them, from the reference
/// itself. How far its joints are from that pose is how far it is from its own markers.
#[test]
fn a_body_learnt_from_a_reference_comes_as_near_to_it_as_its_markers_let_it() {
    let Some(folder) = mocap_testkit::recording("cmu/paired") else { return };
    let fixed = IkParams { calibration_rounds: 0, ..IkParams::default() };
    let learn = |names| {
        let (take, truth) = trials::read(names, &folder)?;
        let body = Body::cmu_41().worn(&take, &truth).unwrap();
        Some((take, truth, body))
    };
    for names in TRIALS {
        let Some((take, truth, body)) = learn(names) else { continue };
        let trial = names.0;
        let misses = body.to_string();
        let spread = |line: &str| -> Option<f64> {
            let name = line.strip_prefix("marker ")?.split(' ').next()?;
            (0..take.marker_count()).find(|&m| take.markers().split(m).1 == name)?;
            line.rsplit(' ').next()?.parse().ok()
        };
        let squares: Vec<f64> = misses.lines().filter_map(spread).map(|s| 3.0 * s * s).collect();
        let solution = IkSolver::new(body, fixed).unwrap().solve(&take).unwrap();
        let [off, local, _] = score(&solution.motion, &truth);
        println!(
            "{trial}: the reference misses its markers by {:.1} mm rms; with its bones and places JPE {off:.2} cm, JOE {local:.1}°",
            1e3 * mean(&squares).sqrt()
        );
        assert!(off < 3.0, "{trial}: {off} cm");
    }
    // From one take of a session to the other.
    for (from, to) in [("135_02", "135_07"), ("135_07", "135_02")] {
        let (Some((_, _, body)), Some((take, truth, _))) =
            (learn((from, "135")), learn((to, "135")))
        else {
            continue;
        };
        let solution = IkSolver::new(body, fixed).unwrap().solve(&take).unwrap();
        let [off, local, _] = score(&solution.motion, &truth);
        println!("{to} with the body learnt from {from}: JPE {off:.2} cm, JOE {local:.1}°");
        assert!(off < 4.5, "{to}: {off} cm");
    }
}
