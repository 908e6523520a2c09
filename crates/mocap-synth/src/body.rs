use std::sync::Arc;

use mocap_core::{CoreError, Joint, Skeleton};

use crate::{
    dice::Dice,
    hand,
    person::{Measure, Person},
};

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
/// Joints of the body without its hands.
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
    /// Factors of the template for the flesh round each joint along x, y and z.
    pub(crate) flesh: Vec<[f64; 3]>,
    /// Whether markers sit on a skin.
    pub(crate) surface: bool,
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

/// Lengths and girths of one body, from which everything else follows.
pub(crate) struct Build {
    /// Vertical lengths from the floor to the crown, in metres, as in the template's column.
    column: [f64; 10],
    /// Half the distance of the shoulders from clavicle to clavicle, and of the hips, in metres.
    shoulder: f64,
    hip_half: f64,
    scale: Scale,
    /// Factors of the template for the flesh round each joint along x, y and z.
    flesh: Vec<[f64; 3]>,
    /// Whether the body has a skin for markers to sit on.
    surface: bool,
    hand: f64,
}

/// From the centre of the elbow to that of the wrist over the template's length, for an average man: close to the
/// length between the landmarks, which the template falls short of.
const FOREARM_JOINTS: f64 = 1.05;

impl Build {
    /// Draws a body of this stature: longer legs come with a shorter trunk, and girth, shoulders,
    /// arms and feet vary on their own.
    ///
    /// # Units
    /// Metres.
    pub(crate) fn sample(stature_m: f64, dice: &mut Dice) -> Self {
        let leg_share = dice.around(1.0, 0.025);
        let mut column = COLUMN_M.map(|length| dice.around(length, 0.015));
        for length in &mut column[1..3] {
            *length *= leg_share;
        }
        let total: f64 = column.iter().sum();
        let column = column.map(|length| length * stature_m / total);
        let size = stature_m / TEMPLATE_M;
        let arm = dice.around(size, 0.02);
        let scale = Scale {
            stature: size,
            girth: dice.around(size, 0.07),
            upper_arm: dice.around(arm, 0.012),
            forearm: dice.around(arm, 0.012),
            thigh: column[2] / COLUMN_M[2],
            shank: column[1] / COLUMN_M[1],
            foot: dice.around(size, 0.03),
        };
        Self {
            column,
            shoulder: dice.around(0.155 * size, 0.03),
            hip_half: dice.around(0.086 * size, 0.03),
            flesh: (0..JOINTS).map(|joint| scale.round(joint)).collect(),
            hand: scale.forearm,
            scale,
            surface: false,
        }
    }

    /// The body of a person, whose measures are those of the average man, the template, times factors.
    pub(crate) fn of(person: &Person) -> Self {
        let f = person.factors();
        let part = |top: Measure, bottom: Measure| {
            (person.metres(top) - person.metres(bottom)) / (top.mean_m() - bottom.mean_m())
        };
        let foot_height = f(Measure::Malleolus);
        let shank = part(Measure::Tibial, Measure::Malleolus);
        let thigh = part(Measure::Trochanter, Measure::Tibial);
        let trunk = part(Measure::Cervicale, Measure::Trochanter);
        let head = part(Measure::Stature, Measure::Cervicale);
        let factors = [foot_height, shank, thigh, trunk, trunk, trunk, trunk, trunk, head, head];
        let mut column: [f64; 10] = std::array::from_fn(|i| COLUMN_M[i] * factors[i]);
        let stature_m = person.stature_m();
        let total: f64 = column.iter().sum();
        for length in &mut column {
            *length *= stature_m / total;
        }
        let size = stature_m / TEMPLATE_M;
        let scale = Scale {
            stature: size,
            girth: f(Measure::WaistCircumference),
            upper_arm: f(Measure::UpperArm),
            forearm: FOREARM_JOINTS * f(Measure::Forearm),
            thigh: column[2] / COLUMN_M[2],
            shank: column[1] / COLUMN_M[1],
            foot: f(Measure::FootLength),
        };
        Self {
            column,
            shoulder: 0.155 * f(Measure::Biacromial),
            hip_half: 0.086 * (0.5 * f(Measure::HipBreadth) + 0.5 * size),
            flesh: (0..JOINTS).map(|joint| flesh(person, &scale, joint)).collect(),
            hand: f(Measure::HandLength),
            scale,
            surface: true,
        }
    }
}

/// Factors of the template for the flesh of a person round a joint.
fn flesh(person: &Person, scale: &Scale, joint: usize) -> [f64; 3] {
    use Measure as M;
    let f = person.factors();
    let round = |girth: M, length: f64| [f(girth), f(girth), length];
    for (arm, leg) in ARMS.iter().zip(LEGS) {
        match joint {
            j if j == arm[0] => return [f(M::Biceps), f(M::Biacromial), f(M::Biceps)],
            j if j == arm[1] => return round(M::Biceps, scale.upper_arm),
            j if j == arm[2] => return round(M::ForearmCircumference, scale.forearm),
            j if j == arm[3] => return [f(M::HandBreadth), f(M::HandBreadth), f(M::HandLength)],
            j if j == leg[0] => return round(M::Thigh, scale.thigh),
            j if j == leg[1] => return round(M::Calf, scale.shank),
            j if j == leg[2] || j == leg[3] => {
                return [scale.foot, f(M::FootBreadth), f(M::Malleolus)];
            }
            _ => {}
        }
    }
    match joint {
        PELVIS => [f(M::HipDepth), f(M::HipBreadth), scale.stature],
        LOWER_SPINE => [f(M::WaistDepth), f(M::WaistBreadth), scale.stature],
        MIDDLE_SPINE | UPPER_SPINE => [f(M::ChestDepth), f(M::ChestBreadth), scale.stature],
        NECK => round(M::Neck, scale.stature),
        _ => [f(M::HeadLength), f(M::HeadBreadth), scale.stature],
    }
}

impl Scale {
    /// Factors of the template along x, y and z for the flesh round a joint.
    fn round(&self, joint: usize) -> [f64; 3] {
        for (arm, leg) in ARMS.iter().zip(LEGS) {
            match joint {
                j if j == arm[1] => return [self.girth, self.girth, self.upper_arm],
                j if j == arm[2] || j == arm[3] => return [self.girth, self.girth, self.forearm],
                j if j == leg[0] => return [self.girth, self.girth, self.thigh],
                j if j == leg[1] => return [self.girth, self.girth, self.shank],
                j if j == leg[2] || j == leg[3] => return [self.foot; 3],
                _ => {}
            }
        }
        match joint {
            PELVIS | LOWER_SPINE | MIDDLE_SPINE | UPPER_SPINE => {
                [self.girth, self.girth, self.stature]
            }
            _ => [self.stature; 3],
        }
    }
}

impl Body {
    /// The skeleton of a build, with the fifteen joints of each hand or without.
    pub(crate) fn new(build: Build, hands: bool) -> Result<Self, CoreError> {
        let Build { column, shoulder, hip_half, scale, mut flesh, surface, hand } = build;
        let [foot_height, shank, thigh, hip, lower, middle, upper, neck, head, _] = column;
        let size = scale.stature;
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
        if hands {
            for side in 0..2 {
                joints.extend(hand::joints(side, hand));
            }
            flesh.resize(joints.len(), [hand; 3]);
        }
        let skeleton = Arc::new(Skeleton::new(joints)?);
        Ok(Self { skeleton, thigh, shank, foot, hips, scale, flesh, surface })
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
