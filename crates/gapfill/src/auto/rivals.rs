//! Methods of other crates, tried on the same kind of pseudo-gaps.

use std::collections::BTreeMap;

use locality_ridge::ensemble::{self, Candidate, PseudoGap, Sides};
use mocap_core::{CellState, Filled, Gap, GapContext, GapFiller, Mask, Take, geometry::sub};

use super::mixture::{Mixture, Tried};

/// Pseudo-gaps of each run of frames; more would hide too much of the take at once.
const MOST: usize = 4;

/// A method that fills whole takes.
pub(super) struct Rival {
    pub name: &'static str,
    pub filler: Box<dyn GapFiller>,
    /// It learns a model of the whole take, in about a second.
    pub costly: bool,
}

/// Frames of one or more markers that rivals are asked for.
struct Open {
    pseudo_gaps: Vec<PseudoGap>,
    scored: Vec<Vec<usize>>,
}

/// What the rivals make of each gap, in the order of `gaps`; `None` where none of them has an answer.
/// `tried` gives the pseudo-gaps of another fill of the gap, to be compared with.
///
/// Each rival fills the take once, with all pseudo-gaps hidden together, so that their number costs
/// nothing. `costly` asks those that take long, too.
pub(super) fn compete(
    take: &Take,
    gaps: &[Gap],
    tried: &dyn Fn(&Gap) -> Vec<PseudoGap>,
    rivals: &[Rival],
    costly: bool,
) -> Vec<Option<Mixture>> {
    let open = group(take, gaps, tried);
    let mut hidden = Mask::none(take.frames(), take.marker_count());
    for (frames, open) in &open {
        for marker in missing_in(take, frames) {
            for t in open.pseudo_gaps.iter().flat_map(|gap| gap.hidden.clone()) {
                let _ = hidden.insert(t.min(take.frames() - 1), marker);
            }
        }
    }
    let Ok(visible) = take.hide(&hidden) else { return vec![None; gaps.len()] };
    let fills: Vec<(&'static str, Filled)> = rivals
        .iter()
        .filter(|rival| costly || !rival.costly)
        .filter_map(|rival| Some((rival.name, rival.filler.fill(&visible).ok()?)))
        .collect();
    let of_gap = |gap: &Gap| {
        let open = open.get(&(gap.frames.start, gap.frames.end))?;
        let candidates: Vec<Candidate> = fills
            .iter()
            .filter_map(|(name, filled)| candidate(take, name, filled, gap, open))
            .collect();
        let sides = sides(take, gap);
        let tried = Tried { pseudo_gaps: &open.pseudo_gaps, scored: &open.scored };
        (!candidates.is_empty())
            .then(|| Mixture::of(&candidates, tried, &gap.frames, sides, take.rate_hz()))
    };
    gaps.iter().map(of_gap).collect()
}

type Groups = BTreeMap<(usize, usize), Open>;

/// Gaps by their frames, each group with pseudo-gaps in which all its markers, and those that they
/// have to do without, are seen.
///
/// Those that another fill of the gap was tried on come first.
fn group(take: &Take, gaps: &[Gap], tried: &dyn Fn(&Gap) -> Vec<PseudoGap>) -> Groups {
    let mut groups = Groups::new();
    for gap in gaps {
        let key = (gap.frames.start, gap.frames.end);
        groups.entry(key).or_insert_with(|| {
            let missing = missing_in(take, &key);
            let all_seen = |t: &usize| missing.iter().all(|&m| take.is_observed(*t, m));
            let seen: Vec<usize> = (0..take.frames()).filter(all_seen).collect();
            let mut same = tried(gap);
            same.retain(|gap| gap.hidden.clone().all(|t| seen.binary_search(&t).is_ok()));
            let mut pseudo_gaps = apart(same);
            if pseudo_gaps.len() < 2 {
                pseudo_gaps = apart(ensemble::pseudo_gaps(&seen, gap.len(), sides(take, gap), 0));
            }
            let scored = pseudo_gaps.iter().map(|gap| gap.frames.clone().collect()).collect();
            Open { pseudo_gaps, scored }
        });
    }
    groups
}

fn missing_in(take: &Take, &(start, end): &(usize, usize)) -> Vec<usize> {
    let missing = |m: &usize| (start..end).any(|t| !take.is_observed(t, *m));
    (0..take.marker_count()).filter(missing).collect()
}

fn sides(take: &Take, gap: &Gap) -> Sides {
    match gap.context(take.frames()) {
        GapContext::Interior => Sides { left: true, right: true },
        GapContext::Leading => Sides { left: false, right: true },
        GapContext::Trailing => Sides { left: true, right: false },
        GapContext::Whole => Sides { left: false, right: false },
    }
}

/// Pseudo-gaps that leave their own length of frames between them, spread over the take.
fn apart(all: Vec<PseudoGap>) -> Vec<PseudoGap> {
    let mut kept: Vec<PseudoGap> = Vec::new();
    for gap in all {
        let free =
            |last: &PseudoGap| gap.hidden.start >= last.hidden.end + last.frames.len().max(5);
        if kept.last().is_none_or(free) {
            kept.push(gap);
        }
    }
    let step = kept.len().div_ceil(MOST).max(1);
    kept.into_iter().step_by(step).collect()
}

fn candidate(
    take: &Take,
    name: &'static str,
    filled: &Filled,
    gap: &Gap,
    open: &Open,
) -> Option<Candidate> {
    let found = |t: usize| {
        filled
            .take()
            .position(t, gap.marker)
            .filter(|_| filled.state(t, gap.marker) == CellState::Filled)
    };
    let positions = gap.frames.clone().map(found).collect::<Option<Vec<_>>>()?;
    let error = |&t: &usize| Some(sub(take.position(t, gap.marker)?, found(t)?));
    let errors = open
        .scored
        .iter()
        .map(|frames| frames.iter().map(error).collect::<Option<Vec<_>>>())
        .collect::<Option<Vec<_>>>()?;
    Some(Candidate { name, positions, errors })
}
