//! Runs of observed frames that are treated as gaps, so that errors can be seen.

use std::ops::Range;

/// Which sides of a gap show an observed sample of the marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Sides {
    /// Just before the gap.
    pub left: bool,
    /// Just after it.
    pub right: bool,
}

/// So many pseudo-gaps tell candidates apart.
pub(super) const COUNT: usize = 8;

/// A pseudo-gap takes at most this share of the run of frames that it is cut from.
const SHARE: f64 = 0.6;

/// A pseudo-gap, cut like a gap: of its length, and with what stands beside it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct PseudoGap {
    /// Frames whose errors count.
    pub frames: Range<usize>,
    /// Frames that are not learnt from: on a side that a gap lacks, some more than those that count.
    pub hidden: Range<usize>,
    /// What stands beside it.
    pub sides: Sides,
}

/// Cuts up to `count` pseudo-gaps for a gap of `length` frames out of the frames `seen`, which are in ascending order:
/// evenly spread over the places that have room for one.
///
/// Where no run of frames is long enough they are shorter than the gap. On a side without a border they hide
/// `margin` frames more. There is none where no run has five frames.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a share of frames
pub fn pseudo_gaps(
    seen: &[usize],
    length: usize,
    sides: Sides,
    margin: usize,
    count: usize,
) -> Vec<PseudoGap> {
    let runs: Vec<Range<usize>> =
        seen.chunk_by(|a, b| a + 1 == *b).map(|run| run[0]..run[run.len() - 1] + 1).collect();
    let longest = runs.iter().map(ExactSizeIterator::len).max().unwrap_or(0);
    let length = length.min((longest as f64 * SHARE) as usize).max(3);
    let starts: Vec<usize> =
        runs.iter().flat_map(|run| run.start + 1..run.end.saturating_sub(length)).collect();
    let count = count.min(starts.len());
    let mut cut: Vec<PseudoGap> = (0..count)
        .map(|k| {
            let start = starts[(2 * k + 1) * starts.len() / (2 * count)];
            let frames = start..start + length;
            let before = if sides.left { 0 } else { margin };
            let after = if sides.right { 0 } else { margin };
            let hidden = frames.start.saturating_sub(before)..frames.end + after;
            PseudoGap { frames, hidden, sides }
        })
        .collect();
    cut.dedup();
    cut
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: Sides = Sides { left: true, right: true };

    #[test]
    fn pseudo_gaps_keep_a_border_on_either_side() {
        let seen: Vec<usize> = (10..60).chain(80..100).collect();
        for length in [1, 7, 30, 400] {
            let cut = pseudo_gaps(&seen, length, BOTH, 9, COUNT);
            assert_eq!(cut.len(), COUNT);
            for gap in cut {
                assert_eq!(gap.frames.len(), length.clamp(3, 30));
                assert_eq!(gap.hidden, gap.frames);
                assert!((gap.frames.start - 1..=gap.frames.end).all(|t| seen.contains(&t)));
            }
        }
    }

    #[test]
    fn a_side_without_a_border_hides_more() {
        let seen: Vec<usize> = (0..100).collect();
        let cut = pseudo_gaps(&seen, 10, Sides { left: true, right: false }, 5, COUNT);
        assert!(cut.iter().all(|gap| gap.hidden == (gap.frames.start..gap.frames.end + 5)));
    }

    #[test]
    fn there_is_none_without_room() {
        assert_eq!(pseudo_gaps(&[1, 2, 3, 4, 9, 10], 2, BOTH, 0, COUNT), []);
        assert_eq!(pseudo_gaps(&[], 2, BOTH, 0, COUNT), []);
    }
}
