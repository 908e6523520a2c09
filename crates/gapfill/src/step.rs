//! How far a fill stands from the samples beside it.

use std::ops::Range;

use mocap_core::geometry::{add, scale, sub};

/// Offsets of a fill in metres that show where it begins and where it ends; `None` where a border does not show.
pub(crate) fn offsets(
    path: &dyn Fn(usize) -> Option<[f64; 3]>,
    gap: &Range<usize>,
) -> [Option<[f64; 3]>; 2] {
    // In a gap of one frame the move on its far side shows the same offset once more.
    let echo = |share: f64| if gap.len() == 1 { share } else { 0.0 };
    let entry = Step::at(path, gap.start).map(|s| s.offset(echo(s.later_share)));
    let exit = Step::at(path, gap.end).map(|s| scale(-1.0, s.offset(echo(1.0 - s.later_share))));
    [entry, exit]
}

/// The move across a border, less the usual move beside it.
struct Step {
    step: [f64; 3],
    /// Share of the later move in the usual one: 0, ½ or 1.
    later_share: f64,
}

impl Step {
    /// The step of a path from the frame before `border` to the frame at it; `None` where it does not show there.
    fn at(path: &dyn Fn(usize) -> Option<[f64; 3]>, border: usize) -> Option<Self> {
        let at = |t: Option<usize>| t.and_then(path);
        let (before, here) = (at(border.checked_sub(1))?, at(Some(border))?);
        let earlier = at(border.checked_sub(2)).map(|p| sub(before, p));
        let later = at(Some(border + 1)).map(|p| sub(p, here));
        let (usual, later_share) = match (earlier, later) {
            (Some(p), Some(q)) => (scale(0.5, add(p, q)), 0.5),
            (Some(earlier), None) => (earlier, 0.0),
            (None, Some(later)) => (later, 1.0),
            (None, None) => return None,
        };
        Some(Self { step: sub(sub(here, before), usual), later_share })
    }

    /// The offset of the fill that shows as this step, if `echo` of it shows in the usual move too.
    fn offset(&self, echo: f64) -> [f64; 3] {
        scale(1.0 / (1.0 + echo), self.step)
    }
}
