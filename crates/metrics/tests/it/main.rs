// Test code may unwrap and compare exact results exactly.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp)]

mod bones;
mod border;
mod calibration;
mod fill;
mod joints;
mod length;
mod properties;
mod smoothness;

use mocap_core::{MarkerSet, Take};
use ndarray::Array3;

/// Sums of a few numbers near 1 m, in mm: 1e-9 is a thousand times their rounding.
const ROUNDING_MM: f64 = 1e-9;

/// A take at 100 Hz from `positions[marker][frame]`, NaN for missing.
fn take(positions: &[Vec<[f64; 3]>]) -> Take {
    let (frames, markers) = (positions[0].len(), positions.len());
    let xyz = Array3::from_shape_fn((frames, markers, 3), |(t, m, a)| positions[m][t][a]);
    Take::from_positions(names(markers), 100.0, xyz).unwrap()
}

fn names(markers: usize) -> MarkerSet {
    MarkerSet::new((0..markers).map(|m| format!("M{m}"))).unwrap()
}

/// One marker that moves along x.
fn along_x(x: &[f64]) -> Vec<[f64; 3]> {
    x.iter().map(|&x| [x, 0.0, 0.0]).collect()
}

#[track_caller]
fn assert_mm(found: f64, expected: f64) {
    assert!((found - expected).abs() < ROUNDING_MM, "{found} mm, expected {expected} mm");
}
