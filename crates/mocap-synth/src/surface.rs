//! The skin: round each bone a chain of ellipsoids, blended from station to station.

use std::borrow::Cow;

use mocap_core::geometry::{add, dot, scale, sub};

use crate::{
    body::{
        ARMS, Body, FOREARM_M, JOINTS, LEGS, LOWER_SPINE, MIDDLE_SPINE, NECK, PELVIS, UPPER_ARM_M,
        UPPER_SPINE,
    },
    hand::{HAND_JOINTS, bone_vector},
};

/// A cross-section of the flesh round a bone: its centre from the joint, and how far the skin is from there
/// ahead, behind, outward, inward, above and below, in metres of the template.
#[derive(Clone, Copy)]
struct Station {
    centre: [f64; 3],
    half: [f64; 6],
}

const fn station(centre: [f64; 3], half: [f64; 6]) -> Station {
    Station { centre, half }
}

#[rustfmt::skip]
const PELVIS_SKIN: [Station; 2] = [
    station([0.0, 0.0, -0.060], [0.095, 0.125, 0.170, 0.170, 0.10, 0.10]),
    station([0.0, 0.0,  0.080], [0.100, 0.098, 0.155, 0.155, 0.10, 0.10]),
];
#[rustfmt::skip]
const WAIST_SKIN: [Station; 2] = [
    station([0.0, 0.0, 0.0], [0.100, 0.095, 0.150, 0.150, 0.10, 0.10]),
    station([0.0, 0.0, 0.1], [0.102, 0.088, 0.148, 0.148, 0.10, 0.10]),
];
#[rustfmt::skip]
const MIDDLE_SKIN: [Station; 2] = [
    station([0.0, 0.0, 0.0], [0.104, 0.086, 0.150, 0.150, 0.10, 0.10]),
    station([0.0, 0.0, 0.1], [0.112, 0.090, 0.158, 0.158, 0.10, 0.10]),
];
#[rustfmt::skip]
const CHEST_SKIN: [Station; 4] = [
    station([0.0, 0.0, -0.120], [0.113, 0.092, 0.160, 0.160, 0.10, 0.10]),
    station([0.0, 0.0,  0.000], [0.108, 0.098, 0.160, 0.160, 0.10, 0.10]),
    station([0.0, 0.0,  0.095], [0.082, 0.090, 0.130, 0.130, 0.10, 0.10]),
    station([0.0, 0.0,  0.190], [0.050, 0.044, 0.065, 0.065, 0.03, 0.05]),
];
#[rustfmt::skip]
const NECK_SKIN: [Station; 2] = [
    station([0.005, 0.0, 0.0], [0.055, 0.050, 0.058, 0.058, 0.05, 0.05]),
    station([0.015, 0.0, 0.1], [0.055, 0.055, 0.058, 0.058, 0.05, 0.05]),
];
#[rustfmt::skip]
const HEAD_SKIN: [Station; 1] = [
    station([0.010, 0.0, 0.040], [0.098, 0.098, 0.076, 0.076, 0.100, 0.11]),
];
#[rustfmt::skip]
const SHOULDER_SKIN: [Station; 2] = [
    station([-0.010, 0.060, -0.020], [0.060, 0.075, 0.06, 0.10, 0.045, 0.09]),
    station([-0.005, 0.150, -0.015], [0.052, 0.052, 0.055, 0.10, 0.050, 0.09]),
];
#[rustfmt::skip]
const UPPER_ARM_SKIN: [Station; 4] = [
    station([0.0, 0.0,  0.00], [0.052, 0.050, 0.050, 0.050, 0.05, 0.05]),
    station([0.0, 0.0, -0.12], [0.052, 0.052, 0.046, 0.046, 0.05, 0.05]),
    station([0.0, 0.0, -0.24], [0.046, 0.042, 0.041, 0.041, 0.05, 0.05]),
    station([0.0, 0.0, -UPPER_ARM_M], [0.038, 0.036, 0.038, 0.038, 0.04, 0.04]),
];
#[rustfmt::skip]
const FOREARM_SKIN: [Station; 3] = [
    station([0.0, 0.0, -0.02], [0.046, 0.042, 0.040, 0.040, 0.04, 0.04]),
    station([0.0, 0.0, -0.10], [0.044, 0.040, 0.036, 0.036, 0.05, 0.05]),
    station([0.0, 0.0, -FOREARM_M], [0.029, 0.029, 0.020, 0.020, 0.03, 0.03]),
];
#[rustfmt::skip]
const HAND_SKIN: [Station; 2] = [
    station([0.0, 0.0,  -0.010], [0.030, 0.030, 0.018, 0.018, 0.02, 0.02]),
    station([-0.006, 0.0, -0.085], [0.043, 0.043, 0.013, 0.016, 0.02, 0.02]),
];
#[rustfmt::skip]
const THIGH_SKIN: [Station; 4] = [
    station([0.0, 0.010, -0.03], [0.090, 0.100, 0.090, 0.085, 0.09, 0.09]),
    station([0.0, 0.010, -0.16], [0.090, 0.088, 0.084, 0.078, 0.09, 0.09]),
    station([0.0, 0.004, -0.31], [0.072, 0.066, 0.066, 0.064, 0.08, 0.08]),
    station([0.0, 0.000, -0.425], [0.058, 0.052, 0.052, 0.052, 0.06, 0.06]),
];
#[rustfmt::skip]
const SHANK_SKIN: [Station; 4] = [
    station([0.0, 0.0, -0.02], [0.056, 0.052, 0.052, 0.052, 0.05, 0.05]),
    station([0.0, 0.0, -0.13], [0.050, 0.070, 0.055, 0.055, 0.06, 0.06]),
    station([0.0, 0.0, -0.28], [0.038, 0.050, 0.043, 0.041, 0.05, 0.05]),
    station([0.0, 0.0, -0.427], [0.036, 0.042, 0.036, 0.036, 0.04, 0.04]),
];
/// Heights reach the sole, which is 79 mm under the ankle.
#[rustfmt::skip]
const FOOT_SKIN: [Station; 3] = [
    station([-0.030, 0.0, -0.042], [0.030, 0.029, 0.034, 0.034, 0.05, 0.037]),
    station([ 0.050, 0.0, -0.045], [0.040, 0.040, 0.040, 0.038, 0.03, 0.033]),
    station([ 0.120, 0.0, -0.062], [0.070, 0.040, 0.048, 0.046, 0.022, 0.016]),
];
#[rustfmt::skip]
const TOE_SKIN: [Station; 1] = [
    station([0.0, 0.0, -0.003], [0.070, 0.040, 0.047, 0.045, 0.020, 0.016]),
];
/// Radius of a finger's bone with its flesh, and of the thumb's.
const FINGER_M: f64 = 0.0085;
const THUMB_M: f64 = 0.0105;

/// The chain of a joint of the left side.
fn stations(joint: usize) -> Cow<'static, [Station]> {
    if let Some(k) = joint.checked_sub(JOINTS) {
        let (finger, bone) = (k % HAND_JOINTS / 3, k % 3);
        let radius = if finger == 4 { THUMB_M } else { FINGER_M };
        let tip = if bone == 2 {
            scale(0.7, bone_vector(finger, bone, 0))
        } else {
            bone_vector(finger, bone, 0)
        };
        return Cow::Owned(vec![station([0.0; 3], [radius; 6]), station(tip, [0.92 * radius; 6])]);
    }
    for (arm, leg) in ARMS.iter().zip(LEGS) {
        let limbs: [(&[usize; 4], [&'static [Station]; 4]); 2] = [
            (arm, [&SHOULDER_SKIN, &UPPER_ARM_SKIN, &FOREARM_SKIN, &HAND_SKIN]),
            (&leg, [&THIGH_SKIN, &SHANK_SKIN, &FOOT_SKIN, &TOE_SKIN]),
        ];
        for (joints, skins) in limbs {
            if let Some(i) = joints.iter().position(|&j| j == joint) {
                return Cow::Borrowed(skins[i]);
            }
        }
    }
    Cow::Borrowed(match joint {
        PELVIS => &PELVIS_SKIN,
        LOWER_SPINE => &WAIST_SKIN,
        MIDDLE_SPINE => &MIDDLE_SKIN,
        UPPER_SPINE => &CHEST_SKIN,
        NECK => &NECK_SKIN,
        _ => &HEAD_SKIN,
    })
}

/// Whether a joint is on the right, where outward is −y.
fn is_right(joint: usize) -> bool {
    ARMS[1].contains(&joint) || LEGS[1].contains(&joint) || joint >= JOINTS + HAND_JOINTS
}

/// The skin of one body.
pub(crate) struct Surface<'a> {
    body: &'a Body,
}

/// The section of the flesh that a point belongs to.
struct Section {
    /// From the centre to the point.
    away: [f64; 3],
    centre: [f64; 3],
    /// The point's distance from the centre over the skin's in the same direction.
    depth: f64,
}

impl<'a> Surface<'a> {
    pub(crate) fn new(body: &'a Body) -> Self {
        Self { body }
    }

    /// The point of the skin on the way out from the bone's core through a point near a joint, lifted by so much
    /// above it.
    ///
    /// # Units
    /// Metres, in the joint's frame.
    pub(crate) fn on(&self, joint: usize, point: [f64; 3], lift_m: f64) -> [f64; 3] {
        /// Above one section a point may still be inside of the next.
        const ROUNDS: usize = 4;
        let mut lifted = point;
        for _ in 0..ROUNDS {
            let Section { away, centre, depth } = self.section(joint, lifted);
            let length = dot(away, away).sqrt();
            if length < 1e-9 {
                break;
            }
            lifted = add(centre, scale(1.0 / depth + lift_m / length, away));
        }
        lifted
    }

    #[cfg(test)]
    /// How far above the skin a point near a joint is, along the way out from the bone's core; negative inside.
    ///
    /// # Units
    /// Metres, in the joint's frame.
    pub(crate) fn height(&self, joint: usize, point: [f64; 3]) -> f64 {
        let Section { away, depth, .. } = self.section(joint, point);
        dot(away, away).sqrt() * (1.0 - 1.0 / depth)
    }

    fn section(&self, joint: usize, point: [f64; 3]) -> Section {
        let size = self.body.flesh[joint];
        let chain = stations(joint);
        let centre = |s: &Station| {
            let [x, y, z] = s.centre;
            let side = if is_right(joint) { -1.0 } else { 1.0 };
            [x * size[0], side * y * size[1], z * size[2]]
        };
        let whole = |a: &Station, b: &Station, share: f64| {
            let (from, to) = (centre(a), centre(b));
            let at = add(from, scale(share, sub(to, from)));
            let away = sub(point, at);
            let half: [f64; 6] =
                std::array::from_fn(|i| a.half[i] + share * (b.half[i] - a.half[i]));
            let depth = (0..3)
                .map(|axis| {
                    // Outward is −y on the right.
                    let ahead = (away[axis] > 0.0) != (axis == 1 && is_right(joint));
                    let reach = half[2 * axis + usize::from(!ahead)] * size[axis];
                    (away[axis] / reach) * (away[axis] / reach)
                })
                .sum::<f64>()
                .sqrt();
            Section { away, centre: at, depth }
        };
        let Some((first, rest)) = chain.split_first() else {
            return Section { away: [0.0; 3], centre: point, depth: 1.0 };
        };
        let mut before = first;
        let mut best = whole(first, first, 0.0);
        for next in rest {
            let (from, to) = (centre(before), centre(next));
            let along = sub(to, from);
            let share = (dot(sub(point, from), along) / dot(along, along)).clamp(0.0, 1.0);
            let section = whole(before, next, share);
            if section.depth < best.depth {
                best = section;
            }
            before = next;
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Activity, Hands, Layout, Person, Synth, SynthParams,
        body::Build,
        dice::{Dice, Stream},
        layout::wear,
    };

    /// Markers stand on bars, shoes and caps too, and a point between two sections may belong to either.
    const HIGHEST_M: f64 = 0.045;

    #[test]
    fn markers_are_stuck_onto_the_skin() {
        for seed in 0..30 {
            let body = Body::new(Build::of(&Person::draw(seed)), true).unwrap();
            let skin = Surface::new(&body);
            for layout in Layout::ALL {
                let mut dice = Dice::new(seed, Stream::Markers);
                for worn in wear(&body, layout, Hands::Ten, 0.007, &mut dice) {
                    let height = skin.height(worn.joints[0], worn.local[0]);
                    assert!((0.001..HIGHEST_M).contains(&height), "{}: {height}", worn.label);
                }
            }
        }
    }

    #[test]
    fn in_motion_they_stay_near_it() {
        for (seed, motion) in (0..).zip(Activity::ALL) {
            let wearer = Person::draw(seed);
            let person = Some(wearer);
            let layout = Layout::FrontWaist53;
            let params =
                SynthParams { seed, motion, person, layout, frames: 240, ..SynthParams::default() };
            let body = Body::new(Build::of(&wearer), false).unwrap();
            let skin = Surface::new(&body);
            let recorded = Synth::new(params).unwrap().take().unwrap();
            for (t, pose) in recorded.motion().poses().iter().enumerate() {
                let frames = body.skeleton.frames(pose).unwrap();
                for (m, attachment) in recorded.attachments().iter().enumerate() {
                    let place = recorded.truth().position(t, m).unwrap();
                    let height = attachment.joints.map(|joint| {
                        let local = frames.rotations[joint]
                            .inverse()
                            .apply(sub(place, frames.origins_m[joint]));
                        skin.height(joint, local)
                    });
                    // Soft tissue goes up to 35 mm, and blended skin sinks in at a bent joint.
                    let nearest = height.into_iter().fold(f64::INFINITY, f64::min);
                    assert!(
                        (-0.05..0.06).contains(&nearest),
                        "{motion} {t} {}: {height:?}",
                        attachment.label
                    );
                }
            }
        }
    }
}
