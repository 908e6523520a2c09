#![doc = include_str!("../README.md")]

mod linear;
mod per_marker;
mod spline;

pub use linear::Linear;
pub use per_marker::Edges;
pub use spline::CubicSpline;
