//! Where a solve and the capture software's own motion differ: how much of it is one offset on each bone, how far each of
//! the two is from the markers, and whether other subjects' references tell where this one has its joints.
//!
//! ```sh
//! MOCAP_DATA=… cargo run --release -p solve-ik --example against_reference
//! ```
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a tool for developers")]

use std::{collections::HashMap, path::Path};

use mocap_core::{
    JointFrames, Motion, Take,
    geometry::{add, distance, norm, scale, sub},
};
use solve_ik::{Body, IkParams, IkSolver, Solution};

#[path = "../tests/it/trials.rs"]
mod trials;

use trials::{JOINTS, TRIALS};

/// Joints that never turn in the reference, and hinges.
const STIFF: &str = "spread ltibia 70 0.5 0.940 0.342 0\nspread rtibia 70 0.5 0.940 -0.342 0\n\
    spread lradius 70 0.5 0 -0.866 0.5\nspread rradius 70 0.5 0 0.866 -0.5\n\
    spread lwrist 60 0.5 1 0 0\nspread rwrist 60 0.5 1 0 0\nspread lhand 1 25 1 0 0\n\
    spread rhand 1 25 1 0 0\nrigid lclavicle\nrigid rclavicle\n";

fn main() {
    let Some(folder) = mocap_testkit::recording("cmu/paired") else { return };
    println!("JPE in cm: all of it / its constant part, on the reference's bone / what varies");
    let mut table: Vec<Vec<String>> = JOINTS.iter().map(|j| vec![format!("| {j}")]).collect();
    table.push(vec!["| mean".into()]);
    for names in TRIALS {
        let Some((take, truth)) = trials::read(names, &folder) else { continue };
        let trial = names.0;
        let frames = frames(&truth);
        let known = Body::cmu_41().on(truth.skeleton().clone()).unwrap();
        let solution =
            IkSolver::new(known.clone(), IkParams::default()).unwrap().solve(&take).unwrap();
        let mut sums = [0.0; 3];
        for (joint, row) in JOINTS.iter().zip(&mut table) {
            let parts = parts(joint, &truth, &frames, &solution);
            row.push(format!("{:.1} / {:.1} / {:.1}", parts[0], parts[1], parts[2]));
            (0..3).for_each(|k| sums[k] += parts[k] / JOINTS.len() as f64);
        }
        table[JOINTS.len()].push(format!("{:.1} / {:.1} / {:.1}", sums[0], sums[1], sums[2]));
        own_model(trial, &take, &truth, &frames);
        let misses = |later: isize, scale: f64| theirs(&take, &known, &frames, later, scale);
        println!(
            "{trial}: {:.1} mm as it is; a frame earlier or later {:.1} and {:.1}; a percent smaller or larger {:.1} and {:.1}",
            misses(0, 1.0),
            misses(-1, 1.0),
            misses(1, 1.0),
            misses(0, 1.01),
            misses(0, 0.99)
        );
    }
    held_out(&folder);
    println!("| joint | {} |", TRIALS.map(|t| t.0).join(" | "));
    println!("|---|---|---|---|---|---|");
    for row in table {
        println!("{} |", row.join(" | "));
    }
}

/// Places of markers as the references of the other subjects have them on average, for a subject who is none of them.
fn held_out(folder: &Path) {
    let learn = |(trial, subject): (&str, &'static str)| {
        let (take, truth) = trials::read((trial, subject), folder)?;
        let body = Body::cmu_41().worn(&take, &truth).unwrap();
        // Only markers that the take has were learnt.
        let is_worn =
            |name: &str| (0..take.marker_count()).any(|m| take.markers().split(m).1 == name);
        let places: HashMap<String, [f64; 3]> = body
            .places()
            .filter(|(name, ..)| is_worn(name))
            .map(|(name, _, place)| (name.to_owned(), place))
            .collect();
        Some((subject, places))
    };
    // One take a subject.
    let learnt: Vec<_> = TRIALS[..4].iter().copied().filter_map(learn).collect();
    for (trial, subject) in TRIALS {
        let Some((take, truth)) = trials::read((trial, subject), folder) else { continue };
        let frames = frames(&truth);
        let mut text = String::new();
        for line in Body::cmu_41().to_string().lines() {
            let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
            if words[0] == "marker" {
                let others = learnt.iter().filter(|(s, _)| *s != subject);
                let places: Vec<[f64; 3]> =
                    others.filter_map(|(_, places)| places.get(&words[1]).copied()).collect();
                let mean =
                    scale(1.0 / places.len() as f64, places.iter().copied().fold([0.0; 3], add));
                if !places.is_empty() {
                    words.splice(3..6, mean.map(|c| c.to_string()));
                }
            }
            text += &words.join(" ");
            text.push('\n');
        }
        let body = Body::parse(&text, "others").unwrap();
        let known = body.clone().on(truth.skeleton().clone()).unwrap();
        let off = [body, known].map(|body| {
            let solution = IkSolver::new(body, IkParams::default()).unwrap().solve(&take).unwrap();
            let off = JOINTS.iter().map(|joint| parts(joint, &truth, &frames, &solution)[0]);
            off.sum::<f64>() / JOINTS.len() as f64
        });
        println!(
            "{trial}: with places learnt from the other subjects' references JPE {:.2} cm, {:.2} with its bones",
            off[0], off[1]
        );
    }
}

/// The solver with all of the reference's model: its bones, its stiff joints, and its markers where they suit it best.
fn own_model(trial: &str, take: &Take, truth: &Motion, frames: &[JointFrames]) {
    let text = Body::cmu_41().to_string();
    let cut = text.find("marker ").unwrap();
    let stiff = Body::parse(&format!("{}{STIFF}{}", &text[..cut], &text[cut..]), trial).unwrap();
    let body = stiff.worn(take, truth).unwrap();
    let places: Vec<(String, usize, [f64; 3])> =
        body.places().map(|(name, joint, place)| (name.to_owned(), joint, place)).collect();
    let params = IkParams { calibration_rounds: 0, ..IkParams::default() };
    let solution = IkSolver::new(body, params).unwrap().solve(take).unwrap();
    let (mut theirs, mut ours, mut count) = (0.0, 0.0, 0.0);
    for (name, joint, place) in places {
        let Some(m) = (0..take.marker_count()).find(|&m| take.markers().split(m).1 == name) else {
            continue;
        };
        for (t, frame) in frames.iter().enumerate() {
            let Some(at) = take.position(t, m) else { continue };
            let expected = add(frame.origins_m[joint], frame.rotations[joint].apply(place));
            theirs += distance(expected, at).powi(2);
            ours += distance(std::array::from_fn(|a| solution.markers[(t, m, a)]), at).powi(2);
            count += 1.0;
        }
    }
    let rms = |sum: f64| 1e3 * (sum / count).sqrt();
    let off: f64 = JOINTS.iter().map(|joint| parts(joint, truth, frames, &solution)[0]).sum();
    println!(
        "{trial}: in its own model the reference misses the markers by {:.1} mm rms, and this solve by {:.1}, {:.2} cm away",
        rms(theirs),
        rms(ours),
        off / JOINTS.len() as f64
    );
}

/// By how much the reference misses the markers, each at the place that suits it best, in mm (rms), if it is moved in time by
/// some frames and the markers are scaled.
fn theirs(take: &Take, body: &Body, frames: &[JointFrames], later: isize, by: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (name, joint, _) in body.places() {
        let Some(m) = (0..take.marker_count()).find(|&m| take.markers().split(m).1 == name) else {
            continue;
        };
        let local = |(t, frame): (usize, &JointFrames)| {
            let at =
                take.position(t.checked_add_signed(later).filter(|&t| t < take.frames())?, m)?;
            Some(frame.rotations[joint].inverse().apply(sub(scale(by, at), frame.origins_m[joint])))
        };
        let places: Vec<[f64; 3]> = frames.iter().enumerate().filter_map(local).collect();
        let mean = scale(1.0 / places.len() as f64, places.iter().copied().fold([0.0; 3], add));
        sum += places.iter().map(|p| distance(*p, mean).powi(2)).sum::<f64>();
        count += places.len() as f64;
    }
    1e3 * f64::sqrt(sum / count)
}

/// Mean distance of a joint from the reference's in cm, the length of the mean difference as seen from the reference's bone, and
/// the mean distance from there.
fn parts(joint: &str, truth: &Motion, frames: &[JointFrames], solution: &Solution) -> [f64; 3] {
    let find = |motion: &Motion| motion.skeleton().find(joint).unwrap();
    let (a, b) = (find(&solution.motion), find(truth));
    let skeleton = solution.motion.skeleton();
    let local = |(pose, frame): (&mocap_core::Pose, &JointFrames)| {
        let off = sub(skeleton.positions(pose).unwrap()[a], frame.origins_m[b]);
        frame.rotations[b].inverse().apply(off)
    };
    let offs: Vec<[f64; 3]> = solution.motion.poses().iter().zip(frames).map(local).collect();
    let share = 100.0 / offs.len() as f64;
    let mean = scale(share / 100.0, offs.iter().copied().fold([0.0; 3], add));
    let sum = |value: &dyn Fn(&[f64; 3]) -> f64| share * offs.iter().map(value).sum::<f64>();
    [sum(&|off| norm(*off)), 100.0 * norm(mean), sum(&|off| distance(*off, mean))]
}

fn frames(motion: &Motion) -> Vec<JointFrames> {
    let poses = motion.poses().iter();
    poses.map(|pose| motion.skeleton().frames(pose).unwrap()).collect()
}
