//! Integration tests of the hard bone constraints.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout)]

mod filler;
mod real;
