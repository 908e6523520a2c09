//! Methods of other crates, tried on the same kind of pseudo-gaps.

use std::collections::BTreeMap;

use locality_ridge::ensemble::{self, Candidate, PseudoGap, Sides};
use mocap_core::{
    CellState, Filled, Gap, Mask, Take,
    geometry::{add, distance, scale, sub},
};

use super::{
    growth,
    mixture::{Mixture, Stock, Tried},
    pace,
    rival::Rival,
    stack,
};

/// Pseudo-gaps of each run of frames, at most.
const MOST: usize = 16;

/// In one pass they hide one in so many frames of the take, but for the first of them: a method must not be judged by
/// what it makes of a take with little left.
const HIDDEN: usize = 6;

/// Each method fills the take so many times, each time with other pseudo-gaps.
const PASSES: usize = 2;

/// Where fewer fit into a pass than this ...
const FEW: usize = 4;

/// ... there are so many passes.
const MANY_PASSES: usize = 4;

/// Frames between two pseudo-gaps beyond half their length: what a spline with seeds asks for.
const SEEDS: usize = 5;

/// The candidates of another fill are of one kind; before errors are known they count as much as so many rivals.
const KIN: f64 = 3.0;

/// How many times as far from its mean place as it was seen a marker may be.
const REACH: f64 = 3.0;

/// What the rivals make of a gap.
pub(super) struct Answer {
    pub gap: Gap,
    pub mixture: Mixture,
    /// Whether the candidates of another fill are in it.
    pub of_stock: bool,
}

/// Markers that are missing in the same frames.
struct Group {
    gaps: Vec<Gap>,
    /// Markers that are missing in any of their frames.
    missing: Vec<usize>,
    /// Pseudo-gaps with the pass in which they are hidden.
    pseudo_gaps: Vec<(usize, PseudoGap)>,
    /// Frames of each that errors are known in.
    scored: Vec<Vec<usize>>,
    /// Candidates of another fill of each gap, with errors in these pseudo-gaps.
    stocks: Option<Vec<Vec<Candidate>>>,
}

/// What the rivals make of each gap that they have an answer for. `stock` gives the candidates of another fill.
///
/// Each rival fills the take in passes, each with many pseudo-gaps hidden together, so that their number costs
/// nothing. `costly` asks those that take long, too.
pub(super) fn compete<'a>(
    take: &Take,
    gaps: &[Gap],
    stock: &dyn Fn(&Gap) -> Option<&'a Stock>,
    rivals: &[Rival],
    costly: bool,
) -> Vec<Answer> {
    let mut alike: BTreeMap<(usize, usize), Vec<Gap>> = BTreeMap::new();
    for gap in gaps {
        alike.entry((gap.frames.start, gap.frames.end)).or_default().push(gap.clone());
    }
    let groups: Vec<Group> =
        alike.into_values().map(|gaps| Group::new(take, gaps, stock)).collect();
    let sighted = groups.iter().any(|group| !group.is_dark(take));
    let worth_it = |rival: &&Rival| (costly || !rival.costly) && (sighted || !rival.body);
    let asked: Vec<&Rival> = rivals.iter().filter(worth_it).collect();
    let mut fills: Vec<Vec<Option<Filled>>> = vec![Vec::new(); asked.len()];
    for pass in 0..groups.iter().map(Group::passes).max().unwrap_or(1) {
        let hidden = hidden(take, &groups, pass);
        let visible = take.hide(&hidden).ok().filter(|_| pass == 0 || hidden.count() > 0);
        for (fills, rival) in fills.iter_mut().zip(&asked) {
            fills.push(visible.as_ref().and_then(|visible| rival.filler.fill(visible).ok()));
        }
    }
    groups
        .iter()
        .flat_map(|group| {
            let candidates = |gap: &Gap| {
                let of = |(rival, fills): (&&Rival, &Vec<Option<Filled>>)| {
                    group
                        .admits(take, rival)
                        .then(|| group.candidate(take, rival, fills, gap))
                        .flatten()
                };
                asked.iter().zip(&fills).filter_map(of).collect::<Vec<Candidate>>()
            };
            let rivals: Vec<Vec<Candidate>> = group.gaps.iter().map(candidates).collect();
            group.mix(take, rivals, &asked)
        })
        .collect()
}

/// Everything that pseudo-gaps hide in a pass.
fn hidden(take: &Take, groups: &[Group], pass: usize) -> Mask {
    let mut hidden = Mask::none(take.frames(), take.marker_count());
    for group in groups {
        let frames = &group.gaps[0].frames;
        for (_, gap) in group.pseudo_gaps.iter().filter(|(at, _)| *at == pass) {
            for t in gap.hidden.start..gap.hidden.end.min(take.frames()) {
                // Markers come and go as they do in the gap, in a shorter pseudo-gap all the faster.
                let into = t.saturating_sub(gap.frames.start) * frames.len() / gap.frames.len();
                let like = (frames.start + into).min(frames.end - 1);
                for &m in group.missing.iter().filter(|&&m| !take.is_observed(like, m)) {
                    let _ = hidden.insert(t, m);
                }
            }
        }
    }
    hidden
}

impl Group {
    /// At least one gap, with pseudo-gaps in which all markers that are missing in them are seen: those that other
    /// fills were tried on, where all were tried on the same.
    fn new<'a>(take: &Take, gaps: Vec<Gap>, stock: &dyn Fn(&Gap) -> Option<&'a Stock>) -> Self {
        let frames = &gaps[0].frames;
        let is_missing = |m: &usize| frames.clone().any(|t| !take.is_observed(t, *m));
        let missing: Vec<usize> = (0..take.marker_count()).filter(is_missing).collect();
        let mut group =
            Self { gaps, missing, pseudo_gaps: Vec::new(), scored: Vec::new(), stocks: None };
        let missing = group.missing.clone();
        // What a pseudo-gap hides beyond the take is not there.
        let all_seen =
            |t: usize| t >= take.frames() || missing.iter().all(|&m| take.is_observed(t, m));
        let length = group.gaps[0].len();
        let most = (take.frames() / (HIDDEN * length)).clamp(1, MOST);
        let turns = if most < FEW { MANY_PASSES } else { PASSES };
        let stocks: Option<Vec<&Stock>> = group.gaps.iter().map(stock).collect();
        if let Some(stocks) = stocks.filter(|stocks| tried_alike(stocks)) {
            let whole = |gap: &PseudoGap| gap.hidden.clone().all(all_seen);
            let passes = passes(&stocks[0].pseudo_gaps, most, turns, &whole);
            let kept = |of: &[Vec<[f64; 3]>]| passes.iter().map(|(k, _)| of[*k].clone()).collect();
            if passes.len() > 1 {
                let restrict = |c: &Candidate| Candidate { errors: kept(&c.errors), ..c.clone() };
                let of = |stock: &&Stock| stock.candidates.iter().map(restrict).collect();
                group.stocks = Some(stocks.iter().map(of).collect());
                group.scored = passes.iter().map(|(k, _)| stocks[0].scored[*k].clone()).collect();
                group.pseudo_gaps =
                    passes.iter().map(|&(k, p)| (p, stocks[0].pseudo_gaps[k].clone())).collect();
                return group;
            }
        }
        let seen: Vec<usize> = (0..take.frames()).filter(|&t| all_seen(t)).collect();
        let cut = ensemble::pseudo_gaps(&seen, length, group.sides(take), 0, turns * most);
        let passes = passes(&cut, most, turns, &|_| true);
        group.scored = passes.iter().map(|&(k, _)| cut[k].frames.clone().collect()).collect();
        group.pseudo_gaps = passes.iter().map(|&(k, p)| (p, cut[k].clone())).collect();
        group
    }

    /// Fills that its pseudo-gaps need; one for the gap itself.
    fn passes(&self) -> usize {
        self.pseudo_gaps.iter().map(|(pass, _)| pass + 1).max().unwrap_or(1)
    }

    fn sides(&self, take: &Take) -> Sides {
        let frames = &self.gaps[0].frames;
        Sides { left: frames.start > 0, right: frames.end < take.frames() }
    }

    /// Whether a rival can know anything of the gaps.
    fn admits(&self, take: &Take, rival: &Rival) -> bool {
        !(rival.body && self.is_dark(take))
    }

    /// Whether no marker is seen in all of its frames.
    fn is_dark(&self, take: &Take) -> bool {
        self.missing.len() == take.marker_count()
    }

    /// What a rival made of a gap and its pseudo-gaps, by pass; `None` where it left some of them open, or went where
    /// the marker cannot be.
    fn candidate(
        &self,
        take: &Take,
        rival: &Rival,
        fills: &[Option<Filled>],
        gap: &Gap,
    ) -> Option<Candidate> {
        let found = |pass: usize, t: usize| {
            let filled = fills[pass].as_ref()?;
            let position = filled.take().position(t, gap.marker);
            position.filter(|_| filled.state(t, gap.marker) == CellState::Filled)
        };
        let error =
            |pass: usize, t: usize| Some(sub(take.position(t, gap.marker)?, found(pass, t)?));
        let errors = |((pass, _), frames): (&(usize, PseudoGap), &Vec<usize>)| {
            frames.iter().map(|&t| error(*pass, t)).collect::<Option<Vec<_>>>()
        };
        let positions = gap.frames.clone().map(|t| found(0, t)).collect::<Option<Vec<_>>>()?;
        within_reach(take, gap.marker, &positions).then_some(())?;
        let errors =
            self.pseudo_gaps.iter().zip(&self.scored).map(errors).collect::<Option<_>>()?;
        let mut candidate = Candidate { name: rival.name, positions, errors };
        let tried = self.pseudo_gaps.iter().map(|(_, gap)| gap);
        growth::extrapolate(&mut candidate, tried, gap.len(), rival.growth);
        Some(candidate)
    }

    /// Mixtures of the rivals, and of the candidates of other fills.
    fn mix(&self, take: &Take, rivals: Vec<Vec<Candidate>>, asked: &[&Rival]) -> Vec<Answer> {
        let seconds = self.gaps[0].len() as f64 / take.rate_hz();
        let mut candidates = rivals;
        let credit_of = |candidate: &Candidate| {
            let rival = asked.iter().find(|rival| rival.name == candidate.name);
            rival.map_or(1.0, |rival| rival.credit(seconds))
        };
        let mut credit: Vec<f64> =
            candidates.first().into_iter().flatten().map(credit_of).collect();
        if let Some(stocks) = &self.stocks {
            for (candidates, stock) in candidates.iter_mut().zip(stocks) {
                candidates.extend(stock.iter().cloned());
            }
            let more = stocks.first().map_or(0, Vec::len);
            credit.extend(vec![KIN / more as f64; more]);
        }
        let names = |of: &Vec<Candidate>| of.iter().map(|c| c.name).collect::<Vec<_>>();
        let alike = candidates.windows(2).all(|two| names(&two[0]) == names(&two[1]));
        let pseudo_gaps: Vec<PseudoGap> =
            self.pseudo_gaps.iter().map(|(_, gap)| gap.clone()).collect();
        let runs: Vec<_> = pseudo_gaps.iter().map(|gap| gap.frames.clone()).collect();
        let likeness = |gap: &Gap| pace::likeness(take, gap.marker, &gap.frames, &runs);
        let likeness: Vec<Vec<f64>> = self.gaps.iter().map(likeness).collect();
        let weights = if alike {
            stack::weights_together(&candidates, &likeness, &credit)
        } else {
            let alone = |(of, likeness): (&Vec<Candidate>, &Vec<f64>)| {
                let (of, likeness) = (std::slice::from_ref(of), std::slice::from_ref(likeness));
                stack::weights_together(of, likeness, &vec![1.0; of[0].len()]).remove(0)
            };
            candidates.iter().zip(&likeness).map(alone).collect()
        };
        let (sides, rate_hz) = (self.sides(take), take.rate_hz());
        let answer = |(k, weights): (usize, Vec<f64>)| {
            let (gap, of) = (&self.gaps[k], &candidates[k]);
            let tried =
                Tried { pseudo_gaps: &pseudo_gaps, scored: &self.scored, likeness: &likeness[k] };
            (!of.is_empty()).then(|| {
                let worth = of.iter().zip(&weights).map(|(of, w)| w * credit_of(of)).sum();
                let mixture = Mixture::weighted(of, weights, tried, &gap.frames, sides, rate_hz);
                Answer {
                    gap: gap.clone(),
                    mixture: Mixture { credit: worth, ..mixture },
                    of_stock: self.stocks.is_some(),
                }
            })
        };
        weights.into_iter().enumerate().filter_map(answer).collect()
    }
}

/// Whether a marker stays where it can be: within thrice the distance from its mean place that it was seen at, and a
/// metre. Curves and models of motion may leave for kilometres where they were given little.
fn within_reach(take: &Take, marker: usize, positions: &[[f64; 3]]) -> bool {
    let seen: Vec<[f64; 3]> = (0..take.frames()).filter_map(|t| take.position(t, marker)).collect();
    let share = 1.0 / seen.len().max(1) as f64;
    let centre = seen.iter().fold([0.0; 3], |sum, &p| add(sum, scale(share, p)));
    let farthest = seen.iter().map(|&p| distance(p, centre)).fold(0.0, f64::max);
    positions.iter().all(|&p| distance(p, centre) <= REACH * farthest + 1.0)
}

/// Whether all were tried on the same frames.
fn tried_alike(stocks: &[&Stock]) -> bool {
    let same = |a: &Stock, b: &Stock| a.pseudo_gaps == b.pseudo_gaps && a.scored == b.scored;
    stocks.windows(2).all(|two| same(two[0], two[1]))
}

/// Pseudo-gaps by number with the pass in which they are hidden: in each, at most so many of those that are `whole`,
/// spread over the take, with half their length between them.
fn passes(
    all: &[PseudoGap],
    most: usize,
    turns: usize,
    whole: &dyn Fn(&PseudoGap) -> bool,
) -> Vec<(usize, usize)> {
    let mut left: Vec<usize> = (0..all.len()).filter(|&k| whole(&all[k])).collect();
    let mut passes = Vec::new();
    for pass in 0..turns {
        let mut kept: Vec<usize> = Vec::new();
        for &k in &left {
            let free = |&last: &usize| {
                let between = all[last].frames.len() / 2 + SEEDS;
                all[k].hidden.start >= all[last].hidden.end + between
            };
            if kept.last().is_none_or(free) {
                kept.push(k);
            }
        }
        let step = kept.len().div_ceil(most).max(1);
        let kept: Vec<usize> = kept.into_iter().step_by(step).collect();
        left.retain(|k| !kept.contains(k));
        passes.extend(kept.into_iter().map(|k| (k, pass)));
    }
    passes
}
