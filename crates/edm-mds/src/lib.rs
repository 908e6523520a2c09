#![doc = include_str!("../README.md")]

mod filler;
mod gap;
mod moments;
mod neighbours;
mod params;
mod scaling;
mod solve;
mod trilateration;

pub use filler::Edm;
pub use params::{EdmParams, EdmSolver};
