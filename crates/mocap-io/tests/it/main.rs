//! Integration tests of `mocap-io`, one binary.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp)]

mod c3d_damage;
mod c3d_patch;
mod c3d_read;
mod c3d_real;
mod c3d_support;
mod text_damage;
mod text_pair;
mod text_patch;
mod text_real;
mod text_skeletons;
mod text_support;
mod text_tables;
