#![doc = include_str!("../README.md")]

mod bones;
mod border;
mod calibration;
mod error;
mod fill;
mod joints;
mod length;
mod smoothness;
mod stats;

pub use bones::{BoneDeviation, bone_deviation, per_bone};
pub use border::{BorderStep, border_step, border_steps};
pub use calibration::{Calibration, Within, calibration, calibration_by_gap_length};
pub use error::MetricError;
pub use fill::{GapScore, Mse, Score, mse, per_gap, score};
pub use joints::{JointChoice, JointError, JointErrors, JointFrame, JointPoses, joint_errors};
pub use length::{LengthScore, by_gap_length, gap_length_classes};
pub use smoothness::{Smoothness, smoothness};
pub use stats::quantile;

/// Millimetres in a metre: results are given in millimetres, takes in metres.
const MM_PER_M: f64 = 1000.0;
