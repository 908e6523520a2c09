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

/// So many near neighbours in common are enough: the three of a rigid frame and one more.
const ENOUGH: usize = 4;

/// So many neighbours make a rigid frame.
const RIGID: usize = 3;

/// Cuts a gap into as few segments as offer each frame as many common neighbours as it has itself, up
/// to four. A gap stays whole if four of its `near` best neighbours are seen throughout.
///
/// `span` is the gap with its observed borders. A border joins the segment next to it where that
/// leaves the segment enough neighbours, and stands alone else.
pub(crate) fn segments(
    take: &Take,
    ranking: &[usize],
    gap: &Range<usize>,
    span: &Range<usize>,
    near: usize,
) -> Vec<Segment> {
    let sometimes = |m: &usize| gap.clone().any(|t| take.is_observed(t, *m));
    let seen: Vec<usize> = ranking.iter().copied().filter(sometimes).collect();
    let near = &seen[..near.min(seen.len())];
    let whole = seen_throughout(take, &seen, span);
    if whole.iter().filter(|m| near.contains(m)).count() >= ENOUGH.min(near.len()) {
        return vec![Segment { frames: span.clone(), usable: whole }];
    }
    let shown = |t: usize, of: &[usize]| of.iter().filter(|&&m| take.is_observed(t, m)).count();
    let near_do = gap.clone().all(|t| shown(t, near) >= RIGID.min(shown(t, &seen)));
    let mut segments = cut(take, if near_do { near } else { &seen }, gap);
    attach_borders(take, ranking, gap, span, &mut segments);
    segments
}

fn cut(take: &Take, ranking: &[usize], gap: &Range<usize>) -> Vec<Segment> {
    let mut segments: Vec<Segment> = Vec::new();
    for t in gap.clone() {
        let here = seen_throughout(take, ranking, &(t..t + 1));
        let joined = segments.last_mut().is_some_and(|last| last.take_in(t, &here, here.len()));
        if !joined {
            segments.push(Segment { frames: t..t + 1, usable: here });
        }
    }
    segments
}

fn attach_borders(
    take: &Take,
    ranking: &[usize],
    gap: &Range<usize>,
    span: &Range<usize>,
    segments: &mut Vec<Segment>,
) {
    for t in (span.start..gap.start).chain(gap.end..span.end) {
        let here = seen_throughout(take, ranking, &(t..t + 1));
        let at = if t < gap.start { 0 } else { segments.len() };
        let Some(next) = segments.get_mut(at.saturating_sub(1)) else { continue };
        if !next.take_in(t, &here, 0) {
            segments.insert(at, Segment { frames: t..t + 1, usable: here });
        }
    }
}

impl Segment {
    /// Takes in an adjoining frame with the neighbours `here`, if those in common are as many as the
    /// segment has and `wanted`, up to four.
    fn take_in(&mut self, t: usize, here: &[usize], wanted: usize) -> bool {
        let common: Vec<usize> = self.usable.iter().copied().filter(|m| here.contains(m)).collect();
        if common.len().min(ENOUGH) != self.usable.len().max(wanted).min(ENOUGH) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::{MarkerSet, Mask};
    use ndarray::Array3;

    /// Marker 0 is missing in frames 2 to 7 of ten; `seen` says when the eight others are seen.
    fn of(seen: impl Fn(usize, usize) -> bool) -> Vec<Segment> {
        let mask =
            Mask::from_fn(10, 9, |t, m| if m == 0 { !(2..8).contains(&t) } else { seen(t, m) });
        let names = MarkerSet::new((0..9).map(|m| format!("M{m}"))).unwrap();
        let take = Take::new(names, 100.0, Array3::zeros((10, 9, 3)), mask).unwrap();
        segments(&take, &[1, 2, 3, 4, 5, 6, 7, 8], &(2..8), &(1..9), 6)
    }

    fn frames(segments: &[Segment]) -> Vec<Range<usize>> {
        segments.iter().map(|s| s.frames.clone()).collect()
    }

    #[test]
    fn four_near_neighbours_keep_a_gap_whole() {
        let whole = of(|t, m| m != 2 && m != 3 || t == 5);
        assert_eq!((whole.len(), &whole[0].frames), (1, &(1..9)));
        assert_eq!(whole[0].usable, [1, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn a_change_of_guard_cuts() {
        let cut = of(|t, m| if m <= 4 { t < 5 } else { t >= 5 });
        assert_eq!(frames(&cut), [1..5, 5..9]);
        assert_eq!(
            (&cut[0].usable[..], &cut[1].usable[..]),
            (&[1, 2, 3, 4][..], &[5, 6, 7, 8][..])
        );
    }

    #[test]
    fn a_border_without_the_neighbours_stands_alone() {
        let alone = of(|t, m| (t == 1) == (m > 6));
        assert_eq!(frames(&alone), [1..2, 2..9]);
        assert_eq!(alone[0].usable, [7, 8]);
    }

    #[test]
    fn a_black_out_is_a_segment_without_neighbours() {
        let dark = of(|t, _| t != 4);
        assert_eq!(frames(&dark), [1..4, 4..5, 5..9]);
        assert!(dark[1].usable.is_empty());
    }
}
