#![doc = include_str!("../README.md")]

mod linear;
mod msvd;
mod pca;
mod pchip;
mod per_marker;
mod quintic;
mod spectrum;
mod spline;
mod vicon;

pub use linear::Linear;
pub use msvd::{Msvd, MsvdParams};
pub use pca::{Pca, PcaParams};
pub use pchip::Pchip;
pub use per_marker::Edges;
pub use spline::CubicSpline;
pub use vicon::{PatternFill, QuinticSpline, RigidBodyFill};
