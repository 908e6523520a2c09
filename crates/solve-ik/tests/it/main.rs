//! Solves of synthetic and real takes against what is known of them.
#![allow(clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout)] // tests

mod bodies;
mod built_in;
mod equivariance;
mod fill;
mod real;
mod refusals;
mod synthetic;
mod t_pose;
mod trials;
mod worn;
