#![doc = include_str!("../README.md")]

mod filler;
mod hook;
mod params;
mod problem;
mod solver;

pub use filler::BoleroSc;
pub use hook::SoftBones;
pub use params::{BoleroScParams, Untied};
pub use solver::Solver;
