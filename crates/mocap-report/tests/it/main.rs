// Test code may unwrap and compare exact results exactly.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp)]

mod figure;
mod html;
mod motion;
mod properties;
mod spots;
mod summary;
mod table;
mod xml;

use mocap_core::{
    Bone, BoneSet, Estimates, FillReport, Filled, Gap, MarkerSet, Mask, Refusal, Take, Termination,
};
use ndarray::{Array2, Array3};

/// Markers `names` on parallel lines along x, 0.25 m apart in z, at 100 Hz.
fn take(names: &[&str], frames: usize) -> Take {
    let xyz = Array3::from_shape_fn((frames, names.len(), 3), |(t, m, a)| match a {
        0 => 0.01 * t as f64,
        1 => 0.2 * (0.1 * t as f64).sin(),
        _ => 0.25 * m as f64,
    });
    Take::from_positions(MarkerSet::new(names.iter().copied()).unwrap(), 100.0, xyz).unwrap()
}

fn hide(take: &Take, gaps: &[Gap]) -> Take {
    let inside = |t, m| gaps.iter().any(|gap| gap.marker == m && gap.frames.contains(&t));
    take.hide(&Mask::from_fn(take.frames(), take.marker_count(), inside)).unwrap()
}

fn gap(marker: usize, frames: std::ops::Range<usize>) -> Gap {
    Gap { marker, frames }
}

/// A chain of bones through all markers.
fn chain(take: &Take) -> BoneSet {
    BoneSet::new((1..take.marker_count()).map(|m| Bone::new(m - 1, m, 0.25).unwrap())).unwrap()
}

/// Two gaps: that of `KNEE` filled 20 mm too high with sigma 5 mm, that of `ANKLE` refused.
fn filled(truth: &Take) -> Filled {
    let input = hide(truth, &[gap(1, 10..20), gap(2, 30..50)]);
    let mut positions = truth.positions().to_owned();
    positions.slice_mut(ndarray::s![.., 1, 2]).mapv_inplace(|z| z + 0.02);
    let sigma_m = Some(Array2::from_elem((truth.frames(), truth.marker_count()), 0.005));
    let mut report = FillReport::new("lift", Termination::IterationLimit);
    report.iterations = 4;
    Filled::merge(&input, Estimates { positions, sigma_m }, report)
        .unwrap()
        .refuse(gap(2, 30..50), Refusal::TooLong { gap_s: 0.2, limit_s: 0.15 })
        .unwrap()
}

fn leg() -> Take {
    take(&["HIP", "KNEE", "ANKLE"], 50)
}
