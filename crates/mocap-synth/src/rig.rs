use mocap_core::{
    Pose, Rotation,
    geometry::{add, norm, sub},
};

use crate::{
    body::{
        ARMS, Body, HEAD, JOINTS, LEGS, LOWER_SPINE, MIDDLE_SPINE, NECK, PELVIS, SIDE, UPPER_SPINE,
    },
    math::{PI, about_x, about_y, about_z, acos, atan2, exp},
};

/// Angles of a part in radians, forward pitch, roll to the right and left turn.
#[derive(Clone, Copy, Default)]
pub(crate) struct Tilt {
    pub(crate) pitch: f64,
    pub(crate) roll: f64,
    pub(crate) yaw: f64,
}

impl Tilt {
    fn share(self, s: f64) -> Rotation {
        about_z(s * self.yaw).after(about_x(s * self.roll)).after(about_y(s * self.pitch))
    }
}

/// Angles of an arm in radians, the same for both sides: the mirror is in the rig.
#[derive(Clone, Copy, Default)]
pub(crate) struct Arm {
    /// Forward.
    pub(crate) flexion: f64,
    /// Away from the trunk.
    pub(crate) abduction: f64,
    /// Of the abducted arm, forward round the vertical.
    pub(crate) across: f64,
    /// Outward about the upper arm's own axis.
    pub(crate) outward: f64,
    pub(crate) elbow: f64,
    /// Of the forearm, thumb inward.
    pub(crate) pronation: f64,
    pub(crate) wrist: f64,
    /// Raises the shoulder.
    pub(crate) shrug: f64,
}

/// Where a foot is: ankle in metres, angles in radians.
#[derive(Clone, Copy, Default)]
pub(crate) struct FootTarget {
    pub(crate) ankle: [f64; 3],
    pub(crate) heading: f64,
    /// Positive with the heel up.
    pub(crate) pitch: f64,
    /// Upward bend of the toes.
    pub(crate) toe: f64,
}

/// What a motion generator says about a moment. The legs follow from pelvis and feet.
#[derive(Clone, Copy, Default)]
pub(crate) struct Posture {
    pub(crate) pelvis_m: [f64; 3],
    /// Of the pelvis in the world.
    pub(crate) pelvis: Tilt,
    /// Of the upper trunk relative to the pelvis.
    pub(crate) trunk: Tilt,
    /// Of the head relative to the trunk.
    pub(crate) head: Tilt,
    /// Left, right.
    pub(crate) arms: [Arm; 2],
    /// Left, right.
    pub(crate) feet: [FootTarget; 2],
}

/// Rotation of each joint relative to its parent.
pub(crate) fn pose(body: &Body, posture: &Posture) -> Pose {
    let mut rotations = Vec::with_capacity(body.skeleton.joints().len());
    rotations.resize(JOINTS, Rotation::IDENTITY);
    rotations[PELVIS] = posture.pelvis.share(1.0);
    let vertebra = posture.trunk.share(1.0 / 3.0);
    for joint in [LOWER_SPINE, MIDDLE_SPINE, UPPER_SPINE] {
        rotations[joint] = vertebra;
    }
    let nod = posture.head.share(0.5);
    (rotations[NECK], rotations[HEAD]) = (nod, nod);
    for ((arm, joints), side) in posture.arms.iter().zip(ARMS).zip(SIDE) {
        for (joint, rotation) in joints.into_iter().zip(reach(arm, side)) {
            rotations[joint] = rotation;
        }
    }
    for (i, (target, joints)) in posture.feet.iter().zip(LEGS).enumerate() {
        let leg = stand(body, posture, rotations[PELVIS], target, body.hips[i]);
        for (joint, rotation) in joints.into_iter().zip(leg) {
            rotations[joint] = rotation;
        }
    }
    Pose { root_m: posture.pelvis_m, rotations }
}

fn reach(arm: &Arm, side: f64) -> [Rotation; 4] {
    let shoulder = about_z(-side * arm.across)
        .after(about_x(side * arm.abduction))
        .after(about_y(-arm.flexion))
        .after(about_z(side * arm.outward));
    let pronation = about_z(-side * 0.5 * arm.pronation);
    // The shoulder blade takes part in every movement of the arm.
    let raise = arm.shrug + 0.15 * arm.abduction;
    let forward = 0.22 * arm.flexion + 0.20 * arm.across;
    let clavicle = about_z(-side * forward).after(about_x(side * raise));
    [clavicle, shoulder, about_y(-arm.elbow).after(pronation), pronation.after(about_y(-arm.wrist))]
}

/// Hip, knee, ankle and toe rotations that bring the ankle to its target: the plane of the leg
/// follows the foot's heading, and the knee bends as the distance asks.
fn stand(
    body: &Body,
    posture: &Posture,
    pelvis: Rotation,
    target: &FootTarget,
    hip: [f64; 3],
) -> [Rotation; 4] {
    let reach = pelvis.inverse().apply(sub(target.ankle, posture.pelvis_m));
    let heading = 0.7 * wrapped(target.heading - posture.pelvis.yaw);
    let v = about_z(-heading).apply(sub(reach, hip));
    let d = bounded_reach(norm(v), body.leg());
    let (a, b) = (body.thigh, body.shank);
    let knee = PI - acos((a * a + b * b - d * d) / (2.0 * a * b));
    let lead = acos((a * a + d * d - b * b) / (2.0 * a * d));
    let abduction = atan2(v[1], -v[2]);
    let forward = atan2(v[0], (v[1] * v[1] + v[2] * v[2]).sqrt());
    let hip = about_z(heading).after(about_x(abduction)).after(about_y(-forward - lead));
    let knee = about_y(knee);
    let shank = pelvis.after(hip).after(knee);
    let foot = about_z(target.heading).after(about_y(target.pitch));
    [hip, knee, shank.inverse().after(foot), about_y(-target.toe)]
}

/// Keeps the leg between a deep squat and nearly straight. Near its full length it yields softly,
/// so that the knee never snaps.
fn bounded_reach(distance: f64, leg: f64) -> f64 {
    const SOFT: f64 = 0.975;
    const FULL: f64 = 0.999;
    const SQUAT: f64 = 0.4;
    let share = distance / leg;
    let room = FULL - SOFT;
    let share = if share <= SOFT { share } else { FULL - room * exp(-(share - SOFT) / room) };
    share.max(SQUAT) * leg
}

fn wrapped(radians: f64) -> f64 {
    let (s, c) = crate::math::sin_cos(radians);
    atan2(s, c)
}

/// A joint in the world: where it is, in metres, and the axes of its bone as columns of a matrix.
///
/// A matrix moves a point with half the work of a quaternion, and every joint moves many points.
#[derive(Clone, Copy)]
pub(crate) struct Placed {
    pub(crate) origin: [f64; 3],
    axes: [[f64; 3]; 3],
}

impl Placed {
    fn new(origin: [f64; 3], rotation: Rotation) -> Self {
        let (w, [x, y, z]) = rotation.quaternion();
        let axes = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Self { origin, axes }
    }

    /// A point of the bone in the world.
    pub(crate) fn point(&self, local: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = local;
        std::array::from_fn(|a| {
            let [i, j, k] = self.axes[a];
            self.origin[a] + (i * x + j * y + k * z)
        })
    }
}

/// The joints in the world, and their turns; kept from frame to frame.
pub(crate) struct Frames {
    turns: Vec<Rotation>,
    pub(crate) placed: Vec<Placed>,
}

impl Frames {
    pub(crate) fn new(body: &Body) -> Self {
        let joints = body.skeleton.joints().len();
        Self {
            turns: vec![Rotation::IDENTITY; joints],
            placed: vec![Placed::new([0.0; 3], Rotation::IDENTITY); joints],
        }
    }

    /// Forward kinematics.
    pub(crate) fn set(&mut self, body: &Body, pose: &Pose) {
        let Self { turns, placed } = self;
        for (i, joint) in body.skeleton.joints().iter().enumerate() {
            let (origin, turn) = match joint.parent {
                None => (add(pose.root_m, joint.offset_m), pose.rotations[i]),
                Some(p) => (placed[p].point(joint.offset_m), turns[p].after(pose.rotations[i])),
            };
            turns[i] = turn;
            placed[i] = Placed::new(origin, turn);
        }
    }
}

/// The ankle of a foot that touches the ground and is pitched about its ball or its heel.
#[derive(Clone, Copy)]
pub(crate) enum Pivot {
    Ball,
    Heel,
}

/// Where the ankle goes when a foot that stood flat at `flat`, the floor below its ankle, pitches.
///
/// # Units
/// Metres and radians.
pub(crate) fn pitched_ankle(
    body: &Body,
    flat: [f64; 2],
    heading: f64,
    pitch: f64,
    pivot: Pivot,
) -> [f64; 3] {
    let foot = body.foot;
    let x = match pivot {
        Pivot::Ball => foot.ball,
        Pivot::Heel => -foot.heel,
    };
    let p = [x, 0.0, -foot.height];
    let shift = about_z(heading).apply(sub(p, about_y(pitch).apply(p)));
    add([flat[0], flat[1], foot.height], shift)
}
