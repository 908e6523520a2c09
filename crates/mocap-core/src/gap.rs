use std::ops::Range;

use ndarray::ArrayView1;

use crate::Mask;

/// A run of frames in which one marker is missing.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Gap {
    /// Marker index.
    pub marker: usize,
    /// Zero-based frames, end exclusive.
    pub frames: Range<usize>,
}

/// What stands on either side of a gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GapContext {
    /// Observed samples on both sides.
    Interior,
    /// The take begins with the gap.
    Leading,
    /// The take ends with the gap.
    Trailing,
    /// The marker is never seen.
    Whole,
}

impl Gap {
    /// Length in frames.
    #[must_use]
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether the gap holds no frame.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Length in seconds at the given rate.
    #[must_use]
    pub fn seconds(&self, rate_hz: f64) -> f64 {
        self.len() as f64 / rate_hz
    }

    /// Where the gap lies in a take of `frames` frames.
    #[must_use]
    pub fn context(&self, frames: usize) -> GapContext {
        match (self.frames.start == 0, self.frames.end >= frames) {
            (false, false) => GapContext::Interior,
            (true, false) => GapContext::Leading,
            (false, true) => GapContext::Trailing,
            (true, true) => GapContext::Whole,
        }
    }
}

/// The gaps of every marker, marker by marker and in time order.
pub(crate) fn gaps(observed: &Mask) -> Vec<Gap> {
    (0..observed.markers()).flat_map(|m| gaps_of(&observed.marker(m), m)).collect()
}

/// The maximal runs of `false` in one marker's column.
pub(crate) fn gaps_of(observed: &ArrayView1<'_, bool>, marker: usize) -> Vec<Gap> {
    let mut gaps = Vec::new();
    let mut start = None;
    for (t, &seen) in observed.iter().enumerate() {
        match (seen, start) {
            (false, None) => start = Some(t),
            (true, Some(s)) => {
                gaps.push(Gap { marker, frames: s..t });
                start = None;
            }
            _ => {}
        }
    }
    if let Some(s) = start {
        gaps.push(Gap { marker, frames: s..observed.len() });
    }
    gaps
}
