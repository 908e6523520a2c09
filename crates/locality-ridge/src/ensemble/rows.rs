//! Which frames to learn from: motion is far slower than the camera.

use std::ops::Range;

use super::PseudoGap;

/// So many frames, evenly spread, say what there is to learn.
const SPREAD: usize = 160;

/// Frames next to a gap that are all taken.
const BESIDE: usize = 4;

/// The same next to a pseudo-gap.
const BESIDE_PSEUDO: usize = 2;

/// Frames of a pseudo-gap that are taken, at least.
const INSIDE: usize = 12;

/// Frames to learn from, in ascending order.
#[derive(Debug)]
pub(super) struct Rows {
    frames: Vec<usize>,
}

impl Rows {
    /// Chooses from the frames `training`, which are in ascending order.
    pub fn choose(training: &[usize], gap: &Range<usize>, pseudo_gaps: &[PseudoGap]) -> Self {
        let step = training.len().div_ceil(SPREAD).max(1);
        let mut frames: Vec<usize> = training.iter().copied().step_by(step).collect();
        frames.extend(beside(gap, BESIDE));
        for gap in pseudo_gaps {
            frames.extend(beside(&gap.frames, BESIDE_PSEUDO));
            let inside = INSIDE.min(gap.frames.len());
            let last = gap.frames.len() - 1;
            frames.extend((0..inside).map(|k| gap.frames.start + k * last / (inside - 1).max(1)));
        }
        frames.sort_unstable();
        frames.dedup();
        frames.retain(|t| training.binary_search(t).is_ok());
        Self { frames }
    }

    pub fn frames(&self) -> &[usize] {
        &self.frames
    }

    pub fn len(&self) -> usize {
        self.frames.len()
    }

    pub fn index(&self, frame: usize) -> Option<usize> {
        self.frames.binary_search(&frame).ok()
    }

    /// Indices of the rows in a run of frames.
    pub fn range(&self, frames: &Range<usize>) -> Range<usize> {
        self.frames.partition_point(|&t| t < frames.start)
            ..self.frames.partition_point(|&t| t < frames.end)
    }

    pub fn frames_in(&self, frames: &Range<usize>) -> Vec<usize> {
        self.frames[self.range(frames)].to_vec()
    }
}

fn beside(gap: &Range<usize>, count: usize) -> impl Iterator<Item = usize> {
    (gap.start.saturating_sub(count)..gap.start).chain(gap.end..gap.end + count)
}
