#![doc = include_str!("../README.md")]

mod options;
mod registry;

pub use baselines::Edges;
pub use options::{Bones, Coordinates, Options};
pub use registry::{BuildError, DEFAULT, METHODS, Method, build};
