//! How steady the markers sit.
//!
//! Skin over a thigh slides by centimetres while a heel marker hardly moves, so they do not deserve the same weight. What
//! poses leave over tells them apart, though not fully: a marker at the end of a limb is followed by its joint, slide or
//! not, and misses little. Weights therefore go with the inverse of what a marker misses by, halfway from weights that are all
//! alike to the inverse of its variance.

use mocap_core::geometry::{dot, sub};

use crate::{
    IkParams,
    sight::Sight,
    track::Scout,
    tree::{Placed, Tree},
};

/// A miss of a marker that never misses, in metres: markers of a cluster explain each other.
const LEAST_M: f64 = 0.003;
/// Weights stay within this factor of those of the middle marker.
const MOST: f64 = 4.0;

/// Weighs the markers of a tree by how far they are from where the scout's poses have them.
pub(crate) fn weigh(tree: &mut Tree, sight: &Sight, scout: &Scout, params: &IkParams) {
    // One mislabelled frame does not make a marker loose.
    let worst = (3.0 * params.robust_m).powi(2);
    let mut sums = vec![(0.0, 0.0_f64); tree.anchors.len()];
    let mut placed = vec![Placed::NOWHERE; tree.len()];
    for (k, state) in scout.states.iter().enumerate() {
        tree.place(state, &mut placed);
        for &(index, at) in sight.at(k * scout.stride) {
            let index = index as usize;
            let miss = sub(tree.marker(&tree.anchors[index], &placed), at);
            sums[index].0 += dot(miss, miss).min(worst);
            sums[index].1 += 1.0;
        }
    }
    let typical = |&(sum, count): &(f64, f64)| (sum / count.max(1.0) + LEAST_M * LEAST_M).sqrt();
    let mut misses: Vec<f64> = sums.iter().filter(|s| s.1 > 0.0).map(typical).collect();
    misses.sort_by(f64::total_cmp);
    let Some(&middle) = misses.get(misses.len() / 2) else { return };
    for (anchor, sum) in tree.anchors.iter_mut().zip(&sums) {
        let seen = sum.1 > 0.0;
        anchor.grip = if seen { (middle / typical(sum)).clamp(1.0 / MOST, MOST) } else { 1.0 };
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use mocap_core::{MarkerSet, Take};
    use ndarray::Array3;

    use super::*;
    use crate::Body;

    /// A body at rest, one of whose markers swings to and fro by 2 cm.
    #[test]
    fn a_marker_that_slides_weighs_less() {
        const FRAMES: usize = 24;
        const LOOSE: &str = "LTHI";
        let body = Body::cmu_41();
        let labels: Vec<String> = body.markers().map(str::to_owned).collect();
        let columns: Vec<Option<usize>> = (0..labels.len()).map(Some).collect();
        let mut tree = Tree::new(&body, &columns);
        let mut placed = vec![Placed::NOWHERE; tree.len()];
        tree.place(&tree.rest(), &mut placed);
        let slide = |label: &str, t: usize| match (label, t % 2) {
            (LOOSE, 0) => 0.02,
            (LOOSE, _) => -0.02,
            _ => 0.0,
        };
        let positions = Array3::from_shape_fn((FRAMES, labels.len(), 3), |(t, m, a)| {
            tree.marker(&tree.anchors[m], &placed)[a] + slide(&labels[m], t)
        });
        let markers = Arc::new(MarkerSet::new(labels.clone()).unwrap());
        let take = Take::from_positions(markers, 120.0, positions).unwrap();
        let sight = Sight::new(&take, &tree);
        let scout = Scout { stride: 1, states: vec![tree.rest(); FRAMES] };
        weigh(&mut tree, &sight, &scout, &IkParams::default());
        for (label, anchor) in labels.iter().zip(&tree.anchors) {
            // 35 mm over 3 mm is more than the most.
            let expected = if label == LOOSE { 1.0 / MOST } else { 1.0 };
            assert!((anchor.grip - expected).abs() < 1e-6, "{label}: {}", anchor.grip);
        }
    }
}
