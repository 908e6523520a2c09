//! Finger markers: on each name 0 is the knuckle, 3 the middle joint and 6 the tip.

use mocap_core::geometry::{add, scale};

use super::{Hands, Site};
use crate::{
    body::{ARMS, JOINTS},
    hand::{HAND_JOINTS, bone_vector, nail},
};

/// Names as the layouts of [Pan23] have them, by side.
#[rustfmt::skip]
const FIVE: [[&str; 5]; 2] = [
    ["LTHM6", "LIDX6", "LMID6", "LRNG6", "LPNK6"],
    ["RTHM6", "RIDX6", "RMID6", "RRNG6", "RPNK6"],
];
#[rustfmt::skip]
const TEN: [[&str; 10]; 2] = [
    ["LTHM3", "LTHM6", "LIDX3", "LIDX6", "LMID0", "LMID6", "LRNG3", "LRNG6", "LPNK3", "LPNK6"],
    ["RTHM3", "RTHM6", "RIDX3", "RIDX6", "RMID0", "RMID6", "RRNG3", "RRNG6", "RPNK3", "RPNK6"],
];

/// The sites of the markers of both hands, the left first.
pub(super) fn sites(hands: Hands) -> impl Iterator<Item = Site> {
    let names: [&'static [&'static str]; 2] = match hands {
        Hands::None => [&[], &[]],
        Hands::Five => [&FIVE[0], &FIVE[1]],
        Hands::Ten => [&TEN[0], &TEN[1]],
    };
    (0..2).flat_map(move |side| names[side].iter().map(move |label| place(label, side)))
}

fn place(label: &'static str, side: usize) -> Site {
    let finger = match &label[1..4] {
        "IDX" => 0,
        "MID" => 1,
        "PNK" => 2,
        "RNG" => 3,
        _ => 4,
    };
    let first = JOINTS + side * HAND_JOINTS + 3 * finger;
    let up = scale(0.012, nail(finger, side));
    // The joint that carries the marker, the one before it and its share of the skin.
    let (joint, before, pull, offset_m) = match label.as_bytes().last() {
        Some(b'0') => (first, ARMS[side][3], 0.5, up),
        // The thumb's middle is its last joint.
        Some(b'3') if finger == 4 => (first + 2, first + 1, 0.5, up),
        Some(b'3') => (first + 1, first, 0.5, up),
        _ => (first + 2, first + 1, 0.0, add(up, scale(0.6, bone_vector(finger, 2, side)))),
    };
    Site { label, joints: [joint, before], pull, offset_m, slack: 0.12, spread: 0.2, small: true }
}
