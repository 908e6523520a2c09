#![doc = include_str!("../README.md")]

mod auto;
mod joined;
mod options;
mod own_axes;
mod registry;
mod step;

pub use auto::{Auto, AutoParams};
pub use baselines::Edges;
pub use joined::{Borders, Joined};
pub use lds_kalman::Start;
pub use options::{Bones, Coordinates, Options};
pub use registry::{BuildError, DEFAULT, METHODS, Method, build};
pub use solve_ik::Body;
