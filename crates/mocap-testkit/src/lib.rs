#![doc = include_str!("../README.md")]

mod conformance;
pub mod dense;
mod takes;

pub use conformance::{Claims, conformance};
pub use takes::{articulated_take, rigid_take, with_gaps};
