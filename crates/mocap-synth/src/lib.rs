#![doc = include_str!("../README.md")]

mod body;
mod curve;
mod dice;
mod error;
mod layout;
mod math;
mod motion;
mod params;
mod rig;
mod skin;
mod synth;

pub use error::SynthError;
pub use layout::{MarkerSite, marker_sites};
pub use params::{Activity, SynthParams};
pub use synth::{Synth, SyntheticTake};
