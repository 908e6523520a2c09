#![doc = include_str!("../README.md")]

mod body;
mod curve;
mod dice;
mod error;
mod habit;
mod hand;
mod layout;
mod math;
mod motion;
mod params;
mod person;
mod retarget;
mod rig;
mod surface;
mod synth;
mod tissue;

pub use error::SynthError;
pub use hand::{FingerAngle, finger_angles};
pub use layout::{Hands, Layout, MarkerSite, marker_sites};
pub use params::{Activity, SynthParams};
pub use person::{Measure, Person, Sex};
pub use synth::{Attachment, Synth, SyntheticTake, record_all};
