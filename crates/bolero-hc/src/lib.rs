#![doc = include_str!("../README.md")]

mod cholesky;
mod filler;
mod hook;
mod params;
mod plan;
mod problem;
mod solver;

pub use filler::BoleroHc;
pub use hook::HardBones;
pub use params::BoleroHcParams;
