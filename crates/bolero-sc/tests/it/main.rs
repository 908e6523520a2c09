//! Integration tests of the soft bone constraints.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout)]

mod filler;
mod real;
