use mocap_core::geometry::{add, scale, sub};

use crate::{
    body::{
        ARMS, Body, FOREARM_M, HEAD, JOINTS, LEGS, LOWER_SPINE, MIDDLE_SPINE, NECK, PELVIS, Scale,
        UPPER_ARM_M, UPPER_SPINE,
    },
    dice::Dice,
    rig::Placed,
};

const L_CLAVICLE: usize = ARMS[0][0];
const R_CLAVICLE: usize = ARMS[1][0];
const L_SHOULDER: usize = ARMS[0][1];
const R_SHOULDER: usize = ARMS[1][1];
const L_ELBOW: usize = ARMS[0][2];
const R_ELBOW: usize = ARMS[1][2];
const L_WRIST: usize = ARMS[0][3];
const R_WRIST: usize = ARMS[1][3];
const L_HIP: usize = LEGS[0][0];
const R_HIP: usize = LEGS[1][0];
const L_KNEE: usize = LEGS[0][1];
const R_KNEE: usize = LEGS[1][1];
const L_ANKLE: usize = LEGS[0][2];
const R_ANKLE: usize = LEGS[1][2];
const L_TOE: usize = LEGS[0][3];
const R_TOE: usize = LEGS[1][3];

/// Where a marker sits on the template.
struct Site {
    label: &'static str,
    /// The joint that carries it, and the one that pulls at the skin with it.
    joints: [usize; 2],
    /// Share of the second joint.
    pull: f64,
    /// From the first joint in the rest pose, in metres of the template.
    offset_m: [f64; 3],
    /// How loose the skin is, 1 for the thigh.
    slack: f64,
}

/// Where breathing lifts a marker, and how far forward and up at one standard deviation, in metres.
const BREATH: [(&str, [f64; 3]); 4] = [
    ("STRN", [0.003, 0.0, 0.002]),
    ("CLAV", [0.001, 0.0, 0.003]),
    ("LFWT", [0.001, 0.0, 0.0]),
    ("RFWT", [0.001, 0.0, 0.0]),
];

const fn site(
    label: &'static str,
    joints: [usize; 2],
    pull: f64,
    offset_m: [f64; 3],
    slack: f64,
) -> Site {
    Site { label, joints, pull, offset_m, slack }
}

/// The layout of the CMU database. Left and right differ where the database's do: thigh, shank,
/// upper-arm and forearm markers sit at different heights, so that software can tell the sides.
#[rustfmt::skip]
const CMU_41: [Site; 41] = [
    site("C7",   [UPPER_SPINE, NECK],         0.35, [-0.050, 0.0, 0.195],     0.45),
    site("CLAV", [UPPER_SPINE, L_CLAVICLE],   0.15, [0.090, 0.0, 0.095],      0.40),
    site("STRN", [UPPER_SPINE, MIDDLE_SPINE], 0.45, [0.120, 0.0, -0.115],     0.45),
    site("T10",  [MIDDLE_SPINE, UPPER_SPINE], 0.35, [-0.095, 0.0, 0.040],     0.45),
    site("RBAC", [UPPER_SPINE, R_CLAVICLE],   0.45, [-0.095, -0.090, 0.055],  0.90),
    site("LFHD", [HEAD, NECK],                0.0,  [0.085, 0.077, 0.065],    0.12),
    site("RFHD", [HEAD, NECK],                0.0,  [0.085, -0.077, 0.065],   0.12),
    site("LBHD", [HEAD, NECK],                0.0,  [-0.070, 0.055, 0.035],   0.12),
    site("RBHD", [HEAD, NECK],                0.0,  [-0.070, -0.055, 0.035],  0.12),
    site("LSHO", [L_CLAVICLE, UPPER_SPINE],   0.15, [-0.030, 0.140, 0.030],   0.80),
    site("LUPA", [L_SHOULDER, L_ELBOW],       0.04, [0.010, 0.050, -0.222],   0.75),
    site("LELB", [L_SHOULDER, L_ELBOW],       0.45, [-0.010, 0.045, -UPPER_ARM_M], 0.40),
    site("LFRM", [L_ELBOW, L_WRIST],          0.25, [0.005, 0.040, -0.165],   0.45),
    site("LWRA", [L_ELBOW, L_WRIST],          0.75, [0.060, 0.0, -FOREARM_M], 0.25),
    site("LWRB", [L_ELBOW, L_WRIST],          0.75, [-0.060, 0.0, -FOREARM_M], 0.25),
    site("LFIN", [L_WRIST, L_ELBOW],          0.0,  [0.005, 0.022, -0.080],   0.40),
    site("RSHO", [R_CLAVICLE, UPPER_SPINE],   0.15, [-0.030, -0.140, 0.030],  0.80),
    site("RUPA", [R_SHOULDER, R_ELBOW],       0.0,  [0.010, -0.055, -0.135],  0.75),
    site("RELB", [R_SHOULDER, R_ELBOW],       0.45, [-0.010, -0.045, -UPPER_ARM_M], 0.40),
    site("RFRM", [R_ELBOW, R_WRIST],          0.12, [0.005, -0.047, -0.090],  0.50),
    site("RWRA", [R_ELBOW, R_WRIST],          0.75, [0.060, 0.0, -FOREARM_M], 0.25),
    site("RWRB", [R_ELBOW, R_WRIST],          0.75, [-0.060, 0.0, -FOREARM_M], 0.25),
    site("RFIN", [R_WRIST, R_ELBOW],          0.0,  [0.005, -0.022, -0.080],  0.40),
    site("LFWT", [PELVIS, L_HIP],             0.12, [0.105, 0.115, 0.005],    0.60),
    site("RFWT", [PELVIS, R_HIP],             0.12, [0.105, -0.115, 0.005],   0.60),
    site("LBWT", [PELVIS, LOWER_SPINE],       0.25, [-0.105, 0.055, 0.030],   0.40),
    site("RBWT", [PELVIS, LOWER_SPINE],       0.25, [-0.105, -0.055, 0.030],  0.40),
    site("LTHI", [L_HIP, L_KNEE],             0.04, [0.025, 0.080, -0.310],   0.90),
    site("LKNE", [L_HIP, L_KNEE],             0.50, [0.000, 0.058, -0.425],   0.35),
    site("LSHN", [L_KNEE, L_ANKLE],           0.0,  [0.025, 0.048, -0.245],   0.60),
    site("LANK", [L_KNEE, L_ANKLE],           0.12, [-0.005, 0.042, -0.427],  0.20),
    site("LHEE", [L_ANKLE, L_KNEE],           0.04, [-0.065, 0.0, -0.037],    0.15),
    site("LMT5", [L_ANKLE, L_TOE],            0.20, [0.090, 0.052, -0.054],   0.20),
    site("LTOE", [L_ANKLE, L_TOE],            0.55, [0.145, -0.005, -0.040],  0.20),
    site("RTHI", [R_HIP, R_KNEE],             0.0,  [0.030, -0.098, -0.175],  1.00),
    site("RKNE", [R_HIP, R_KNEE],             0.50, [0.000, -0.058, -0.425],  0.35),
    site("RSHN", [R_KNEE, R_ANKLE],           0.0,  [0.020, -0.058, -0.125],  0.70),
    site("RANK", [R_KNEE, R_ANKLE],           0.12, [-0.005, -0.042, -0.427], 0.20),
    site("RHEE", [R_ANKLE, R_KNEE],           0.04, [-0.065, 0.0, -0.037],    0.15),
    site("RMT5", [R_ANKLE, R_TOE],            0.20, [0.090, -0.052, -0.054],  0.20),
    site("RTOE", [R_ANKLE, R_TOE],            0.55, [0.145, 0.005, -0.040],   0.20),
];

/// Where a marker of the layout sits on the body that all others vary from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkerSite {
    /// Name of the marker.
    pub label: &'static str,
    /// The joint of the skeleton that carries it.
    pub joint: usize,
    /// The joint that pulls at the skin with it, and its share from 0 to 1.
    pub pull: (usize, f64),
    /// From the first joint in the rest pose, in metres, on a body of 1.75 m.
    pub offset_m: [f64; 3],
}

/// The sites of the layout's markers, in column order.
pub fn marker_sites() -> impl Iterator<Item = MarkerSite> {
    CMU_41.iter().map(|site| MarkerSite {
        label: site.label,
        joint: site.joints[0],
        pull: (site.joints[1], site.pull),
        offset_m: site.offset_m,
    })
}

/// A marker on one body.
pub(crate) struct Worn {
    joints: [usize; 2],
    /// In the frames of the two joints, in metres.
    local: [[f64; 3]; 2],
    pull: f64,
    breath: [f64; 3],
    pub(crate) slack: f64,
}

/// Standard deviation of where a marker is stuck on, per axis, in metres.
const PLACEMENT_M: f64 = 0.008;
/// Limits of the half width of the bar that carries the two wrist markers, over the template's.
const WRIST_BAR: [f64; 2] = [0.62, 1.25];

/// Names of the layout's markers, in column order.
pub(crate) fn labels() -> impl Iterator<Item = &'static str> {
    CMU_41.iter().map(|site| site.label)
}

/// Sticks the markers onto a body.
pub(crate) fn wear(body: &Body, dice: &mut Dice) -> Vec<Worn> {
    let rest = rest_places(body);
    let bar = dice.uniform(WRIST_BAR[0], WRIST_BAR[1]);
    CMU_41
        .iter()
        .map(|site| {
            let [near, far] = site.joints;
            let [mut x, mut y, z] = size(&body.scale, near);
            if site.label.ends_with("WRA") || site.label.ends_with("WRB") {
                x *= bar;
                y *= bar;
            }
            let stuck = [0, 1, 2].map(|_| dice.jitter(PLACEMENT_M));
            // On the foot the floor leaves less room.
            let spread = if LEGS.iter().any(|l| near == l[2]) { 0.5 } else { 1.0 };
            let o = site.offset_m;
            let local = add([o[0] * x, o[1] * y, o[2] * z], scale(spread, stuck));
            let seen_from_far = sub(add(rest[near], local), rest[far]);
            let slack = dice.around(site.slack, 0.15);
            let breath = BREATH.iter().find(|(label, _)| *label == site.label);
            Worn {
                joints: site.joints,
                local: [local, seen_from_far],
                pull: site.pull,
                breath: breath.map_or([0.0; 3], |(_, lift)| *lift),
                slack,
            }
        })
        .collect()
}

impl Worn {
    /// Where the skin under the marker is, blended from the two joints, in metres.
    /// `breath` says how full the lungs are, in standard deviations.
    pub(crate) fn place(&self, frames: &[Placed; JOINTS], breath: f64) -> [f64; 3] {
        let [near, far] = self.joints.map(|joint| &frames[joint]);
        let local: [f64; 3] = std::array::from_fn(|a| self.local[0][a] + breath * self.breath[a]);
        let held = near.point(local);
        if self.pull <= 0.0 {
            return held;
        }
        let pulled = far.point(self.local[1]);
        std::array::from_fn(|a| held[a] + self.pull * (pulled[a] - held[a]))
    }
}

/// Factors of the template along x, y and z for the flesh round a joint.
fn size(s: &Scale, joint: usize) -> [f64; 3] {
    for (arm, leg) in ARMS.iter().zip(LEGS) {
        match joint {
            j if j == arm[1] => return [s.girth, s.girth, s.upper_arm],
            j if j == arm[2] || j == arm[3] => return [s.girth, s.girth, s.forearm],
            j if j == leg[0] => return [s.girth, s.girth, s.thigh],
            j if j == leg[1] => return [s.girth, s.girth, s.shank],
            j if j == leg[2] || j == leg[3] => return [s.foot, s.foot, s.foot],
            _ => {}
        }
    }
    match joint {
        PELVIS | LOWER_SPINE | MIDDLE_SPINE | UPPER_SPINE => [s.girth, s.girth, s.stature],
        _ => [s.stature; 3],
    }
}

fn rest_places(body: &Body) -> Vec<[f64; 3]> {
    let mut places: Vec<[f64; 3]> = Vec::with_capacity(JOINTS);
    for joint in body.skeleton.joints() {
        let origin = joint.parent.map_or([0.0; 3], |p| places[p]);
        places.push(add(origin, joint.offset_m));
    }
    places
}
