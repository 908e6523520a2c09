//! The types refuse wrong states and keep right ones.
#![allow(clippy::unwrap_used, clippy::float_cmp)] // tests

mod body_frame;
mod bones;
mod kinematics;
mod knowledge;
mod part_frame;
mod rotations;
mod skeleton;
mod takes;

use mocap_core::{MarkerSet, Take};
use ndarray::Array3;

/// Markers `m0 …` at the positions that `place(frame, marker)` gives, NaN for none.
pub(crate) fn take(
    frames: usize,
    markers: usize,
    place: impl Fn(usize, usize) -> Option<[f64; 3]>,
) -> Take {
    let names = MarkerSet::new((0..markers).map(|m| format!("m{m}"))).unwrap();
    let xyz = Array3::from_shape_fn((frames, markers, 3), |(t, m, a)| {
        place(t, m).map_or(f64::NAN, |p| p[a])
    });
    Take::from_positions(names, 100.0, xyz).unwrap()
}
