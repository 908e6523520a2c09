//! The fillers against closed forms, another program, published figures and the shared contract.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout)] // tests

mod curves;
mod donors;
mod published;
mod subspace;
