//! A recorded motion on another body.

mod floor;

use mocap_core::{
    JointFrames, Motion, Pose, Rotation, Skeleton,
    geometry::{add, cross, distance, dot, norm, scale, sub},
};

use crate::{
    SynthError,
    body::{ARMS, Body, HEAD, JOINTS, LEGS, LOWER_SPINE, MIDDLE_SPINE, NECK, PELVIS, UPPER_SPINE},
    rig::Frames,
};

/// Names of the parts in the order of this crate's joints: its own, those of the CMU database's ASF files (and
/// HDM05's), those of BVH files made from these, and those of skeletons with SMPL's topology.
#[rustfmt::skip]
const DIALECTS: [[&str; JOINTS]; 4] = [
    [
        "pelvis", "lower_spine", "middle_spine", "upper_spine", "neck", "head",
        "left_clavicle", "left_shoulder", "left_elbow", "left_wrist",
        "right_clavicle", "right_shoulder", "right_elbow", "right_wrist",
        "left_hip", "left_knee", "left_ankle", "left_toe",
        "right_hip", "right_knee", "right_ankle", "right_toe",
    ],
    [
        "root", "lowerback", "upperback", "thorax", "lowerneck", "head",
        "lclavicle", "lhumerus", "lradius", "lhand", "rclavicle", "rhumerus", "rradius", "rhand",
        "lfemur", "ltibia", "lfoot", "ltoes", "rfemur", "rtibia", "rfoot", "rtoes",
    ],
    [
        "Hips", "LowerBack", "Spine", "Spine1", "Neck", "Head",
        "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand",
        "RightShoulder", "RightArm", "RightForeArm", "RightHand",
        "LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToeBase",
        "RightUpLeg", "RightLeg", "RightFoot", "RightToeBase",
    ],
    [
        "pelvis", "spine1", "spine2", "spine3", "neck", "head",
        "left_collar", "left_shoulder", "left_elbow", "left_wrist",
        "right_collar", "right_shoulder", "right_elbow", "right_wrist",
        "left_hip", "left_knee", "left_ankle", "left_foot",
        "right_hip", "right_knee", "right_ankle", "right_foot",
    ],
];

/// A joint of ASF files that only twists the forearm, which this body does at its elbow.
const TWISTS: [&str; 2] = ["lwrist", "rwrist"];

/// A motion turned to z up, scaled to a body's legs and stood on the floor.
pub(crate) struct Retarget {
    rate_hz: f64,
    poses: Vec<Pose>,
}

/// The skeleton of the recording beside the body.
struct Source<'a> {
    motion: &'a Motion,
    /// Its joint for each of the body's.
    parts: [usize; JOINTS],
    twists: [Option<usize>; 2],
    /// From its axes to x ahead, y to the left, z up.
    turn: Rotation,
    /// From this body's rest pose to its own, joint by joint.
    stance: [Rotation; JOINTS],
}

impl Retarget {
    pub(crate) fn new(body: &Body, motion: &Motion) -> Result<Self, SynthError> {
        let source = Source::new(body, motion)?;
        let size = body.leg() / source.leg_m()?;
        let mut poses = Vec::with_capacity(motion.poses().len());
        let mut start = None;
        for (frame, pose) in motion.poses().iter().enumerate() {
            let frames = motion.skeleton().frames(pose)?;
            let turned = source.turned(&frames);
            let hips = source.hips(&frames);
            if !(hips.iter().all(|c| c.is_finite()) && turned.iter().all(|r| r.angle().is_finite()))
            {
                return Err(SynthError::NotFinite { frame });
            }
            let start = *start.get_or_insert([hips[0], hips[1], 0.0]);
            poses.push(upright(body, &turned, scale(size, sub(hips, start))));
        }
        if poses.is_empty() {
            return Err(SynthError::NoFrames);
        }
        stand(body, &mut poses);
        Ok(Self { rate_hz: motion.rate_hz(), poses })
    }

    /// The pose at a time in seconds; before the first and after the last frame the body stands still.
    ///
    /// Between frames it passes along Catmull and Rom's cubics of the root and of the quaternions, so that other rates
    /// add no accelerations of their own.
    pub(crate) fn pose(&self, time: f64) -> Pose {
        let last = self.poses.len() - 1;
        let at = (time * self.rate_hz).clamp(0.0, last as f64);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let frame = (at as usize).min(last);
        let share = at - frame as f64;
        if share < 1e-9 {
            return self.poses[frame].clone();
        }
        let near = [frame.saturating_sub(1), frame, (frame + 1).min(last), (frame + 2).min(last)];
        let [p, q, r, s] = near.map(|k| &self.poses[k]);
        let weights = catmull_rom(share);
        let root_m = std::array::from_fn(|a| {
            let four = [p.root_m[a], q.root_m[a], r.root_m[a], s.root_m[a]];
            four.iter().zip(weights).map(|(x, w)| x * w).sum()
        });
        let rotations = (0..JOINTS)
            .map(|j| blend([p, q, r, s].map(|pose| pose.rotations[j]), weights))
            .collect();
        Pose { root_m, rotations }
    }
}

fn catmull_rom(u: f64) -> [f64; 4] {
    let (u2, u3) = (u * u, u * u * u);
    [
        0.5 * (-u + 2.0 * u2 - u3),
        0.5 * (2.0 - 5.0 * u2 + 3.0 * u3),
        0.5 * (u + 4.0 * u2 - 3.0 * u3),
        0.5 * (u3 - u2),
    ]
}

/// Quaternions on one side of their sphere, mixed and set to unit length.
fn blend(four: [Rotation; 4], weights: [f64; 4]) -> Rotation {
    let (w0, v0) = four[1].quaternion();
    let (mut w, mut v) = (0.0, [0.0; 3]);
    for (rotation, weight) in four.iter().zip(weights) {
        let (wk, vk) = rotation.quaternion();
        let weight = if w0 * wk + dot(v0, vk) < 0.0 { -weight } else { weight };
        w += weight * wk;
        v = add(v, scale(weight, vk));
    }
    Rotation::from_quaternion(w, v).unwrap_or(four[1])
}

impl<'a> Source<'a> {
    fn new(body: &Body, motion: &'a Motion) -> Result<Self, SynthError> {
        let skeleton = motion.skeleton();
        let parts = find_parts(skeleton)?;
        let rest = skeleton.frames(&Pose::rest(skeleton))?;
        let place = |part: usize| rest.origins_m[parts[part]];
        // The rest pose says where up and ahead are: a body stands in it.
        let left = sub(place(LEGS[0][0]), place(LEGS[1][0]));
        let up = sub(place(HEAD), place(PELVIS));
        let no_length = |part| SynthError::NoLength { part };
        let turn = basis(left, up).ok_or_else(|| no_length("pelvis"))?;
        let twists = TWISTS.map(|name| find(skeleton, name));
        let mut stance = [Rotation::IDENTITY; JOINTS];
        let mine = body_rest(body);
        for [_, shoulder, elbow, wrist] in ARMS {
            for (from, to) in [(shoulder, elbow), (elbow, wrist)] {
                let theirs = turn.apply(sub(place(to), place(from)));
                stance[from] =
                    shortest(sub(mine[to], mine[from]), theirs).ok_or_else(|| no_length("arm"))?;
            }
            stance[wrist] = stance[elbow];
        }
        for [hip, knee, ankle, toe] in LEGS {
            for (from, to) in [(hip, knee), (knee, ankle), (ankle, toe)] {
                let theirs = turn.apply(sub(place(to), place(from)));
                stance[from] =
                    shortest(sub(mine[to], mine[from]), theirs).ok_or_else(|| no_length("leg"))?;
            }
        }
        Ok(Self { motion, parts, twists, turn, stance })
    }

    /// Thigh and shank of the recorded body, in metres.
    fn leg_m(&self) -> Result<f64, SynthError> {
        let skeleton = self.motion.skeleton();
        let rest = skeleton.frames(&Pose::rest(skeleton))?;
        let place = |part: usize| rest.origins_m[self.parts[part]];
        let length: f64 = LEGS
            .iter()
            .map(|[hip, knee, ankle, _]| {
                0.5 * (distance(place(*hip), place(*knee)) + distance(place(*knee), place(*ankle)))
            })
            .sum();
        if length > 0.0 { Ok(length) } else { Err(SynthError::NoLength { part: "leg" }) }
    }

    /// Middle of the hips in metres, z up.
    fn hips(&self, frames: &JointFrames) -> [f64; 3] {
        let [left, right] = [0, 1].map(|side| frames.origins_m[self.parts[LEGS[side][0]]]);
        self.turn.apply(scale(0.5, add(left, right)))
    }

    /// World rotations of the body's joints.
    fn turned(&self, frames: &JointFrames) -> [Rotation; JOINTS] {
        let world =
            |joint: usize| self.turn.after(frames.rotations[joint]).after(self.turn.inverse());
        let mut turned: [Rotation; JOINTS] =
            std::array::from_fn(|j| world(self.parts[j]).after(self.stance[j]));
        for (side, twist) in self.twists.iter().enumerate() {
            if let Some(twist) = *twist {
                let [_, _, elbow, _] = ARMS[side];
                // The middle of a forearm turns by half of what the wrist does.
                let full = world(twist).after(self.stance[elbow]);
                turned[elbow] = turned[elbow].toward(full, 0.5);
            }
        }
        turned
    }
}

/// The joints of a skeleton by part, in the dialect that fits best.
fn find_parts(skeleton: &Skeleton) -> Result<[usize; JOINTS], SynthError> {
    let found = DIALECTS.map(|names| names.map(|name| find(skeleton, name)));
    let known = |parts: &[Option<usize>; JOINTS]| parts.iter().flatten().count();
    let best = found.iter().max_by_key(|parts| known(parts)).copied().unwrap_or_default();
    let mut parts = [0; JOINTS];
    for (part, joint) in best.iter().enumerate() {
        // Whatever a root is called, it is the pelvis, unless another joint is.
        let joint = if part == PELVIS { joint.or(Some(0)) } else { *joint };
        parts[part] = joint.ok_or_else(|| SynthError::NoSuchPart {
            part: DIALECTS[0][part],
            names: DIALECTS.map(|names| names[part]).join(", "),
        })?;
    }
    Ok(parts)
}

fn find(skeleton: &Skeleton, name: &str) -> Option<usize> {
    skeleton.joints().iter().position(|joint| joint.name.eq_ignore_ascii_case(name))
}

/// From axes in which a body's left and up are so, to x ahead, y to the left and z up. The up axis is the
/// coordinate axis closest to the body's.
fn basis(left: [f64; 3], up: [f64; 3]) -> Option<Rotation> {
    let tallest = (0..3).max_by(|&a, &b| up[a].abs().total_cmp(&up[b].abs()))?;
    let mut z = [0.0; 3];
    z[tallest] = if up[tallest] < 0.0 { -1.0 } else { 1.0 };
    let flat = sub(left, scale(dot(left, z), z));
    let length = norm(flat);
    (length > 1e-6 && norm(up) > 1e-6).then_some(())?;
    let y = scale(1.0 / length, flat);
    Rotation::nearest(&[cross(y, z), y, z])
}

/// The shortest rotation between two directions.
fn shortest(from: [f64; 3], to: [f64; 3]) -> Option<Rotation> {
    let (a, b) = (norm(from), norm(to));
    (a > 1e-6 && b > 1e-6).then_some(())?;
    let (p, q) = (scale(1.0 / a, from), scale(1.0 / b, to));
    // Opposite directions have no shortest rotation: about the forward axis, as arms are raised.
    Rotation::from_quaternion(1.0 + dot(p, q), cross(p, q))
        .or_else(|| Rotation::from_quaternion(0.0, [1.0, 0.0, 0.0]))
}

fn body_rest(body: &Body) -> Vec<[f64; 3]> {
    let mut frames = Frames::new(body);
    let pose = Pose::rest(&body.skeleton);
    frames.set(body, &pose);
    frames.placed.iter().map(|joint| joint.origin).collect()
}

/// The pose with these world rotations whose hips have their middle there.
fn upright(body: &Body, turned: &[Rotation; JOINTS], hips: [f64; 3]) -> Pose {
    let joints = body.skeleton.joints();
    let rotations = (0..JOINTS)
        .map(|j| match joints[j].parent {
            None => turned[j],
            Some(p) => turned[p].inverse().after(turned[j]).normalized(),
        })
        .collect();
    let middle = scale(0.5, add(body.hips[0], body.hips[1]));
    Pose { root_m: sub(hips, turned[PELVIS].apply(middle)), rotations }
}

/// Moves the motion up or down so that its feet stand on the floor: in a twentieth of the frames they may sink in.
/// Floors of captures are off level by a percent or two, so the floor is a plane.
fn stand(body: &Body, poses: &mut [Pose]) {
    let toe_height = 0.02 * body.scale.foot;
    let mut frames = Frames::new(body);
    let whole = Pose::rest(&body.skeleton).rotations;
    let lowest: Vec<[f64; 3]> = poses
        .iter()
        .map(|pose| {
            let mut pose = pose.clone();
            pose.rotations.extend_from_slice(&whole[JOINTS..]);
            frames.set(body, &pose);
            let height = LEGS
                .iter()
                .flat_map(|[_, _, ankle, toe]| {
                    let z = |joint: usize| frames.placed[joint].origin[2];
                    [z(*ankle) - body.foot.height, z(*toe) - toe_height]
                })
                .fold(f64::INFINITY, f64::min);
            [pose.root_m[0], pose.root_m[1], height]
        })
        .collect();
    let [level, ahead, left] = floor::floor(&lowest);
    for pose in poses {
        let [x, y, z] = pose.root_m;
        pose.root_m[2] = z - (level + ahead * x + left * y);
    }
}

// The order of DIALECTS is that of the body's joints.
const _: () = assert!(
    PELVIS == 0
        && LOWER_SPINE == 1
        && MIDDLE_SPINE == 2
        && UPPER_SPINE == 3
        && NECK == 4
        && HEAD == 5
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_pass_through_the_frames_and_reproduce_parabolas() {
        for k in 0..=10 {
            let u = f64::from(k) / 10.0;
            let w = catmull_rom(u);
            for (degree, exact) in [(0, 1.0), (1, u), (2, u * u)] {
                let at = |x: f64| x.powi(degree);
                let value = w[0] * at(-1.0) + w[1] * at(0.0) + w[2] * at(1.0) + w[3] * at(2.0);
                assert!((value - exact).abs() < 1e-14, "{degree} {u}");
            }
        }
    }
}
