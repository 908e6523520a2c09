//! Integration tests of the linear dynamical system.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp)]

mod em;
mod filler;
mod inputs;
mod oracle;
mod sampling;
mod support;
