//! Cutting a gap where its neighbours come and go.

use std::ops::Range;

use mocap_core::Take;

/// Consecutive frames with the neighbours that all of them show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Segment {
    pub frames: Range<usize>,
    /// In order of rank.
    pub usable: Vec<usize>,
}

/// Cuts `frames` into as few segments as offer each frame as many common neighbours as it has itself,
/// up to `enough`. One segment, if all frames have `enough` in common.
pub(crate) fn segments(
    take: &Take,
    ranking: &[usize],
    frames: Range<usize>,
    enough: usize,
) -> Vec<Segment> {
    let seen_throughout = |frames: Range<usize>| {
        let seen = |m: usize| frames.clone().all(|t| take.is_observed(t, m));
        ranking.iter().copied().filter(|&m| seen(m)).collect::<Vec<_>>()
    };
    let whole = seen_throughout(frames.clone());
    if whole.len() >= enough {
        return vec![Segment { frames, usable: whole }];
    }
    let mut segments: Vec<Segment> = Vec::new();
    for t in frames {
        let here = seen_throughout(t..t + 1);
        if let Some(last) = segments.last_mut() {
            let common: Vec<usize> =
                last.usable.iter().copied().filter(|m| here.contains(m)).collect();
            if common.len().min(enough) == here.len().max(last.usable.len()).min(enough) {
                last.usable = common;
                last.frames.end = t + 1;
                continue;
            }
        }
        segments.push(Segment { frames: t..t + 1, usable: here });
    }
    segments
}
