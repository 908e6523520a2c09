use std::sync::Arc;

use mocap_core::{CoreError, Joint, Skeleton};

use crate::dice::Dice;

pub(crate) const PELVIS: usize = 0;
pub(crate) const LOWER_SPINE: usize = 1;
pub(crate) const MIDDLE_SPINE: usize = 2;
pub(crate) const UPPER_SPINE: usize = 3;
pub(crate) const NECK: usize = 4;
pub(crate) const HEAD: usize = 5;
/// Clavicle, shoulder, elbow and wrist of the left and the right arm.
pub(crate) const ARMS: [[usize; 4]; 2] = [[6, 7, 8, 9], [10, 11, 12, 13]];
/// Hip, knee, ankle and toe joint of the left and the right leg.
pub(crate) const LEGS: [[usize; 4]; 2] = [[14, 15, 16, 17], [18, 19, 20, 21]];
pub(crate) const JOINTS: usize = 22;

/// +1 on the left, −1 on the right: the sign of the lateral axis.
pub(crate) const SIDE: [f64; 2] = [1.0, -1.0];

/// Height of the template that all lengths of this crate refer to, in metres.
const TEMPLATE_M: f64 = 1.75;

/// Bones of one body in metres. The rest pose stands upright with hanging arms and faces +x, with
/// y to the left and z up.
pub(crate) struct Body {
    pub(crate) skeleton: Arc<Skeleton>,
    pub(crate) thigh: f64,
    pub(crate) shank: f64,
    pub(crate) foot: Foot,
    /// From the pelvis joint to the hip of each side.
    pub(crate) hips: [[f64; 3]; 2],
    pub(crate) scale: Scale,
}

/// How this body differs from the template, as factors of template lengths.
#[derive(Clone, Copy)]
pub(crate) struct Scale {
    pub(crate) stature: f64,
    pub(crate) girth: f64,
    pub(crate) upper_arm: f64,
    pub(crate) forearm: f64,
    pub(crate) thigh: f64,
    pub(crate) shank: f64,
    pub(crate) foot: f64,
}

/// Where a foot touches the ground, seen from its ankle, in metres.
#[derive(Clone, Copy)]
pub(crate) struct Foot {
    pub(crate) height: f64,
    pub(crate) ball: f64,
    pub(crate) heel: f64,
}

/// Vertical lengths of the template from the floor to the crown, in metres; close to the proportions
/// of [Win09] Fig. 4.1.
const COLUMN_M: [f64; 10] = [0.079, 0.427, 0.425, 0.040, 0.090, 0.130, 0.130, 0.190, 0.100, 0.139];

impl Body {
    /// Draws a body of this stature: longer legs come with a shorter trunk, and girth, shoulders,
    /// arms and feet vary on their own.
    ///
    /// # Units
    /// Metres.
    pub(crate) fn sample(stature_m: f64, dice: &mut Dice) -> Result<Self, CoreError> {
        let leg_share = dice.around(1.0, 0.025);
        let mut column = COLUMN_M.map(|length| dice.around(length, 0.015));
        for length in &mut column[1..3] {
            *length *= leg_share;
        }
        let total: f64 = column.iter().sum();
        let [foot_height, shank, thigh, hip, lower, middle, upper, neck, head, _] =
            column.map(|length| length * stature_m / total);
        let size = stature_m / TEMPLATE_M;
        let arm = dice.around(size, 0.02);
        let scale = Scale {
            stature: size,
            girth: dice.around(size, 0.07),
            upper_arm: dice.around(arm, 0.012),
            forearm: dice.around(arm, 0.012),
            thigh: thigh / COLUMN_M[2],
            shank: shank / COLUMN_M[1],
            foot: dice.around(size, 0.03),
        };
        let shoulder = dice.around(0.155 * size, 0.03);
        let hip_half = dice.around(0.086 * size, 0.03);
        let foot = Foot { height: foot_height, ball: 0.125 * scale.foot, heel: 0.055 * scale.foot };
        let hips = SIDE.map(|side| [0.0, side * hip_half, -hip]);

        let joint = |name: &str, parent: Option<usize>, offset_m: [f64; 3]| Joint {
            name: name.to_owned(),
            parent,
            offset_m,
        };
        let mut joints = vec![
            joint("pelvis", None, [0.0; 3]),
            joint("lower_spine", Some(PELVIS), [-0.02 * size, 0.0, lower]),
            joint("middle_spine", Some(LOWER_SPINE), [0.005 * size, 0.0, middle]),
            joint("upper_spine", Some(MIDDLE_SPINE), [-0.015 * size, 0.0, upper]),
            joint("neck", Some(UPPER_SPINE), [0.0, 0.0, neck]),
            joint("head", Some(NECK), [0.025 * size, 0.0, head]),
        ];
        for ((name, side), [clavicle, shoulder_joint, elbow, _]) in sides().zip(ARMS) {
            let span = [-0.005 * size, side * shoulder, -0.015 * size];
            let root = [0.03 * size, side * 0.03 * size, neck - 0.06 * size];
            joints.extend([
                joint(&format!("{name}_clavicle"), Some(UPPER_SPINE), root),
                joint(&format!("{name}_shoulder"), Some(clavicle), span),
                joint(
                    &format!("{name}_elbow"),
                    Some(shoulder_joint),
                    [0.0, 0.0, -UPPER_ARM_M * scale.upper_arm],
                ),
                joint(
                    &format!("{name}_wrist"),
                    Some(elbow),
                    [0.0, 0.0, -FOREARM_M * scale.forearm],
                ),
            ]);
        }
        for (((name, _), [hip_joint, knee, ankle, _]), hip) in sides().zip(LEGS).zip(hips) {
            let toe = [foot.ball, 0.0, 0.02 * scale.foot - foot.height];
            joints.extend([
                joint(&format!("{name}_hip"), Some(PELVIS), hip),
                joint(&format!("{name}_knee"), Some(hip_joint), [0.0, 0.0, -thigh]),
                joint(&format!("{name}_ankle"), Some(knee), [0.0, 0.0, -shank]),
                joint(&format!("{name}_toe"), Some(ankle), toe),
            ]);
        }
        let skeleton = Arc::new(Skeleton::new(joints)?);
        Ok(Self { skeleton, thigh, shank, foot, hips, scale })
    }

    /// Height of the pelvis joint over the floor in the rest pose, in metres.
    pub(crate) fn standing(&self) -> f64 {
        self.foot.height + self.leg() - self.hips[0][2]
    }

    /// Length of thigh and shank together, in metres.
    pub(crate) fn leg(&self) -> f64 {
        self.thigh + self.shank
    }
}

pub(crate) const UPPER_ARM_M: f64 = 0.315;
pub(crate) const FOREARM_M: f64 = 0.255;

fn sides() -> impl Iterator<Item = (&'static str, f64)> {
    ["left", "right"].into_iter().zip(SIDE)
}
