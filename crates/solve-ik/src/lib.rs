#![doc = include_str!("../README.md")]

mod body;
mod bridge;
mod calibrate;
mod choose;
mod companion;
mod dense;
mod error;
mod filler;
mod frame;
mod grip;
mod normal;
mod params;
mod sight;
mod size;
mod solver;
mod start;
mod template;
mod track;
mod tree;

pub use body::Body;
pub use error::IkError;
pub use filler::IkFiller;
pub use params::IkParams;
pub use solver::{CalibrationRound, IkSolver, Solution};
