//! How large the wearer is.

use mocap_core::{Take, geometry::distance};

use crate::body::Body;

/// Size of the wearer over that of the body: the middle ratio of distances between markers that stay the same, or nearly so.
pub(crate) fn size(body: &Body, columns: &[Option<usize>], take: &Take) -> f64 {
    /// A distance that varies by more, as a share, says something about the pose.
    const STEADY: f64 = 0.04;
    /// Shorter distances say more about where markers were stuck on, in metres.
    const LONG_M: f64 = 0.2;
    const FRAMES: usize = 200;
    let rest = body.rest_places();
    let step = take.frames().div_ceil(FRAMES).max(1);
    let mut ratios = Vec::new();
    for a in 0..rest.len() {
        for b in 0..a {
            let (Some(p), Some(q)) = (columns[a], columns[b]) else { continue };
            let expected = distance(rest[a], rest[b]);
            if expected < LONG_M {
                continue;
            }
            let seen: Vec<f64> =
                (0..take.frames()).step_by(step).filter_map(|t| take.distance(t, p, q)).collect();
            let mean = seen.iter().sum::<f64>() / seen.len().max(1) as f64;
            let spread =
                seen.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / seen.len().max(1) as f64;
            if seen.len() >= FRAMES.min(take.frames()) / 4 && spread.sqrt() < STEADY * mean {
                ratios.push(mean / expected);
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().filter(|r| r.is_finite() && *r > 0.0).unwrap_or(1.0)
}
