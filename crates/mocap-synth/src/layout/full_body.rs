//! The two body layouts of [Pan23]: the names are theirs, the places are anatomy.

use super::{Site, site};
use crate::body::{
    ARMS, FOREARM_M, HEAD, LEGS, LOWER_SPINE, MIDDLE_SPINE, NECK, PELVIS, UPPER_ARM_M, UPPER_SPINE,
};

#[rustfmt::skip]
pub(super) const FRONT_WAIST_53: [&str; 53] = [
    "ARIEL", "LFHD", "LBHD", "RFHD", "RBHD", "C7", "T10", "CLAV", "STRN",
    "LFSH", "LBSH", "LUPA", "LELB", "LIEL", "LFRM", "LIWR", "LOWR", "LIHAND", "LOHAND",
    "RFSH", "RBSH", "RUPA", "RELB", "RIEL", "RFRM", "RIWR", "ROWR", "RIHAND", "ROHAND",
    "LFWT", "MFWT", "RFWT", "LBWT", "MBWT", "RBWT",
    "LTHI", "LKNE", "LKNI", "LSHN", "LANK", "LHEL", "LMT5", "LMT1", "LTOE",
    "RTHI", "RKNE", "RKNI", "RSHN", "RANK", "RHEL", "RMT5", "RMT1", "RTOE",
];

#[rustfmt::skip]
pub(super) const PRODUCTION_57: [&str; 57] = [
    "ARIEL", "LFHD", "LBHD", "RFHD", "RBHD", "C7", "T10", "LT10", "RT10", "CLAV", "STRN",
    "LFSH", "LTSH", "LBSH", "LUPA", "LELB", "LBEL", "LFRM", "LIWR", "LOWR", "LIHAND", "LOHAND",
    "RFSH", "RTSH", "RBSH", "RUPA", "RELB", "RBEL", "RFRM", "RIWR", "ROWR", "RIHAND", "ROHAND",
    "LFWT", "LMWT", "LBWT", "RFWT", "RMWT", "RBWT",
    "LTHI", "LKNE", "LKNU", "LSHN", "LANK", "LHEL", "LMT5", "LMT1", "LTOE",
    "RTHI", "RKNE", "RKNU", "RSHN", "RANK", "RHEL", "RMT5", "RMT1", "RTOE",
];

const CLAVICLE: usize = ARMS[0][0];
const SHOULDER: usize = ARMS[0][1];
const ELBOW: usize = ARMS[0][2];
const WRIST: usize = ARMS[0][3];
const HIP: usize = LEGS[0][0];
const KNEE: usize = LEGS[0][1];
const ANKLE: usize = LEGS[0][2];
const TOE: usize = LEGS[0][3];

/// Markers in the middle, or on both sides of a part that has none.
#[rustfmt::skip]
const MIDDLE: [Site; 7] = [
    site("ARIEL", [HEAD, NECK],                0.0,  [0.010, 0.0, 0.150],   0.15),
    site("C7",    [UPPER_SPINE, NECK],         0.35, [-0.050, 0.0, 0.195],  0.45),
    site("T10",   [MIDDLE_SPINE, UPPER_SPINE], 0.35, [-0.095, 0.0, 0.040],  0.45),
    site("CLAV",  [UPPER_SPINE, CLAVICLE],     0.15, [0.090, 0.0, 0.095],   0.40),
    site("STRN",  [UPPER_SPINE, MIDDLE_SPINE], 0.45, [0.120, 0.0, -0.115],  0.45),
    site("MFWT",  [PELVIS, LOWER_SPINE],       0.20, [0.105, 0.0, 0.020],   0.70),
    site("MBWT",  [PELVIS, LOWER_SPINE],       0.15, [-0.115, 0.0, 0.020],  0.40),
];

/// Markers of the left side, without its letter.
#[rustfmt::skip]
const LEFT: [Site; 30] = [
    site("FHD",   [HEAD, NECK],                0.0,  [0.085, 0.070, 0.065],    0.12),
    site("BHD",   [HEAD, NECK],                0.0,  [-0.070, 0.055, 0.035],   0.12),
    site("T10",   [MIDDLE_SPINE, UPPER_SPINE], 0.30, [-0.080, 0.075, 0.045],   0.60),
    site("FSH",   [CLAVICLE, SHOULDER],        0.25, [0.050, 0.125, -0.010],   0.75),
    site("TSH",   [CLAVICLE, UPPER_SPINE],     0.15, [-0.020, 0.140, 0.040],   0.70),
    site("BSH",   [CLAVICLE, SHOULDER],        0.25, [-0.070, 0.115, -0.015],  0.80),
    site("UPA",   [SHOULDER, ELBOW],           0.02, [0.010, 0.055, -0.190],   0.75),
    site("ELB",   [SHOULDER, ELBOW],           0.45, [-0.010, 0.045, -UPPER_ARM_M],  0.40),
    site("IEL",   [SHOULDER, ELBOW],           0.45, [-0.012, -0.045, -UPPER_ARM_M], 0.40),
    site("BEL",   [ELBOW, SHOULDER],           0.35, [-0.045, 0.005, -0.005],  0.45),
    site("FRM",   [ELBOW, WRIST],              0.20, [0.005, 0.040, -0.130],   0.45),
    site("IWR",   [ELBOW, WRIST],              0.75, [0.034, 0.010, -FOREARM_M],  0.25),
    site("OWR",   [ELBOW, WRIST],              0.75, [-0.034, 0.010, -FOREARM_M], 0.25),
    site("IHAND", [WRIST, ELBOW],              0.0,  [0.024, 0.018, -0.070],   0.25),
    site("OHAND", [WRIST, ELBOW],              0.0,  [-0.026, 0.018, -0.060],  0.25),
    site("FWT",   [PELVIS, HIP],               0.12, [0.105, 0.115, 0.005],    0.60),
    site("MWT",   [PELVIS, LOWER_SPINE],       0.15, [0.000, 0.165, 0.040],    0.60),
    site("BWT",   [PELVIS, LOWER_SPINE],       0.20, [-0.105, 0.060, 0.030],   0.45),
    site("THI",   [HIP, KNEE],                 0.02, [0.030, 0.090, -0.240],   0.95),
    site("KNE",   [HIP, KNEE],                 0.50, [0.000, 0.058, -0.425],   0.35),
    site("KNI",   [HIP, KNEE],                 0.50, [0.000, -0.058, -0.425],  0.40),
    site("KNU",   [HIP, KNEE],                 0.25, [0.065, 0.010, -0.355],   0.70),
    site("SHN",   [KNEE, ANKLE],               0.0,  [0.045, 0.012, -0.200],   0.45),
    site("ANK",   [KNEE, ANKLE],               0.12, [-0.005, 0.042, -0.427],  0.20),
    site("HEL",   [ANKLE, KNEE],               0.04, [-0.065, 0.0, -0.037],    0.15),
    site("MT5",   [ANKLE, TOE],                0.20, [0.090, 0.052, -0.054],   0.20),
    site("MT1",   [ANKLE, TOE],                0.20, [0.110, -0.045, -0.050],  0.20),
    site("TOE",   [TOE, ANKLE],                0.20, [0.045, 0.000, 0.012],    0.20),
    // Names of the same places in other layouts.
    site("SHO",   [CLAVICLE, UPPER_SPINE],     0.15, [-0.030, 0.140, 0.030],   0.80),
    site("HEE",   [ANKLE, KNEE],               0.04, [-0.065, 0.0, -0.037],    0.15),
];

/// The sites of these markers.
pub(super) fn sites(names: &[&'static str]) -> Vec<Site> {
    names.iter().filter_map(|name| find(name)).collect()
}

fn find(label: &'static str) -> Option<Site> {
    if let Some(site) = MIDDLE.iter().find(|site| site.label == label) {
        return Some(*site);
    }
    let (side, stem) = label.split_at_checked(1)?;
    let mut site = *LEFT.iter().find(|site| site.label == stem)?;
    site.label = label;
    if side == "R" {
        site.joints = site.joints.map(right);
        site.offset_m[1] = -site.offset_m[1];
    }
    // Little room to go wrong, and the hands' own markers are placed with more care.
    if stem.ends_with("HAND") || stem.ends_with("WR") {
        site.spread = 0.5;
    }
    Some(site)
}

/// The joint of the right side that mirrors one of the left; joints in the middle are their own.
pub(super) fn right(joint: usize) -> usize {
    let sides = [ARMS, LEGS];
    let mirror = sides
        .iter()
        .find_map(|[left, right]| left.iter().position(|&j| j == joint).map(|i| right[i]));
    mirror.unwrap_or(joint)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_has_a_place() {
        assert_eq!(sites(&FRONT_WAIST_53).len(), 53);
        assert_eq!(sites(&PRODUCTION_57).len(), 57);
    }
}
