#![doc = include_str!("../README.md")]

mod breaks;
mod detector;
mod deviation;
mod fault;
mod ghosts;
mod jumps;
mod misplaced;
mod neighbours;
mod params;
mod spikes;
mod swaps;

pub use detector::FaultDetector;
pub use fault::{Fault, FaultKind, Faults};
pub use params::{FaultParams, ParameterError};
