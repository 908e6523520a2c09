//! Many local regressions of one gap, each with the errors that it makes in pseudo-gaps.

mod factor;
mod features;
mod frames;
mod kernel;
mod process;
mod pseudo_gap;
mod rows;
mod scene;
mod session;
mod tile;
mod variant;

use std::{collections::BTreeMap, ops::Range, rc::Rc};

use mocap_core::{
    Gap, Take,
    geometry::{add, scale, sub},
};

use self::pseudo_gap::COUNT;
use self::{
    frames::Frames,
    process::{LeftOut, Process},
    rows::Rows,
    scene::{Sample, Scene},
    variant::{RESIDUALS, VARIANTS},
};
pub use self::{
    pseudo_gap::{PseudoGap, Sides, pseudo_gaps},
    session::Session,
};
use crate::{
    LocalRidgeParams, Residual,
    border::{Weights, weights},
    frame::LocalFrame,
    neighbours::{Neighbours, rank_with_spread},
    reach::Reach,
    segments::segments,
};

/// On a side without a border a pseudo-gap hides so much more, so that nothing near it is learnt from.
const MARGIN_S: f64 = 0.5;

/// Most neighbours that any variant learns from.
const MOST_NEIGHBOURS: usize = 20;

/// Neighbours that decide how a gap is cut: two cores.
const NEAR: usize = 12;

/// What users see of a regression that learns from other takes as well.
const OF_SESSION: &str = "session";

/// One way of filling a run of frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Short name of the way.
    pub name: &'static str,
    /// Positions in metres, one a frame.
    pub positions: Vec<[f64; 3]>,
    /// Its errors in pseudo-gaps, in metres in world coordinates: observed minus filled, for the
    /// frames of [`Part::scored`].
    pub errors: Vec<Vec<[f64; 3]>>,
}

/// A run of frames of a gap that the same neighbours are seen in.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its frames.
    pub frames: Range<usize>,
    /// Which sides of it meet an observed sample of the marker.
    pub sides: Sides,
    /// Ways of filling it; none where no neighbour is seen, or too few frames to learn from.
    pub candidates: Vec<Candidate>,
    /// Where the candidates were tried.
    pub pseudo_gaps: Vec<PseudoGap>,
    /// Frames of each pseudo-gap that errors are known in.
    pub scored: Vec<Vec<usize>>,
    /// Neighbours that were learnt from, steadiest first.
    pub neighbours: Vec<usize>,
}

/// Learns a marker from its neighbours in several ways at once.
///
/// Each way is a Gaussian process over pose and time ([RW06] ch. 2) in the local frame of the steadiest
/// neighbours; ridge regression is the special case without curvature and drift. They differ in the
/// neighbours, in how much these count, in the covariance, and in how border errors are carried across
/// the gap. Each is tried on eight pseudo-gaps like the gap, whose frames are left out in closed form,
/// at no further fit.
///
/// With other takes of the session each way is tried twice: alone with the take, and with frames of the others as
/// well. Both are candidates, as a marker may have been moved between takes.
///
/// # Cost
/// Constant in the length of the take but for ranking the neighbours: at most a few hundred frames
/// are learnt from. Linear in the frames of the gap.
pub struct Ensemble<'a> {
    take: &'a Take,
    session: Option<&'a Session>,
    params: LocalRidgeParams,
    rankings: BTreeMap<usize, Rc<[(usize, f64)]>>,
}

impl<'a> Ensemble<'a> {
    /// An ensemble for the gaps of a take.
    #[must_use]
    pub fn new(take: &'a Take) -> Self {
        let params =
            LocalRidgeParams { regressors: MOST_NEIGHBOURS, ..LocalRidgeParams::default() };
        Self { take, session: None, params, rankings: BTreeMap::new() }
    }

    /// An ensemble that learns from the session of its take, too.
    #[must_use]
    pub fn with_session(self, session: Option<&'a Session>) -> Self {
        Self { session, ..self }
    }

    /// The gap cut into parts in frame order, each with its candidates.
    pub fn parts(&mut self, gap: &Gap) -> Vec<Part> {
        let ranking = self.ranking(gap.marker);
        let order: Vec<usize> = ranking.iter().map(|&(m, _)| m).collect();
        let span = gap.frames.start.saturating_sub(1)..(gap.frames.end + 1).min(self.take.frames());
        segments(self.take, &order, &gap.frames, &span, NEAR)
            .into_iter()
            .filter_map(|segment| {
                let inside = segment.frames.start.max(gap.frames.start)
                    ..segment.frames.end.min(gap.frames.end);
                let sides = Sides {
                    left: segment.frames.start < gap.frames.start,
                    right: segment.frames.end > gap.frames.end,
                };
                (!inside.is_empty())
                    .then(|| self.part(gap.marker, inside, sides, &ranking, &segment.usable))
            })
            .collect()
    }

    fn ranking(&mut self, marker: usize) -> Rc<[(usize, f64)]> {
        let rank = || rank_with_spread(self.take, marker, &self.params).into();
        Rc::clone(self.rankings.entry(marker).or_insert_with(rank))
    }

    fn part(
        &self,
        target: usize,
        frames: Range<usize>,
        sides: Sides,
        ranking: &[(usize, f64)],
        usable: &[usize],
    ) -> Part {
        let chosen = Neighbours::choose(self.take, target, usable, &self.params);
        let enough = chosen.training.len() >= self.params.min_training;
        let mut part = Part {
            frames: frames.clone(),
            sides,
            candidates: Vec::new(),
            pseudo_gaps: Vec::new(),
            scored: Vec::new(),
            neighbours: chosen.regressors.clone(),
        };
        if chosen.regressors.is_empty() || !enough {
            return part;
        }
        let margin = frames_of(MARGIN_S, self.take.rate_hz());
        part.pseudo_gaps = pseudo_gaps(&chosen.training, frames.len(), sides, margin, COUNT);
        let rows = Rows::choose(&chosen.training, &frames, &part.pseudo_gaps);
        part.scored = part.pseudo_gaps.iter().map(|gap| rows.frames_in(&gap.frames)).collect();
        let spread = |m: &usize| ranking.iter().find(|(r, _)| r == m).copied();
        let neighbours: Vec<(usize, f64)> = chosen.regressors.iter().filter_map(spread).collect();
        let wanted: Vec<usize> = frames.collect();
        let sample = Sample {
            take: self.take,
            session: None,
            target,
            neighbours: &neighbours,
            reference: rows.middle(),
            rows: rows.frames(),
            wanted: &wanted,
        };
        part.candidates = self.candidates(&sample, &rows, &part);
        part.candidates.extend(self.of_session(&sample, &rows, &part));
        part
    }

    /// The candidates that learn from the session; none where it does not show the marker and its neighbours together
    /// for long enough.
    fn of_session(&self, alone: &Sample<'_>, rows: &Rows, part: &Part) -> Vec<Candidate> {
        let Some(session) = self.session else { return Vec::new() };
        let markers: Vec<usize> =
            alone.neighbours.iter().map(|&(m, _)| m).chain([alone.target]).collect();
        let others = session.frames_with(&markers);
        if others.len() < self.params.min_training {
            return Vec::new();
        }
        let rows = rows.with(&others);
        let sample = Sample {
            take: session.joined(),
            session: Some(session),
            reference: rows.middle(),
            rows: rows.frames(),
            ..*alone
        };
        let of_session = |candidate| Candidate { name: OF_SESSION, ..candidate };
        self.candidates(&sample, &rows, part).into_iter().map(of_session).collect()
    }

    fn candidates(&self, sample: &Sample<'_>, rows: &Rows, part: &Part) -> Vec<Candidate> {
        let rate_hz = self.take.rate_hz();
        let carried = RESIDUALS.map(|residual| Carried::of(residual, part, rows, rate_hz));
        let mut candidates = Vec::new();
        for carried_alike in VARIANTS.chunk_by(|a, b| a.view.carrier == b.view.carrier) {
            let frames = Rc::new(Frames::new(sample, carried_alike[0].view.carrier));
            for of_view in carried_alike.chunk_by(|a, b| a.view == b.view) {
                let scene = Scene::new(sample, Rc::clone(&frames), of_view[0].view);
                for variant in of_view {
                    let fitted = Process::fit(&scene, rows.apart(), rate_hz, variant.kernel);
                    let Some(process) = fitted else { continue };
                    let trial = Trial { rows, part, frames: &frames, process: &process };
                    candidates.extend(trial.candidates(variant.name, &carried));
                }
            }
        }
        candidates.retain(|c: &Candidate| c.positions.iter().flatten().all(|x| x.is_finite()));
        candidates
    }
}

/// By how much border errors count in the frames between: the one before and the one after.
struct Carried {
    gap: Vec<[f64; 2]>,
    /// For the scored frames of each pseudo-gap.
    tried: Vec<Vec<[f64; 2]>>,
}

impl Carried {
    fn of(residual: Residual, part: &Part, rows: &Rows, rate_hz: f64) -> Self {
        let at = |t: usize, frames: &Range<usize>, sides: Sides| {
            let before = sides.left.then(|| t + 1 - frames.start);
            let after = sides.right.then(|| frames.end - t);
            let Weights { left, right } = weights(residual, rate_hz, before, after);
            [left, right].map(|weight| weight.map_or(0.0, |w| w.0))
        };
        let [before, after] = borders(rows, &part.frames, part.sides);
        let sides = Sides { left: before.is_some(), right: after.is_some() };
        let tried = part.pseudo_gaps.iter().zip(&part.scored);
        Self {
            gap: part.frames.clone().map(|t| at(t, &part.frames, sides)).collect(),
            tried: tried
                .map(|(gap, scored)| {
                    scored.iter().map(|&t| at(t, &gap.frames, gap.sides)).collect()
                })
                .collect(),
        }
    }
}

/// The rows of the observed samples beside a run of frames.
fn borders(rows: &Rows, frames: &Range<usize>, sides: Sides) -> [Option<usize>; 2] {
    let before = frames.start.checked_sub(1).filter(|_| sides.left);
    let after = Some(frames.end).filter(|_| sides.right);
    [before, after].map(|t| t.and_then(|t| rows.index(t)))
}

/// One variant, fitted.
struct Trial<'a> {
    rows: &'a Rows,
    part: &'a Part,
    frames: &'a Frames,
    process: &'a Process<'a>,
}

impl Trial<'_> {
    fn candidates(&self, name: &'static str, carried: &[Carried]) -> Vec<Candidate> {
        let (part, mean) = (self.part, self.frames.mean);
        let reach = Reach::of(self.frames.target.iter().copied());
        let predicted: Vec<[f64; 3]> = self
            .process
            .predict()
            .into_iter()
            .map(|p| add(reach.limit(sub(p, mean)), mean))
            .collect();
        let residual = |row: Option<usize>| row.map(|row| self.process.residual(row));
        let borders = borders(self.rows, &part.frames, part.sides).map(residual);
        let tried: Vec<LeftOut> =
            part.pseudo_gaps.iter().filter_map(|gap| self.leave_out(gap)).collect();
        if tried.len() < part.pseudo_gaps.len() {
            return Vec::new();
        }
        let place = |((&p, frame), weights): ((&[f64; 3], &LocalFrame), &[f64; 2])| {
            frame.to_world(add(p, carry(*weights, borders)))
        };
        let candidate = |carried: &Carried| Candidate {
            name,
            positions: predicted
                .iter()
                .zip(&self.frames.wanted)
                .zip(&carried.gap)
                .map(place)
                .collect(),
            errors: (0..tried.len()).map(|g| self.errors(g, &tried[g], carried)).collect(),
        };
        carried.iter().map(candidate).collect()
    }

    /// The process without a pseudo-gap; `None` where the rest says nothing.
    fn leave_out(&self, gap: &PseudoGap) -> Option<LeftOut> {
        let [before, after] = borders(self.rows, &gap.frames, gap.sides);
        self.process.leave_out(&self.rows.range(&gap.hidden), before, after)
    }

    /// Errors in the scored frames of pseudo-gap `g`.
    fn errors(&self, g: usize, left_out: &LeftOut, carried: &Carried) -> Vec<[f64; 3]> {
        let gap = &self.part.pseudo_gaps[g];
        let (scored, hidden) = (self.rows.range(&gap.frames), self.rows.range(&gap.hidden));
        let errors = &left_out.errors[scored.start - hidden.start..scored.end - hidden.start];
        let borders = [left_out.before, left_out.after];
        scored
            .zip(errors)
            .zip(&carried.tried[g])
            .map(|((row, &error), weights)| {
                self.frames.rows[row].turn_out(sub(error, carry(*weights, borders)))
            })
            .collect()
    }
}

/// The border errors carried to a frame.
fn carry(weights: [f64; 2], borders: [Option<[f64; 3]>; 2]) -> [f64; 3] {
    let [before, after] = borders.map(Option::unwrap_or_default);
    add(scale(weights[0], before), scale(weights[1], after))
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // fractions of a second
fn frames_of(seconds: f64, rate_hz: f64) -> usize {
    (seconds * rate_hz).round() as usize
}
