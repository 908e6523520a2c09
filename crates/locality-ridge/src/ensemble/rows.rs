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

/// Frames to learn from: in ascending order those that no pseudo-gap hides or has beside it, then the others.
///
/// In this order the part of the inverse covariance that leaving out a pseudo-gap needs is its last block.
#[derive(Debug)]
pub(super) struct Rows {
    frames: Vec<usize>,
    /// How many stand first.
    apart: usize,
}

impl Rows {
    /// Chooses from the frames `training`, which are in ascending order.
    pub fn choose(training: &[usize], gap: &Range<usize>, pseudo_gaps: &[PseudoGap]) -> Self {
        let step = training.len().div_ceil(SPREAD).max(1);
        let spread: Vec<usize> = training.iter().copied().step_by(step).collect();
        let mut frames = spread.clone();
        frames.extend(beside(gap, BESIDE));
        for gap in pseudo_gaps {
            frames.extend(beside(&gap.frames, BESIDE_PSEUDO));
            let known = spread.iter().filter(|t| gap.frames.contains(t)).count();
            let inside = INSIDE.min(gap.frames.len());
            if known < inside {
                let last = gap.frames.len() - 1;
                let place = |k: usize| gap.frames.start + k * last / (inside - 1).max(1);
                frames.extend((0..inside).map(place));
            }
        }
        frames.sort_unstable();
        frames.dedup();
        frames.retain(|t| training.binary_search(t).is_ok());
        let near = |t: &usize| {
            pseudo_gaps.iter().any(|gap| gap.hidden.start <= t + 1 && *t <= gap.hidden.end)
        };
        let (near, mut apart): (Vec<usize>, Vec<usize>) = frames.into_iter().partition(near);
        let count = apart.len();
        apart.extend(near);
        Self { frames: apart, apart: count }
    }

    /// These and as many frames again of other takes, which come after this one in time.
    pub fn with(&self, others: &[usize]) -> Self {
        let (apart, near) = self.frames.split_at(self.apart);
        let step = others.len().div_ceil(SPREAD).max(1);
        let others = others.iter().copied().step_by(step);
        let mut frames: Vec<usize> = apart.iter().copied().chain(others).collect();
        let apart = frames.len();
        frames.extend(near);
        Self { frames, apart }
    }

    pub fn frames(&self) -> &[usize] {
        &self.frames
    }

    /// How many frames stand before those that pseudo-gaps hide or have beside them.
    pub fn apart(&self) -> usize {
        self.apart
    }

    /// The row whose frame is in the middle of all.
    pub fn middle(&self) -> usize {
        let mut sorted = self.frames.clone();
        sorted.sort_unstable();
        sorted.get(sorted.len() / 2).and_then(|&t| self.index(t)).unwrap_or(0)
    }

    pub fn index(&self, frame: usize) -> Option<usize> {
        let (apart, near) = self.frames.split_at(self.apart);
        let later = || near.binary_search(&frame).ok().map(|k| k + self.apart);
        apart.binary_search(&frame).ok().or_else(later)
    }

    /// Rows of a run of frames that a pseudo-gap hides.
    pub fn range(&self, frames: &Range<usize>) -> Range<usize> {
        let near = &self.frames[self.apart..];
        self.apart + near.partition_point(|&t| t < frames.start)
            ..self.apart + near.partition_point(|&t| t < frames.end)
    }

    /// The frames of a run that a pseudo-gap hides.
    pub fn frames_in(&self, frames: &Range<usize>) -> Vec<usize> {
        self.frames[self.range(frames)].to_vec()
    }
}

fn beside(gap: &Range<usize>, count: usize) -> impl Iterator<Item = usize> {
    (gap.start.saturating_sub(count)..gap.start).chain(gap.end..gap.end + count)
}
