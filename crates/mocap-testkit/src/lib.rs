#![doc = include_str!("../README.md")]

mod conformance;
pub mod dense;
mod recordings;
mod takes;

pub use conformance::{Claims, conformance};
pub use recordings::{hide, motion, mse, ninety_trials, oracle_bones, recording};
pub use takes::{articulated_take, rigid_take, with_gaps};
