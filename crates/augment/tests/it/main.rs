//! Tests of gap statistics and of what is drawn from them.
// Unwrapping is how a test fails; exact comparison is how determinism is tested; a skipped test
// says so.
#![allow(clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout)]

mod log_normal;
mod outliers;
mod per_frame;
mod presets;
mod protocol;
mod real;
mod refusals;
mod sampler;
mod statistics;

use augment::{GapHistogram, OcclusionModel};
use mocap_core::{MarkerSet, Mask, Take};
use ndarray::Array3;

fn names(markers: usize) -> MarkerSet {
    MarkerSet::new((0..markers).map(|m| format!("M{m}"))).unwrap()
}

/// Markers on a line, 10 cm apart, that walk along x; observed where `seen` says so.
fn take_seen(frames: usize, markers: usize, seen: impl FnMut(usize, usize) -> bool) -> Take {
    let xyz = Array3::from_shape_fn((frames, markers, 3), |(t, m, axis)| match axis {
        0 => 0.01 * t as f64,
        1 => 0.1 * m as f64,
        _ => 1.0,
    });
    Take::new(names(markers), 120.0, xyz, Mask::from_fn(frames, markers, seen)).unwrap()
}

fn take(frames: usize, markers: usize) -> Take {
    take_seen(frames, markers, |_, _| true)
}

/// Marker `m` with probability `0.01 (m + 1)`.
fn model(markers: usize, lengths: GapHistogram) -> OcclusionModel {
    let odds = (0..markers).map(|m| (format!("M{m}"), 0.01 * (m + 1) as f64));
    OcclusionModel::new(odds, lengths, 120.0).unwrap()
}
