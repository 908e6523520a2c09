#![doc = include_str!("../README.md")]

mod counts;
mod dice;
mod error;
mod histogram;
mod log_normal;
mod model;
mod neighbours;
mod params;
mod per_frame;
mod place;
mod preset;
mod protocol;
mod sampler;
mod shift;
mod simplex;
mod statistics;
mod swap;

pub use error::AugmentError;
pub use histogram::GapHistogram;
pub use log_normal::{LengthSpan, LogNormal, LogNormalFit};
pub use model::{OcclusionModel, Unlisted};
pub use neighbours::Neighbours;
pub use params::{Excess, GapSamplerParams, Normalisation, Occluder, Rounding};
pub use per_frame::{PerFrameParams, hide_per_frame};
pub use preset::Preset;
pub use protocol::{Limb, blackout, hide_segment, limb, one_segment, random_segment};
pub use sampler::{GapDraw, GapSampler, MarkerRate, Sampled};
pub use shift::{Shift, ShiftModel, ShiftParams, Shifted, shift_markers};
pub use statistics::{GapStatistics, LengthCount, MarkerOcclusion};
pub use swap::{Swap, SwapParams, Swapped, swap_markers, swap_pair};
