//! One gap: predictions by segment, border errors carried across, segments joined.

use std::{ops::Range, rc::Rc};

use mocap_core::{
    Gap, Refusal, Take,
    geometry::{add, scale, sub},
};

use crate::{
    LocalRidgeParams,
    border::{Weights, weights},
    join::join,
    neighbours::{Neighbours, rank},
    predictor::{Prediction, Predictor},
    segments::segments,
};

/// A step between two segments is spread over this long on either side.
const BLEND_S: f64 = 0.1;

/// Frames without any neighbour are bridged by a straight line if they last no longer.
const BRIDGE_S: f64 = 0.1;

/// The filled frames of a gap.
pub(crate) struct Bridge {
    pub positions: Vec<[f64; 3]>,
    /// NaN where unknown.
    pub sigma_m: Vec<f64>,
}

/// Fills the gaps of one marker.
pub(crate) struct MarkerFiller<'a> {
    take: &'a Take,
    params: &'a LocalRidgeParams,
    marker: usize,
    ranking: Vec<usize>,
    trained: Vec<Rc<Predictor>>,
}

/// A predicted frame.
struct Step {
    predictor: Rc<Predictor>,
    prediction: Prediction,
}

impl<'a> MarkerFiller<'a> {
    pub fn new(take: &'a Take, params: &'a LocalRidgeParams, marker: usize) -> Self {
        let ranking = rank(take, marker, params);
        Self { take, params, marker, ranking, trained: Vec::new() }
    }

    pub fn fill(&mut self, gap: &Gap) -> Result<Bridge, Refusal> {
        let seen = self.take.observed().marker(self.marker).iter().filter(|&&seen| seen).count();
        if seen < self.params.min_training {
            return Err(Refusal::TooFewSamples { seen, needed: self.params.min_training });
        }
        let span = gap.frames.start.saturating_sub(1)..(gap.frames.end + 1).min(self.take.frames());
        let steps = self.predict(&gap.frames, &span);
        let predicts =
            |(t, step): (usize, &Option<Step>)| gap.frames.contains(&t) && step.is_some();
        if !span.clone().zip(&steps).any(predicts) {
            return Err(Refusal::NoNeighbour);
        }
        let mut path = Path::through(self, &span, &steps);
        let runs = runs(&steps, &path.places);
        join(&mut path.places, &runs, BLEND_S * self.take.rate_hz());
        let longest = BRIDGE_S * self.take.rate_hz();
        let known = |t: usize| self.take.position(t, self.marker);
        let bordered: Vec<Option<[f64; 3]>> =
            span.clone().zip(&path.places).map(|(t, place)| known(t).or(*place)).collect();
        let places = bridge_holes(&bordered, longest).ok_or(Refusal::NoNeighbour)?;
        let inside = gap.frames.start - span.start..gap.frames.end - span.start;
        let positions = places[inside.clone()].to_vec();
        if !positions.iter().flatten().all(|c| c.is_finite()) {
            return Err(Refusal::NotFinite);
        }
        Ok(Bridge { positions, sigma_m: path.sigma_m[inside].to_vec() })
    }

    /// Predictions for the frames of `span`, `None` where no neighbour is seen.
    fn predict(&mut self, gap: &Range<usize>, span: &Range<usize>) -> Vec<Option<Step>> {
        let mut steps = Vec::with_capacity(span.len());
        let near = self.params.regressors.max(2 * self.params.core);
        for segment in segments(self.take, &self.ranking, gap, span, near) {
            let predictor = self.predictor(&segment.usable);
            for t in segment.frames {
                steps.push(predictor.as_ref().map(|predictor| Step {
                    predictor: Rc::clone(predictor),
                    prediction: predictor.predict(self.take, t),
                }));
            }
        }
        steps
    }

    /// The predictor for these neighbours, trained once; `None` without any.
    fn predictor(&mut self, usable: &[usize]) -> Option<Rc<Predictor>> {
        let neighbours = Neighbours::choose(self.take, self.marker, usable, self.params);
        if neighbours.regressors.is_empty() {
            return None;
        }
        if let Some(known) = self.trained.iter().find(|p| *p.neighbours() == neighbours) {
            return Some(Rc::clone(known));
        }
        let new = Rc::new(Predictor::train(self.take, self.marker, neighbours, self.params));
        self.trained.push(Rc::clone(&new));
        Some(new)
    }
}

/// Predicted positions over a gap and its borders, in world coordinates.
struct Path {
    places: Vec<Option<[f64; 3]>>,
    sigma_m: Vec<f64>,
}

impl Path {
    /// Predictions plus the border errors, each carried in the local frame.
    fn through(filler: &MarkerFiller<'_>, span: &Range<usize>, steps: &[Option<Step>]) -> Self {
        let (take, last) = (filler.take, span.len() - 1);
        let error = |i: usize| {
            let seen = take.position(span.start + i, filler.marker)?;
            let Step { prediction, .. } = steps[i].as_ref()?;
            Some(sub(prediction.frame.to_local(seen), prediction.place))
        };
        let left = carry(steps, 0..span.len(), error(0));
        let right = carry(steps, (0..span.len()).rev(), error(last));
        let mut path = Self { places: vec![None; span.len()], sigma_m: vec![f64::NAN; span.len()] };
        for (i, step) in steps.iter().enumerate() {
            let Some(Step { predictor, prediction }) = step else {
                path.places[i] = take.position(span.start + i, filler.marker);
                continue;
            };
            let (before, after) = (left[i].map(|_| i), right[i].map(|_| last - i));
            let carried = weights(filler.params.residual, take.rate_hz(), before, after);
            let place = add(prediction.place, weigh(&carried, left[i], right[i]));
            path.places[i] = Some(prediction.frame.to_world(place));
            path.sigma_m[i] = predictor.spread().sigma_m(&carried);
        }
        path
    }
}

/// A border error frame by frame, turned with the local frames of the segments it passes.
fn carry(
    steps: &[Option<Step>],
    order: impl Iterator<Item = usize>,
    error: Option<[f64; 3]>,
) -> Vec<Option<[f64; 3]>> {
    let mut carried = vec![None; steps.len()];
    let Some(mut error) = error else { return carried };
    let mut last: Option<&Step> = None;
    for i in order {
        let Some(step) = &steps[i] else { continue };
        if let Some(last) = last.filter(|last| !Rc::ptr_eq(&last.predictor, &step.predictor)) {
            error = step.prediction.frame.turn_in(last.prediction.frame.turn_out(error));
        }
        carried[i] = Some(error);
        last = Some(step);
    }
    carried
}

fn weigh(weights: &Weights, left: Option<[f64; 3]>, right: Option<[f64; 3]>) -> [f64; 3] {
    let part = |weight: Option<(f64, usize)>, error: Option<[f64; 3]>| {
        scale(weight.map_or(0.0, |w| w.0), error.unwrap_or_default())
    };
    add(part(weights.left, left), part(weights.right, right))
}

/// Runs of frames with one predictor; a border without any is a run of its own.
fn runs(steps: &[Option<Step>], places: &[Option<[f64; 3]>]) -> Vec<Range<usize>> {
    let sources: Vec<Option<Option<*const Predictor>>> = steps
        .iter()
        .zip(places)
        .map(|(step, place)| place.map(|_| step.as_ref().map(|step| Rc::as_ptr(&step.predictor))))
        .collect();
    let mut runs = Vec::new();
    let mut start = 0;
    for run in sources.chunk_by(|a, b| a == b) {
        if run[0].is_some() {
            runs.push(start..start + run.len());
        }
        start += run.len();
    }
    runs
}

/// Straight lines over holes of at most `longest` frames; `None` if a hole is longer or has one end.
fn bridge_holes(places: &[Option<[f64; 3]>], longest: f64) -> Option<Vec<[f64; 3]>> {
    let known: Vec<usize> = (0..places.len()).filter(|&i| places[i].is_some()).collect();
    let mut whole = Vec::with_capacity(places.len());
    for (i, place) in places.iter().enumerate() {
        if let Some(place) = place {
            whole.push(*place);
            continue;
        }
        let after = known.partition_point(|&k| k < i);
        let (s, e) = (known[after.checked_sub(1)?], *known.get(after)?);
        if (e - s - 1) as f64 > longest {
            return None;
        }
        let (p, q) = (places[s]?, places[e]?);
        whole.push(add(p, scale((i - s) as f64 / (e - s) as f64, sub(q, p))));
    }
    Some(whole)
}
