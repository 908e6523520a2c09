#![doc = include_str!("../README.md")]

mod border;
mod filler;
mod frame;
mod gap;
mod neighbours;
mod params;
mod predictor;
mod regression;
mod segments;
mod spread;

pub use filler::LocalRidge;
pub use params::{LocalRidgeParams, Residual};
