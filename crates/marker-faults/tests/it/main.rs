//! The detector on made and on real recordings.
// Tests may unwrap, print what they find, and compare exactly.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout)]

mod bench;
mod kinds;
mod properties;
mod real;
