//! The regression filler against closed forms, its own claims, the shared contract and real takes.
// Tests may unwrap, print what they skip, and compare exactly.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout)]

mod gaps;
mod properties;
mod real;
