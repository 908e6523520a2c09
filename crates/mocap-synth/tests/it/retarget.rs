use std::sync::Arc;

use mocap_core::{
    Joint, Motion, Pose, Rotation, Skeleton,
    geometry::{distance, dot, norm, sub},
};
use mocap_io::{MotionFile, ReadOptions};
use mocap_synth::{Activity, Hands, Person, Synth, SynthError, SynthParams, SyntheticTake};
use mocap_testkit::recording;

use crate::{params, record};

fn retarget(params: SynthParams, motion: &Motion) -> Result<SyntheticTake, SynthError> {
    Synth::retarget(params, motion)?.take()
}

/// A skeleton in other words, whose rest pose has its arms to the sides and legs astride, in other axes.
fn in_other_words(recorded: &SyntheticTake) -> Motion {
    let words = [
        "root",
        "lowerback",
        "upperback",
        "thorax",
        "lowerneck",
        "head",
        "lclavicle",
        "lhumerus",
        "lradius",
        "lhand",
        "rclavicle",
        "rhumerus",
        "rradius",
        "rhand",
        "lfemur",
        "ltibia",
        "lfoot",
        "ltoes",
        "rfemur",
        "rtibia",
        "rfoot",
        "rtoes",
    ];
    let joints = recorded.motion().skeleton().joints();
    // x ahead, y left, z up to x left, y up, z ahead.
    let axes = Rotation::from_matrix(&[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]).unwrap();
    // How far each joint's rest pose is turned from this crate's: arms raised by a right angle, legs by 20°.
    let stance = |j: usize| {
        let degrees: f64 = match j {
            7..=9 => 90.0,
            11..=13 => -90.0,
            14..=15 => 20.0,
            18..=19 => -20.0,
            _ => 0.0,
        };
        Rotation::about([1.0, 0.0, 0.0], degrees.to_radians())
    };
    let turned = joints.iter().enumerate().map(|(j, joint)| Joint {
        name: words[j].to_owned(),
        parent: joint.parent,
        offset_m: axes.apply(joint.parent.map_or(Rotation::IDENTITY, stance).apply(joint.offset_m)),
    });
    let skeleton = Arc::new(Skeleton::new(turned.collect()).unwrap());
    let poses = recorded.motion().poses().iter().map(|pose| {
        let rotations = (0..joints.len()).map(|j| {
            // World rotations lose their own rest pose: local = S_p L S_j⁻¹.
            let parent = joints[j].parent.map_or(Rotation::IDENTITY, stance);
            let local = parent.after(pose.rotations[j]).after(stance(j).inverse());
            axes.after(local).after(axes.inverse())
        });
        Pose { root_m: axes.apply(pose.root_m), rotations: rotations.collect() }
    });
    Motion::new(skeleton, 120.0, poses.collect()).unwrap()
}

#[test]
fn a_motion_in_other_words_axes_and_rest_pose_is_the_same_motion() {
    let params = params(Activity::Throw, 2);
    let recorded = record(params);
    for motion in [recorded.motion().clone(), in_other_words(&recorded)] {
        let again = retarget(params, &motion).unwrap();
        let shift = [0, 1, 2].map(|a| again.joints()[(0, 0, a)] - recorded.joints()[(0, 0, a)]);
        for t in 0..1200 {
            for j in 0..22 {
                let at = |take: &SyntheticTake| [0, 1, 2].map(|a| take.joints()[(t, j, a)]);
                let moved = sub(at(&again), at(&recorded));
                // Quaternions there and back, 22 deep.
                assert!(distance(moved, shift) < 1e-9, "frame {t} joint {j}");
            }
        }
        // Feet stood on the floor before and do so again.
        assert!(shift[2].abs() < 0.01, "{shift:?}");
    }
}

#[test]
fn another_body_keeps_the_directions_of_its_bones() {
    let recorded = record(SynthParams { frames: 200, ..params(Activity::Kick, 6) });
    let person = Some(Person::draw(12));
    let hands = Hands::Five;
    let other = SynthParams { person, hands, ..*record_params(&recorded) };
    let again = retarget(other, &in_other_words(&recorded)).unwrap();
    let bones =
        [("left_shoulder", "left_elbow"), ("right_knee", "right_ankle"), ("left_hip", "left_knee")];
    for (from, to) in bones {
        let direction = |take: &SyntheticTake, t: usize| {
            let skeleton = take.motion().skeleton();
            let [p, q] = [from, to].map(|name| {
                let j = skeleton.find(name).unwrap();
                [0, 1, 2].map(|a| take.joints()[(t, j, a)])
            });
            let d = sub(q, p);
            d.map(|c| c / norm(d))
        };
        for t in 0..200 {
            let cosine = dot(direction(&again, t), direction(&recorded, t));
            assert!(cosine > 1.0 - 1e-9, "{from} in frame {t}: {cosine}");
        }
    }
}

fn record_params(recorded: &SyntheticTake) -> Box<SynthParams> {
    Box::new(SynthParams { frames: recorded.take().frames(), ..SynthParams::default() })
}

#[test]
fn a_recording_keeps_its_pace_at_another_rate() {
    let recorded = record(params(Activity::Walk, 3));
    let motion = recorded.motion();
    let at = |rate_hz: f64, frames: usize| {
        retarget(SynthParams { rate_hz, frames, ..params(Activity::Walk, 3) }, motion).unwrap()
    };
    let (usual, fine) = (at(120.0, 1200), at(240.0, 2399));
    for t in (2..1190).step_by(7) {
        for j in [0, 9, 17] {
            let p = [0, 1, 2].map(|a| usual.joints()[(t, j, a)]);
            let q = [0, 1, 2].map(|a| fine.joints()[(2 * t, j, a)]);
            assert!(distance(p, q) < 1e-12);
            // Between frames: the mean of the neighbours but for the curvature, at most 100 m/s² here.
            let next = [0, 1, 2].map(|a| usual.joints()[(t + 1, j, a)]);
            let mid = [0, 1, 2].map(|a| fine.joints()[(2 * t + 1, j, a)]);
            let mean = [0, 1, 2].map(|a| 0.5 * (p[a] + next[a]));
            assert!(distance(mid, mean) < 100.0 / (8.0 * 120.0 * 120.0), "frame {t} joint {j}");
        }
    }
}

#[test]
fn what_cannot_be_retargeted_is_refused_with_the_reason() {
    let params = SynthParams { frames: 10, ..params(Activity::Walk, 1) };
    let recorded = record(params);
    let good = recorded.motion();
    let with = |joints: Vec<Joint>| {
        Motion::new(Skeleton::new(joints).unwrap(), 120.0, good.poses().to_vec()).unwrap()
    };
    let mut renamed = good.skeleton().joints().to_vec();
    renamed[15].name = "kneecap".into();
    match retarget(params, &with(renamed)).unwrap_err() {
        SynthError::NoSuchPart { part, names } => {
            assert_eq!(part, "left_knee");
            assert!(names.contains("ltibia") && names.contains("LeftLeg"), "{names}");
        }
        other => panic!("{other}"),
    }
    let mut flat = good.skeleton().joints().to_vec();
    flat[8].offset_m = [0.0; 3];
    assert_eq!(retarget(params, &with(flat)).unwrap_err(), SynthError::NoLength { part: "arm" });
    let empty = Motion::new(Arc::clone(good.skeleton()), 120.0, Vec::new()).unwrap();
    assert_eq!(retarget(params, &empty).unwrap_err(), SynthError::NoFrames);
    let mut poses = good.poses().to_vec();
    poses[4].root_m[1] = f64::NAN;
    let broken = Motion::new(Arc::clone(good.skeleton()), 120.0, poses).unwrap();
    assert_eq!(retarget(params, &broken).unwrap_err(), SynthError::NotFinite { frame: 4 });
}

#[test]
fn captured_motions_stand_on_the_floor_on_any_body() {
    // How much of the time a foot is down: always for a walker, now and then for a dancer on tiptoe.
    for (file, share) in [
        ("cmu/paired/02_01.amc", 0.9),
        ("cmu/paired/05_13.amc", 0.1),
        ("cmu/paired/135_07.amc", 0.3),
    ] {
        let Some(path) = recording(file) else { continue };
        let file = MotionFile::read(&path, None, &ReadOptions::default()).unwrap();
        for seed in 0..4 {
            let person = Some(Person::draw(seed));
            let frames = file.motion().poses().len().min(1200);
            let params = SynthParams { person, frames, ..params(Activity::Walk, seed) };
            let recorded = retarget(params, file.motion()).unwrap();
            let skeleton = recorded.motion().skeleton();
            let lowest = |t: usize| {
                ["left_toe", "right_toe", "left_ankle", "right_ankle"]
                    .map(|name| recorded.joints()[(t, skeleton.find(name).unwrap(), 2)])
                    .into_iter()
                    .fold(f64::INFINITY, f64::min)
            };
            let heights: Vec<f64> = (0..frames).map(lowest).collect();
            let least = heights.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(least > -0.06, "{}: {least}", path.display());
            let down = heights.iter().filter(|h| **h < 0.06).count();
            let found = down as f64 / frames as f64;
            assert!(found > share, "{}: on the floor for {found} of the time", path.display());
        }
    }
}
