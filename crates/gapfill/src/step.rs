//! How far a fill stands from the samples beside it.

use mocap_core::geometry::{add, scale, sub};

/// The move across a border, less the usual move beside it.
pub(crate) struct Step {
    pub step: [f64; 3],
    /// Share of the later move in the usual one: 0, ½ or 1.
    pub later_share: f64,
}

impl Step {
    /// The step of a path from the frame before `border` to the frame at it; `None` where it does not show there.
    pub fn at(path: &dyn Fn(usize) -> Option<[f64; 3]>, border: usize) -> Option<Self> {
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
    pub fn offset(&self, echo: f64) -> [f64; 3] {
        scale(1.0 / (1.0 + echo), self.step)
    }
}
