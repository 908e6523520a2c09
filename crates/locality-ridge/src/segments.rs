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

/// So many neighbours throughout a gap spare it the cuts: the three of a rigid frame and one more.
const SPARE: usize = 4;

/// Cuts a gap into as few segments as offer each frame as many common neighbours as it has itself,
/// up to `enough`; a gap with four throughout stays whole.
///
/// `span` is the gap with its observed borders. A border joins the segment next to it where that
/// loses no neighbour below `enough`, and stands alone else.
pub(crate) fn segments(
    take: &Take,
    ranking: &[usize],
    gap: &Range<usize>,
    span: &Range<usize>,
    enough: usize,
) -> Vec<Segment> {
    let whole = seen_throughout(take, ranking, span);
    if whole.len() >= enough.min(SPARE) {
        return vec![Segment { frames: span.clone(), usable: whole }];
    }
    let mut segments: Vec<Segment> = Vec::new();
    for t in gap.clone() {
        let here = seen_throughout(take, ranking, &(t..t + 1));
        let joined =
            segments.last_mut().is_some_and(|last| last.take_in(t, &here, here.len(), enough));
        if !joined {
            segments.push(Segment { frames: t..t + 1, usable: here });
        }
    }
    for t in (span.start..gap.start).chain(gap.end..span.end) {
        let here = seen_throughout(take, ranking, &(t..t + 1));
        let at = if t < gap.start { 0 } else { segments.len() };
        let Some(next) = segments.get_mut(at.saturating_sub(1)) else { continue };
        if !next.take_in(t, &here, 0, enough) {
            segments.insert(at, Segment { frames: t..t + 1, usable: here });
        }
    }
    segments
}

impl Segment {
    /// Takes in an adjoining frame with the neighbours `here`, if those in common are as many as the
    /// segment has and `wanted`, up to `enough`.
    fn take_in(&mut self, t: usize, here: &[usize], wanted: usize, enough: usize) -> bool {
        let common: Vec<usize> = self.usable.iter().copied().filter(|m| here.contains(m)).collect();
        if common.len().min(enough) != self.usable.len().max(wanted).min(enough) {
            return false;
        }
        self.usable = common;
        self.frames = self.frames.start.min(t)..self.frames.end.max(t + 1);
        true
    }
}

/// The markers of the ranking that all frames show.
fn seen_throughout(take: &Take, ranking: &[usize], frames: &Range<usize>) -> Vec<usize> {
    let seen = |m: usize| frames.clone().all(|t| take.is_observed(t, m));
    ranking.iter().copied().filter(|&m| seen(m)).collect()
}
