//! The regression filler against closed forms, its own claims, the shared contract and real takes.
// Tests may unwrap and compare exactly.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp)]

mod gaps;
mod properties;
mod real;
