#![doc = include_str!("../README.md")]

mod bones;
mod border;
mod error;
mod fill;
mod stats;

pub use bones::{BoneDeviation, bone_deviation, per_bone};
pub use border::{BorderStep, border_step, border_steps};
pub use error::MetricError;
pub use fill::{GapScore, Mse, Score, mse, per_gap, score};
pub use stats::quantile;

/// Millimetres in a metre: results are given in millimetres, takes in metres.
const MM_PER_M: f64 = 1000.0;
