use std::ops::Range;

use mocap_core::{Gap, Mask};

use crate::dice::Dice;

/// Random starts tried before the column is searched.
const TRIES: usize = 64;
/// Random starts tried inside an occluder before the gap is left to itself.
const TRIES_WITHIN: usize = 8;

/// The frames of one marker, and which of them are still free for gaps.
pub(crate) struct Column {
    marker: usize,
    blocked: Vec<bool>,
    gaps: Vec<Gap>,
    /// The shortest gap that found no room; no longer one will.
    no_room: usize,
}

impl Column {
    pub(crate) fn new(observed: &Mask, marker: usize) -> Self {
        let blocked = observed.marker(marker).iter().map(|seen| !seen).collect();
        Self { marker, blocked, gaps: Vec::new(), no_room: usize::MAX }
    }

    /// The gaps placed so far.
    pub(crate) fn into_gaps(self) -> Vec<Gap> {
        self.gaps
    }

    /// Frames in the longest run without gaps, the two beside a gap left out.
    pub(crate) fn longest_room(&self) -> usize {
        let runs = self.blocked.split(|&blocked| blocked);
        runs.map(<[bool]>::len).max().unwrap_or(0).saturating_sub(2)
    }

    pub(crate) fn free_frames(&self) -> usize {
        self.blocked.iter().filter(|&&blocked| !blocked).count()
    }

    /// Hides a run of this many frames at a random place; `None` if there is no room.
    ///
    /// At least one observed frame stays on either side, so that gaps keep their length. Starts
    /// are uniform over the free ones. Where free starts are so rare that random ones miss, it is
    /// the next free one after a random frame.
    pub(crate) fn place(&mut self, length: usize, dice: &mut Dice) -> Option<Range<usize>> {
        let frames = self.blocked.len();
        if length >= self.no_room || frames < length + 2 {
            return None;
        }
        let mut random = || 1 + dice.below(frames - length - 1);
        let start = (0..TRIES)
            .map(|_| random())
            .find(|&start| self.fits(start, length))
            .or_else(|| self.next_room(random() - 1, length))
            .or_else(|| self.next_room(0, length));
        if start.is_none() {
            self.no_room = length;
        }
        start.map(|start| self.hide(start, length))
    }

    /// Hides a run of this many frames at a random place inside `within`, if a few tries find room.
    pub(crate) fn place_within(
        &mut self,
        within: &Range<usize>,
        length: usize,
        dice: &mut Dice,
    ) -> Option<Range<usize>> {
        let starts = (within.len() + 1).checked_sub(length)?;
        let start = (0..TRIES_WITHIN)
            .map(|_| within.start + dice.below(starts))
            .find(|&start| self.fits(start, length))?;
        Some(self.hide(start, length))
    }

    fn hide(&mut self, start: usize, length: usize) -> Range<usize> {
        let frames = start..start + length;
        self.blocked[frames.clone()].fill(true);
        self.gaps.push(Gap { marker: self.marker, frames: frames.clone() });
        frames
    }

    fn fits(&self, start: usize, length: usize) -> bool {
        self.blocked[start - 1..=start + length].iter().all(|&blocked| !blocked)
    }

    /// The first start, not before `from + 1`, of a run that fits.
    fn next_room(&self, from: usize, length: usize) -> Option<usize> {
        let mut free = 0;
        for (t, &blocked) in self.blocked.iter().enumerate().skip(from) {
            free = if blocked { 0 } else { free + 1 };
            if free == length + 2 {
                return Some(t - length);
            }
        }
        None
    }
}
