#![doc = include_str!("../README.md")]

mod border;
pub mod ensemble;
mod filler;
mod frame;
mod gap;
mod join;
mod neighbours;
mod params;
mod predictor;
mod reach;
mod regression;
mod segments;
mod spread;

pub use filler::LocalRidge;
pub use join::join;
pub use params::{LocalRidgeParams, Residual};
