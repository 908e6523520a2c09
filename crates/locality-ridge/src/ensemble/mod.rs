//! Many local regressions of one gap, each with the errors that it makes in pseudo-gaps.

mod factor;
mod kernel;
mod process;
mod pseudo_gap;
mod rows;
mod scene;
mod variant;

use std::{collections::BTreeMap, ops::Range, rc::Rc};

use mocap_core::{
    Gap, Take,
    geometry::{add, scale, sub},
};

pub use self::pseudo_gap::{PseudoGap, Sides, pseudo_gaps};
use self::{
    process::Process,
    rows::Rows,
    scene::{Sample, Scene},
    variant::{RESIDUALS, VARIANTS, Variant},
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
/// # Cost
/// Constant in the length of the take but for ranking the neighbours: at most a few hundred frames
/// are learnt from. Linear in the frames of the gap.
pub struct Ensemble<'a> {
    take: &'a Take,
    params: LocalRidgeParams,
    rankings: BTreeMap<usize, Rc<[(usize, f64)]>>,
}

impl<'a> Ensemble<'a> {
    /// An ensemble for the gaps of a take.
    #[must_use]
    pub fn new(take: &'a Take) -> Self {
        let params =
            LocalRidgeParams { regressors: MOST_NEIGHBOURS, ..LocalRidgeParams::default() };
        Self { take, params, rankings: BTreeMap::new() }
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
        part.pseudo_gaps = pseudo_gaps(&chosen.training, frames.len(), sides, margin);
        let rows = Rows::choose(&chosen.training, &frames, &part.pseudo_gaps);
        part.scored = part.pseudo_gaps.iter().map(|gap| rows.frames_in(&gap.frames)).collect();
        let spread = |m: &usize| ranking.iter().find(|(r, _)| r == m).copied();
        let neighbours: Vec<(usize, f64)> = chosen.regressors.iter().filter_map(spread).collect();
        let wanted: Vec<usize> = frames.collect();
        let sample = Sample {
            take: self.take,
            target,
            neighbours: &neighbours,
            reference: rows.len() / 2,
            rows: rows.frames(),
            wanted: &wanted,
        };
        part.candidates = self.candidates(&sample, &rows, &part);
        part
    }

    fn candidates(&self, sample: &Sample<'_>, rows: &Rows, part: &Part) -> Vec<Candidate> {
        let mut candidates = Vec::new();
        for of_view in VARIANTS.chunk_by(|a, b| a.view == b.view) {
            let scene = Scene::new(sample, of_view[0].view);
            for variant in of_view {
                let rate_hz = self.take.rate_hz();
                let Some(process) = Process::fit(&scene, sample.rows, rate_hz, variant.kernel)
                else {
                    continue;
                };
                let trial = Trial { sample, rows, part, scene: &scene, process: &process, rate_hz };
                candidates.extend(trial.candidates(variant));
            }
        }
        candidates.retain(|c: &Candidate| c.positions.iter().flatten().all(|x| x.is_finite()));
        candidates
    }
}

/// One variant, fitted.
struct Trial<'a> {
    sample: &'a Sample<'a>,
    rows: &'a Rows,
    part: &'a Part,
    scene: &'a Scene,
    process: &'a Process<'a>,
    rate_hz: f64,
}

/// A run of predicted frames with the errors at its borders.
struct Bridge {
    frames: Range<usize>,
    left: Option<[f64; 3]>,
    right: Option<[f64; 3]>,
}

impl Bridge {
    /// The border errors carried to frame `t`.
    fn at(&self, t: usize, residual: Residual, rate_hz: f64) -> [f64; 3] {
        let before = self.left.map(|_| t + 1 - self.frames.start);
        let after = self.right.map(|_| self.frames.end - t);
        let Weights { left, right } = weights(residual, rate_hz, before, after);
        let part = |weight: Option<(f64, usize)>, error: Option<[f64; 3]>| {
            scale(weight.map_or(0.0, |w| w.0), error.unwrap_or_default())
        };
        add(part(left, self.left), part(right, self.right))
    }
}

impl Trial<'_> {
    fn candidates(&self, variant: &Variant) -> Vec<Candidate> {
        let predicted = self.process.predict(self.sample.wanted);
        let reach = Reach::of(self.scene.target.iter().copied());
        let predicted: Vec<[f64; 3]> = predicted
            .into_iter()
            .map(|p| add(reach.limit(sub(p, self.scene.mean)), self.scene.mean))
            .collect();
        let frames = self.part.frames.clone();
        let known = |t: Option<usize>| {
            t.and_then(|t| self.rows.index(t)).map(|row| self.process.residual(row))
        };
        let Sides { left, right } = self.part.sides;
        let gap = Bridge {
            left: known(frames.start.checked_sub(1).filter(|_| left)),
            right: known(Some(frames.end).filter(|_| right)),
            frames,
        };
        let tried: Vec<Tried> =
            self.part.pseudo_gaps.iter().filter_map(|g| self.leave_out(g)).collect();
        let of_residual = |&residual: &Residual| Candidate {
            name: variant.name,
            positions: self
                .sample
                .wanted
                .iter()
                .zip(&predicted)
                .zip(&self.scene.wanted_frames)
                .map(|((&t, &p), frame)| frame.to_world(add(p, gap.at(t, residual, self.rate_hz))))
                .collect(),
            errors: tried.iter().map(|tried| self.errors(tried, residual)).collect(),
        };
        RESIDUALS.iter().map(of_residual).collect()
    }

    /// The process without a pseudo-gap; without errors where the rest says nothing.
    fn leave_out(&self, gap: &PseudoGap) -> Option<Tried> {
        let hidden = self.rows.range(&gap.hidden);
        let left_out = self.process.leave_out(&hidden)?;
        let bridge = Bridge {
            frames: gap.frames.clone(),
            left: left_out.before.filter(|_| gap.sides.left),
            right: left_out.after.filter(|_| gap.sides.right),
        };
        let scored = self.rows.range(&gap.frames);
        let errors =
            left_out.errors[scored.start - hidden.start..scored.end - hidden.start].to_vec();
        Some(Tried { rows: scored, errors, bridge })
    }

    fn errors(&self, tried: &Tried, residual: Residual) -> Vec<[f64; 3]> {
        let frame = |row: usize| -> LocalFrame { self.scene.row_frames[row] };
        tried
            .rows
            .clone()
            .zip(&tried.errors)
            .map(|(row, &error)| {
                let carried = tried.bridge.at(self.sample.rows[row], residual, self.rate_hz);
                frame(row).turn_out(sub(error, carried))
            })
            .collect()
    }
}

/// One pseudo-gap, filled by one variant: local errors of its rows before borders are carried.
struct Tried {
    rows: Range<usize>,
    errors: Vec<[f64; 3]>,
    bridge: Bridge,
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // fractions of a second
fn frames_of(seconds: f64, rate_hz: f64) -> usize {
    (seconds * rate_hz).round() as usize
}
