use mocap_core::{Filled, Gap, Take, geometry};

use crate::MM_PER_M;

/// How abruptly a fill meets the measured samples on either side of its gap.
///
/// At the start of a gap whose first frame is `s`, it is the length of the step into the gap minus the
/// mean of the two steps beside it,
///
/// `‖ (x_s − x_{s−1}) − ½ [ (x_{s−1} − x_{s−2}) + (x_{s+1} − x_s) ] ‖`,
///
/// and likewise at the end. Motion of constant acceleration gives zero, and a fill that is off by a
/// constant J gives J. Where only one of the two neighbouring steps is known, it stands for both.
///
/// `None` where there is no such border (the take starts or ends with the gap), where one side of it is
/// still missing, and where neither neighbouring step is known.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BorderStep {
    /// At the first frame of the gap, in mm.
    pub start_mm: Option<f64>,
    /// At the frame after the gap, in mm.
    pub end_mm: Option<f64>,
}

impl BorderStep {
    /// The larger of the two, in mm.
    #[must_use]
    pub fn max_mm(&self) -> Option<f64> {
        self.start_mm.into_iter().chain(self.end_mm).reduce(f64::max)
    }
}

/// The border steps of one gap of a filled take.
///
/// A gap that holds no frame or lies outside of the take has no borders.
#[must_use]
pub fn border_step(take: &Take, gap: &Gap) -> BorderStep {
    if gap.is_empty() || gap.frames.end > take.frames() || gap.marker >= take.marker_count() {
        return BorderStep::default();
    }
    BorderStep {
        start_mm: step_into(take, gap.marker, gap.frames.start),
        end_mm: step_into(take, gap.marker, gap.frames.end),
    }
}

/// The border steps of every gap of a fill, marker by marker and in time order.
#[must_use]
pub fn border_steps(filled: &Filled) -> Vec<(Gap, BorderStep)> {
    let step = |gap: Gap| {
        let border = border_step(filled.take(), &gap);
        (gap, border)
    };
    filled.gaps().into_iter().map(step).collect()
}

/// Irregularity of the step from frame `t − 1` to frame `t`, in mm.
fn step_into(take: &Take, marker: usize, t: usize) -> Option<f64> {
    let at = |frame: Option<usize>| {
        frame.filter(|&f| f < take.frames()).and_then(|f| take.position(f, marker))
    };
    let (before, after) = (at(t.checked_sub(1))?, at(Some(t))?);
    let previous = at(t.checked_sub(2)).map(|p| geometry::sub(before, p));
    let next = at(t.checked_add(1)).map(|p| geometry::sub(p, after));
    let expected = match (previous, next) {
        (Some(p), Some(n)) => geometry::scale(0.5, geometry::add(p, n)),
        (Some(step), None) | (None, Some(step)) => step,
        (None, None) => return None,
    };
    let step = geometry::sub(after, before);
    Some(MM_PER_M * geometry::distance(step, expected))
}
