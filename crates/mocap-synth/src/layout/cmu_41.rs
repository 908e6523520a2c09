use super::{Site, site};
use crate::body::{
    ARMS, FOREARM_M, HEAD, LEGS, LOWER_SPINE, MIDDLE_SPINE, NECK, PELVIS, UPPER_ARM_M, UPPER_SPINE,
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

/// The layout of the CMU database. Left and right differ where the database's do: thigh, shank,
/// upper-arm and forearm markers sit at different heights, so that software can tell the sides.
#[rustfmt::skip]
pub(super) const CMU_41: [Site; 41] = [
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
