//! The regression that the two sets of principal directions amount to.

use mocap_core::{FillError, Gap, Refusal, Take, geometry::distance};
use ndarray::{Array1, Array2, Axis, s};

use super::{NAME, PcaParams};
use crate::spectrum::Spectrum;

/// Frames that a marker needs to be learnt from.
const LEAST_FRAMES: usize = 10;

/// The other markers as one marker sees them.
pub(super) struct Columns {
    marker: usize,
    /// Mean distance to each marker in metres; NaN where the two are never seen together.
    distance_m: Vec<f64>,
    /// Markers that are never missing.
    complete: Vec<usize>,
    /// Markers that may be neighbours: all but far ones with gaps.
    near: Vec<usize>,
}

impl Columns {
    pub fn around(take: &Take, marker: usize, params: &PcaParams) -> Self {
        let distance_m: Vec<f64> =
            (0..take.marker_count()).map(|m| mean_distance(take, marker, m)).collect();
        let known = distance_m.iter().filter(|d| d.is_finite());
        // The published program counts the missing marker's distance to itself.
        let mean = known.clone().sum::<f64>() / known.count().max(1) as f64;
        let is_complete = |m: &usize| take.observed().marker(*m).iter().all(|&seen| seen);
        let complete: Vec<usize> = (0..take.marker_count()).filter(is_complete).collect();
        let is_near = |m: &usize| {
            let near = distance_m[*m] <= params.distal * mean || complete.binary_search(m).is_ok();
            *m != marker && distance_m[*m].is_finite() && near
        };
        let near = (0..take.marker_count()).filter(is_near).collect();
        Self { marker, distance_m, complete, near }
    }

    /// The neighbours of a gap and the frames to learn from.
    pub fn choose(&self, take: &Take, gap: &Gap) -> Result<(Vec<usize>, Vec<usize>), Refusal> {
        let through = |m: &usize| gap.frames.clone().all(|t| take.is_observed(t, *m));
        let mut neighbours: Vec<usize> = self.near.iter().copied().filter(through).collect();
        let seen: Vec<usize> =
            (0..take.frames()).filter(|&t| take.is_observed(t, self.marker)).collect();
        if seen.len() < LEAST_FRAMES {
            return Err(Refusal::TooFewSamples { seen: seen.len(), needed: LEAST_FRAMES });
        }
        loop {
            if neighbours.is_empty() {
                return Err(Refusal::NoNeighbour);
            }
            let shows = |t: &usize| neighbours.iter().all(|&m| take.is_observed(*t, m));
            let training: Vec<usize> = seen.iter().copied().filter(shows).collect();
            if training.len() >= LEAST_FRAMES.max(seen.len() / 2) {
                return Ok((neighbours, training));
            }
            let lacks = |m: usize| seen.iter().filter(|&&t| !take.is_observed(t, m)).count();
            let worst = neighbours.iter().copied().max_by_key(|&m| (lacks(m), m));
            neighbours.retain(|&m| Some(m) != worst);
        }
    }

    fn weight(&self, m: usize, params: &PcaParams) -> f64 {
        if m == self.marker {
            return params.missing_weight;
        }
        let ratio = self.distance_m[m] / params.sigma_m;
        (-0.5 * ratio * ratio).exp()
    }
}

fn mean_distance(take: &Take, a: usize, b: usize) -> f64 {
    let both = (0..take.frames())
        .filter_map(|t| Some(distance(take.position(t, a)?, take.position(t, b)?)));
    let (n, sum) = both.fold((0_usize, 0.0), |(n, sum), d| (n + 1, sum + d));
    sum / n as f64
}

/// A marker's position as a linear function of its neighbours' positions.
pub(super) struct Model {
    neighbours: Vec<usize>,
    /// Markers whose mean is the origin.
    origin: Vec<usize>,
    /// Mean coordinates of the neighbours, `(3K,)`, in metres.
    mean: Array1<f64>,
    /// Mean position of the marker.
    own_mean: [f64; 3],
    /// `(3K, 3)`.
    slopes: Array2<f64>,
}

impl Model {
    /// Learns from the frames `training`, which show the marker and all K neighbours.
    ///
    /// Implements [Gloersen16] Eqs. (1)–(5).
    pub fn learn(
        take: &Take,
        columns: &Columns,
        neighbours: Vec<usize>,
        training: &[usize],
        params: &PcaParams,
    ) -> Result<Self, FillError> {
        let origin =
            if columns.complete.is_empty() { &neighbours } else { &columns.complete }.clone();
        // The missing marker comes last.
        let markers: Vec<usize> = neighbours.iter().copied().chain([columns.marker]).collect();
        let mut data = Array2::zeros((training.len(), 3 * markers.len()));
        for (mut row, &t) in data.outer_iter_mut().zip(training) {
            let centre = centre(take, t, &origin).unwrap_or([f64::NAN; 3]);
            for (k, &m) in markers.iter().enumerate() {
                for axis in 0..3 {
                    row[3 * k + axis] = take.positions()[(t, m, axis)] - centre[axis];
                }
            }
        }
        let mean = data.mean_axis(Axis(0)).unwrap_or_default();
        data -= &mean;
        let spread = data.map_axis(Axis(0), |x| (x.dot(&x) / training.len() as f64).sqrt());
        // Weight over spread: what a coordinate is multiplied by.
        let gain = Array1::from_shape_fn(mean.len(), |j| {
            let spread = if spread[j] > 0.0 { spread[j] } else { 1.0 };
            columns.weight(markers[j / 3], params) / spread
        });
        data *= &gain;
        let gram = data.t().dot(&data);

        let known = 3 * neighbours.len();
        let with = Spectrum::of_gram(NAME, &gram)?;
        let without = Spectrum::of_gram(NAME, &gram.slice(s![..known, ..known]).to_owned())?;
        let rank =
            with.rank_of_share(params.cumulative).max(without.rank_of_share(params.cumulative));
        let (with, without) = (with.leading(rank), without.leading(rank));
        let change = without.t().dot(&with.slice(s![..known, ..]));
        let mut slopes = without.dot(&change.dot(&with.slice(s![known.., ..]).t()));
        for ((j, axis), slope) in slopes.indexed_iter_mut() {
            *slope *= gain[j] / gain[known + axis];
        }
        Ok(Self {
            own_mean: std::array::from_fn(|axis| mean[known + axis]),
            mean: mean.slice(s![..known]).to_owned(),
            neighbours,
            origin,
            slopes,
        })
    }

    pub fn neighbours(&self) -> &[usize] {
        &self.neighbours
    }

    /// The marker's position in a frame that shows all neighbours.
    pub fn predict(&self, take: &Take, t: usize) -> Option<[f64; 3]> {
        let centre = centre(take, t, &self.origin)?;
        let mut place: [f64; 3] = std::array::from_fn(|axis| centre[axis] + self.own_mean[axis]);
        for (k, &m) in self.neighbours.iter().enumerate() {
            let p = take.position(t, m)?;
            for (axis, c) in p.into_iter().enumerate() {
                let j = 3 * k + axis;
                let off = c - centre[axis] - self.mean[j];
                for (x, slope) in place.iter_mut().zip(self.slopes.row(j)) {
                    *x += slope * off;
                }
            }
        }
        Some(place)
    }
}

/// The mean of some markers in a frame that shows them all.
fn centre(take: &Take, t: usize, markers: &[usize]) -> Option<[f64; 3]> {
    let mut sum = [0.0; 3];
    for &m in markers {
        let p = take.position(t, m)?;
        sum.iter_mut().zip(p).for_each(|(s, c)| *s += c);
    }
    Some(sum.map(|c| c / markers.len() as f64))
}
