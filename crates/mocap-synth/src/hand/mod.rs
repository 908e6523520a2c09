//! The bones of the hands, and how they turn.

mod fingers;
mod grip;
mod pinch;

pub(crate) use fingers::Fingers;
pub use grip::{FingerAngle, finger_angles};

use mocap_core::{
    Joint, Rotation,
    geometry::{add, cross, norm, scale},
};

use crate::{
    body::{ARMS, JOINTS, SIDE},
    math::{about_x, about_y, sin_cos},
};
use grip::Grip;

/// Joints of one hand: three each of index, middle, little and ring finger and thumb.
pub(crate) const HAND_JOINTS: usize = 15;
/// Fingers without the thumb.
const FINGERS: usize = 4;
/// First joint of the thumb among the hand's.
const THUMB: usize = 3 * FINGERS;

/// A finger of the left hand that hangs down with the thumb ahead (+x) and the palm inward (−y), in metres.
struct Ray {
    name: &'static str,
    /// Its knuckle, or the thumb's root, from the wrist.
    root: [f64; 3],
    /// Lengths of its three bones; the last one with the flesh of the tip.
    bones: [f64; 3],
}

/// Lengths of bones are the means of [Buryanov10]; the last joint's gap and the pad of the tip add some 4 mm.
const RAYS: [Ray; FINGERS + 1] = [
    Ray { name: "index", root: [0.024, 0.000, -0.089], bones: [0.0398, 0.0224, 0.0200] },
    Ray { name: "middle", root: [0.002, 0.004, -0.091], bones: [0.0446, 0.0263, 0.0214] },
    Ray { name: "pinky", root: [-0.036, -0.004, -0.077], bones: [0.0327, 0.0181, 0.0200] },
    Ray { name: "ring", root: [-0.018, 0.002, -0.085], bones: [0.0414, 0.0257, 0.0213] },
    Ray { name: "thumb", root: [0.020, -0.010, -0.022], bones: [0.0462, 0.0316, 0.0257] },
];

/// Where the resting thumb of a left hand points, and where its tip goes when it bends.
const THUMB_ALONG: [f64; 3] = [0.66, -0.36, -0.66];
const THUMB_BENDS: [f64; 3] = [-0.70, -0.30, -0.65];

/// The joints of a hand, to be put behind the body's: the left hand's first.
pub(crate) fn joints(side: usize, size: f64) -> impl Iterator<Item = Joint> {
    let first = JOINTS + side * HAND_JOINTS;
    let [.., wrist] = ARMS[side];
    let word = ["left", "right"][side];
    RAYS.iter().enumerate().flat_map(move |(finger, ray)| {
        (0..3).map(move |bone| {
            let (parent, offset) = match bone {
                0 => (wrist, mirrored(ray.root, SIDE[side])),
                _ => (first + 3 * finger + bone - 1, bone_vector(finger, bone - 1, side)),
            };
            Joint {
                name: format!("{word}_{}{}", ray.name, bone + 1),
                parent: Some(parent),
                offset_m: scale(size, offset),
            }
        })
    })
}

/// From a joint of a finger to the next, or to the tip, of an average man's hand.
pub(crate) fn bone_vector(finger: usize, bone: usize, side: usize) -> [f64; 3] {
    scale(RAYS[finger].bones[bone], along(finger, side))
}

fn along(finger: usize, side: usize) -> [f64; 3] {
    if finger < FINGERS {
        return [0.0, 0.0, -1.0];
    }
    unit(mirrored(THUMB_ALONG, SIDE[side]))
}

/// Direction of the nail in the rest pose.
pub(crate) fn nail(finger: usize, side: usize) -> [f64; 3] {
    if finger < FINGERS {
        return [0.0, SIDE[side], 0.0];
    }
    // Against the way that the bending tip goes, and square to the thumb.
    let axis = thumb_axes(side)[0];
    unit(cross(along(finger, side), axis))
}

/// Axes of the left or right thumb's bending and of its spreading from the palm.
fn thumb_axes(side: usize) -> [[f64; 3]; 2] {
    let along = along(FINGERS, side);
    let bend = unit(cross(along, unit(mirrored(THUMB_BENDS, SIDE[side]))));
    let palmar = [0.0, -SIDE[side], 0.0];
    [bend, unit(cross(along, palmar))]
}

/// Rotations of a hand's joints relative to their parents.
pub(crate) fn rotations(grip: &Grip, side: usize) -> [Rotation; HAND_JOINTS] {
    let s = SIDE[side];
    let mut turns = [Rotation::IDENTITY; HAND_JOINTS];
    for finger in 0..FINGERS {
        let [knuckle, spread, middle, last] = grip.finger(finger);
        let bend = |radians: f64| about_x(-s * radians);
        turns[3 * finger] = about_y(-spread).after(bend(knuckle));
        turns[3 * finger + 1] = bend(middle);
        turns[3 * finger + 2] = bend(last);
    }
    let [flexion, spread, middle, last] = grip.finger(FINGERS);
    let [bend, palmar] = thumb_axes(side);
    turns[THUMB] = about(palmar, spread).after(about(bend, flexion));
    turns[THUMB + 1] = about(bend, middle);
    turns[THUMB + 2] = about(bend, last);
    turns
}

/// The pad of a finger's tip seen from the wrist, on an average man's hand.
fn pad(grip: &Grip, finger: usize, side: usize) -> [f64; 3] {
    /// Bone lies this deep under the pad, in metres.
    const PAD_M: f64 = 0.007;
    let turns = rotations(grip, side);
    let mut turn = Rotation::IDENTITY;
    let mut place = mirrored(RAYS[finger].root, SIDE[side]);
    for bone in 0..3 {
        turn = turn.after(turns[3 * finger + bone]);
        let mut vector = bone_vector(finger, bone, side);
        if bone == 2 {
            // The pad is in the middle of the last bone, on the palm's side.
            vector = add(scale(0.6, vector), scale(-PAD_M, nail(finger, side)));
        }
        place = add(place, turn.apply(vector));
    }
    place
}

fn about(axis: [f64; 3], radians: f64) -> Rotation {
    let (s, c) = sin_cos(0.5 * radians);
    Rotation::from_quaternion(c, scale(s, axis)).unwrap_or(Rotation::IDENTITY)
}

fn mirrored([x, y, z]: [f64; 3], side: f64) -> [f64; 3] {
    [x, side * y, z]
}

fn unit(p: [f64; 3]) -> [f64; 3] {
    scale(1.0 / norm(p), p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::geometry::{distance, dot};

    #[test]
    fn fingers_bend_toward_the_palm_and_hands_mirror_each_other() {
        let grip = Grip::POWER;
        for finger in 0..=FINGERS {
            let [left, right] = [0, 1].map(|side| pad(&grip, finger, side));
            assert!(distance(left, mirrored(right, -1.0)) < 1e-12, "{finger}");
            let open = pad(&Grip::OPEN, finger, 0);
            // A left palm looks to −y, and its thumb closes from ahead.
            let closes = if finger == FINGERS { open[0] - left[0] } else { open[1] - left[1] };
            assert!(closes > 0.01, "{finger}: {left:?} {open:?}");
        }
    }

    /// Points along a finger's bones.
    fn points(grip: &Grip, finger: usize) -> Vec<[f64; 3]> {
        let turns = rotations(grip, 0);
        let mut turn = Rotation::IDENTITY;
        let mut place = RAYS[finger].root;
        let mut points = Vec::new();
        for bone in 0..3 {
            turn = turn.after(turns[3 * finger + bone]);
            let along = turn.apply(bone_vector(finger, bone, 0));
            points.extend((0..=8).map(|k| add(place, scale(f64::from(k) / 8.0, along))));
            place = add(place, along);
        }
        points
    }

    #[test]
    fn the_thumb_passes_no_finger() {
        for (n, grip) in
            Grip::GRASPS.iter().chain([&Grip::READY, &Grip::REST, &Grip::OPEN]).enumerate()
        {
            // The thumb's last two bones.
            let thumb = points(grip, FINGERS).split_off(9);
            for finger in 0..FINGERS {
                let other = points(grip, finger);
                let nearest = thumb
                    .iter()
                    .flat_map(|p| other.iter().map(|q| distance(*p, *q)))
                    .fold(f64::INFINITY, f64::min);
                // Skin yields where they touch, so bones come nearer than two fingers are thick.
                assert!(nearest > 0.010, "grip {n}, finger {finger}: {nearest}");
            }
        }
    }

    #[test]
    fn nails_are_square_to_their_fingers() {
        for side in 0..2 {
            for finger in 0..=FINGERS {
                assert!(dot(nail(finger, side), along(finger, side)).abs() < 1e-12);
            }
        }
    }
}
