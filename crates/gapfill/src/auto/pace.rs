//! How alike a gap and a pseudo-gap are in how the marker moves beside them.

use std::ops::Range;

use mocap_core::{
    Take,
    geometry::{dot, sub},
};

/// Accelerations are taken over twice this, far above the noise of a camera.
const STRIDE_S: f64 = 0.033;

/// So much on either side of a gap counts as beside it.
const BESIDE_S: f64 = 0.15;

/// Natural logarithm of the ratio of accelerations that makes a pseudo-gap count for 0.6: this much in short gaps, and
/// so much more for each second of the gap, as its borders say less of what is inside.
const TOLERANCE: f64 = 0.7;
const TOLERANCE_PER_S: f64 = 1.0;

/// No pseudo-gap counts for less.
const LEAST: f64 = 0.02;

/// Accelerations below this are noise, in metres per stride².
const FLOOR_M: f64 = 1e-5;

/// By how much errors in each pseudo-gap count: one where the marker is as quick at the borders as at those of the
/// gap, less where it is quicker or slower.
pub(super) fn likeness(
    take: &Take,
    marker: usize,
    gap: &Range<usize>,
    pseudo_gaps: &[Range<usize>],
) -> Vec<f64> {
    let own = pace_m(take, marker, gap);
    let tolerance = TOLERANCE + TOLERANCE_PER_S * gap.len() as f64 / take.rate_hz();
    let of = |other: &Range<usize>| {
        let ratio = own.zip(pace_m(take, marker, other)).map_or(1.0, |(a, b)| b / a);
        (-0.5 * (ratio.ln() / tolerance).powi(2)).exp().max(LEAST)
    };
    pseudo_gaps.iter().map(of).collect()
}

/// Root mean square second difference of the marker beside a gap; `None` where it is not seen there for long enough.
fn pace_m(take: &Take, marker: usize, gap: &Range<usize>) -> Option<f64> {
    let stride = frames_of(STRIDE_S, take).max(1);
    let beside = frames_of(BESIDE_S, take).max(2 * stride + 1);
    let at = |t: usize| take.position(t, marker);
    let second = |t: usize| {
        let (before, here) = (at(t.checked_sub(stride)?)?, at(t)?);
        let after = (t + stride < take.frames()).then(|| at(t + stride)).flatten()?;
        let bend = sub(sub(before, here), sub(here, after));
        Some(dot(bend, bend))
    };
    // Nothing between the borders counts: in a pseudo-gap it is seen, and in the gap it is not.
    let (start, end, last) = (gap.start, gap.end, take.frames());
    let before = start.saturating_sub(beside - stride)..start.saturating_sub(stride);
    let after = (end + stride).min(last)..(end + beside - stride).min(last);
    let squares: Vec<f64> = before.chain(after).filter_map(second).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    (!squares.is_empty()).then(|| (mean + FLOOR_M * FLOOR_M).sqrt())
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // fractions of a second
fn frames_of(seconds: f64, take: &Take) -> usize {
    (seconds * take.rate_hz()).round() as usize
}

#[cfg(test)]
mod tests {
    use mocap_core::MarkerSet;
    use ndarray::Array3;

    use super::*;

    /// One marker that swings with amplitude 0.1 m, ten times as fast from two seconds on.
    fn swing() -> Take {
        let place = |(t, _, a): (usize, usize, usize)| {
            let seconds = t as f64 / 100.0;
            let phase = if t < 200 { 3.0 * seconds } else { 30.0 * seconds };
            if a == 0 { 0.1 * phase.sin() } else { 1.0 }
        };
        let positions = Array3::from_shape_fn((400, 1, 3), place);
        Take::from_positions(MarkerSet::new(["A"]).unwrap(), 100.0, positions).unwrap()
    }

    #[test]
    fn a_pseudo_gap_counts_where_the_marker_is_as_quick() {
        let likeness = likeness(&swing(), 0, &(40..60), &[140..160, 300..320]);
        assert!(likeness[0] > 0.7 && likeness[1] < 0.1, "{likeness:?}");
    }

    /// What a pseudo-gap hides must not tell it from the gap.
    #[test]
    fn nothing_inside_counts() {
        let take = swing();
        let jump =
            |t: usize, _: usize, p: [f64; 3]| if (140..160).contains(&t) { [9.0; 3] } else { p };
        let jumping = take.map_positions(jump).unwrap();
        let of = |take: &Take| likeness(take, 0, &(40..60), &[140..160, 300..320]);
        assert_eq!(of(&take), of(&jumping));
    }

    #[test]
    fn a_gap_that_is_the_whole_take_is_like_any() {
        assert_eq!(likeness(&swing(), 0, &(0..400), &[140..160, 300..320]), [1.0, 1.0]);
    }
}
