//! A bound on the steps at the borders of a gap.

use mocap_core::{
    Gap,
    geometry::{add, norm, scale},
};

use crate::step::offsets;

/// No marker is taken to speed up by more than this in m/s²: thirty times gravity, more than in any kick. A sample beside a
/// gap that jumps by itself should not draw the fill along.
const MOST_ACCELERATION: f64 = 300.0;

/// What a step exceeds this by fades over so many seconds.
const FADE_S: f64 = 0.25;

/// What to take off each frame of a gap, so that its steps at both borders are such as a body can make; `None` where they
/// are.
///
/// Where poses in a gap are not like any that were seen, regressions may begin far from the sample before it.
pub(super) fn excess(
    path: &dyn Fn(usize) -> Option<[f64; 3]>,
    gap: &Gap,
    rate_hz: f64,
) -> Option<Vec<[f64; 3]>> {
    let most_m = MOST_ACCELERATION / (rate_hz * rate_hz);
    let offsets = offsets(path, &gap.frames);
    let over = |offset: [f64; 3]| {
        (norm(offset) > most_m).then(|| scale(1.0 - most_m / norm(offset), offset))
    };
    let [entry, exit] = offsets.map(|offset| offset.and_then(over));
    entry.or(exit)?;
    let (entry, exit) = (entry.unwrap_or_default(), exit.unwrap_or_default());
    let fade = (gap.len() as f64 - 1.0).min(FADE_S * rate_hz);
    // Both borders of a gap of one frame show its offset.
    let alone = if offsets.iter().all(Option::is_some) { 0.5 } else { 1.0 };
    let share = |k: usize| if gap.len() == 1 { alone } else { (1.0 - k as f64 / fade).max(0.0) };
    let at = |k: usize| add(scale(share(k), entry), scale(share(gap.len() - 1 - k), exit));
    Some((0..gap.len()).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A marker at rest whose fill stands 0.3 m beside it.
    fn path(t: usize) -> [f64; 3] {
        if (10..40).contains(&t) { [0.3, 0.0, 1.0] } else { [0.0, 0.0, 1.0] }
    }

    #[test]
    fn a_fill_that_stands_aside_is_drawn_to_the_samples() {
        let gap = Gap { marker: 0, frames: 10..40 };
        let off = excess(&|t| Some(path(t)), &gap, 120.0).unwrap();
        let eased = |t: usize| {
            let [x, y, z] = path(t);
            let off = if gap.frames.contains(&t) { off[t - 10] } else { [0.0; 3] };
            Some([x - off[0], y - off[1], z - off[2]])
        };
        let most_m = MOST_ACCELERATION / (120.0 * 120.0);
        for offset in offsets(&eased, &gap.frames).map(Option::unwrap) {
            // The fade itself bends the path a little.
            assert!(norm(offset) < most_m + 0.3 / 29.0, "{offset:?}");
        }
    }

    /// What both borders show of one frame is taken off once.
    #[test]
    fn a_single_frame_is_drawn_to_the_samples() {
        let frame = |t: usize| if t == 10 { [0.3, 0.0, 1.0] } else { [0.0, 0.0, 1.0] };
        let most_m = MOST_ACCELERATION / (120.0 * 120.0);
        let off = |until: usize| {
            let seen = |t: usize| (t < until).then(|| frame(t));
            excess(&seen, &Gap { marker: 0, frames: 10..11 }, 120.0).unwrap()[0]
        };
        for off in [off(20), off(11)] {
            assert!((off[0] - (0.3 - most_m)).abs() < 1e-12, "{off:?}");
        }
    }

    #[test]
    fn steps_that_bodies_make_stay() {
        let gap = Gap { marker: 0, frames: 10..40 };
        let small = |t: usize| Some(path(t).map(|c| 0.01 * c));
        assert!(excess(&small, &gap, 120.0).is_none());
    }
}
