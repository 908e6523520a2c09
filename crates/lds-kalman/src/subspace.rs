//! A first model from the directions in which the visible data vary.

use ndarray::{Array1, Array2, Axis, s};
use ndarray_linalg::{Eigh, UPLO};

use crate::{
    covariance::{Covariance, CovarianceStructure},
    error::LdsError,
    model::{LdsModel, LdsParts},
    observations::Observations,
    statistics::{NoiseStructure, solve_symmetric},
};

/// The model of [`Start::Subspace`](crate::Start::Subspace).
pub(crate) fn subspace(
    observations: &Observations,
    hidden: usize,
    structure: &NoiseStructure,
) -> Result<LdsModel, LdsError> {
    model(observations, hidden, structure).ok_or(LdsError::Breakdown { iteration: 1 })
}

fn model(
    observations: &Observations,
    hidden: usize,
    structure: &NoiseStructure,
) -> Option<LdsModel> {
    let floor = structure.variance_floor;
    let dark = observations.fewest_observed() < hidden;
    let velocities = if dark { hidden / 2 } else { 0 };
    let places = hidden - velocities;
    let basis = Basis::new(observations, places, floor)?;
    let track = basis.track(observations, floor)?;
    let Regression { emission: directions, noise } = regress(observations, &track, &basis, floor)?;
    let mut emission = Array2::zeros((observations.dimensions(), hidden));
    emission.slice_mut(s![.., ..places]).assign(&directions);
    let track = track.with_velocities(velocities);
    let (earlier, later) = track.moves();
    let transition = if dark { steady(places, velocities) } else { step(&earlier, &later, floor)? };
    let error = &later - &earlier.dot(&transition.t());
    let count = later.nrows().max(1) as f64;
    let state_noise = Covariance::fit(structure.state, &(error.t().dot(&error) / count), floor)?;
    let observation_noise = match structure.observation {
        CovarianceStructure::Isotropic => Covariance::Isotropic(noise),
        _ => Covariance::Diagonal(Array1::from_elem(observations.dimensions(), noise)),
    };
    // One mean step of uncertainty about where the take begins.
    let variance = (&later - &earlier).mapv(|x| x * x).sum() / (count * hidden as f64);
    let first = track.told.iter().position(|&told| told).unwrap_or(0);
    LdsModel::new(LdsParts {
        transition,
        emission,
        state_noise,
        observation_noise,
        initial_mean: track.states.row(first).to_owned(),
        initial_covariance: Covariance::Isotropic(variance.max(floor)),
    })
    .ok()
}

/// Leading directions of the dimensions that miss least.
struct Basis {
    /// The dimensions, in order.
    dimensions: Vec<usize>,
    /// `(dimensions, n)`, orthonormal; zero columns where there are not so many directions.
    directions: Array2<f64>,
    /// Variance of the data along each, `(n)`.
    variances: Vec<f64>,
    /// Variance across all.
    noise: f64,
}

impl Basis {
    fn new(observations: &Observations, n: usize, floor: f64) -> Option<Self> {
        let dimensions = fullest(observations, 2 * n);
        let values = observations.values().select(Axis(1), &dimensions);
        let seen = observations.mask().select(Axis(1), &dimensions);
        let seen = seen.mapv(|seen| f64::from(u8::from(seen)));
        // Each pair over the frames that show both; missing values are zero.
        let mut moment = values.t().dot(&values);
        let together = seen.t().dot(&seen);
        moment.zip_mut_with(&together, |s, count| *s /= count.max(1.0));
        let (eigenvalues, vectors) = moment.eigh(UPLO::Upper).ok()?;
        let size = dimensions.len();
        let mut directions = Array2::zeros((size, n));
        let mut variances = vec![floor; n];
        // Eigenvalues ascend. Those of pairs seldom seen together may be negative: they are nothing.
        for (k, i) in (0..size).rev().take(n.min(observations.frames())).enumerate() {
            directions.column_mut(k).assign(&vectors.column(i));
            variances[k] = eigenvalues[i].max(floor);
        }
        let rest = eigenvalues.iter().take(size.saturating_sub(n)).map(|v| v.max(0.0)).sum::<f64>();
        let noise = (rest / size.saturating_sub(n).max(1) as f64).max(floor);
        Some(Self { dimensions, directions, variances, noise })
    }

    /// The states of the frames that show enough of the basis.
    fn track(&self, observations: &Observations, floor: f64) -> Option<Track> {
        let n = self.directions.ncols();
        let frames = observations.frames();
        let mut track = Track { states: Array2::zeros((frames, n)), told: vec![false; frames] };
        let mut gains = Vec::new();
        for pattern in observations.patterns() {
            let here = |j: &usize| pattern.observed.binary_search(j).is_ok();
            let shown: Vec<usize> =
                (0..self.dimensions.len()).filter(|&k| here(&self.dimensions[k])).collect();
            gains.push(if shown.len() >= n { Some(self.gain(shown, floor)?) } else { None });
        }
        for (t, &pattern) in observations.pattern_of().iter().enumerate() {
            let Some((columns, gain)) = &gains[pattern] else { continue };
            let values = observations.values().row(t).select(Axis(0), columns);
            track.states.row_mut(t).assign(&values.dot(gain));
            track.told[t] = true;
        }
        Some(track)
    }

    /// Columns of the observations and what their values count for in the states, `(columns, n)`:
    /// the posterior mean of probabilistic principal components.
    fn gain(&self, shown: Vec<usize>, floor: f64) -> Option<(Vec<usize>, Array2<f64>)> {
        let columns = shown.iter().map(|&k| self.dimensions[k]).collect();
        let rows = self.directions.select(Axis(0), &shown);
        if shown.len() == self.dimensions.len() {
            return Some((columns, rows));
        }
        let mut information = rows.t().dot(&rows);
        let noise = self.noise.max(floor);
        let prior = information.diag_mut().into_iter().zip(&self.variances);
        prior.for_each(|(x, variance)| *x += noise / variance);
        Some((columns, solve_symmetric(&information, &rows)?))
    }
}

/// At least `wanted` dimensions with the fewest missing entries, and all that miss as few.
fn fullest(observations: &Observations, wanted: usize) -> Vec<usize> {
    let columns = observations.mask();
    let missing: Vec<usize> = columns
        .columns()
        .into_iter()
        .map(|column| column.iter().filter(|&&seen| !seen).count())
        .collect();
    let mut sorted = missing.clone();
    sorted.sort_unstable();
    let most = sorted[wanted.clamp(1, sorted.len()) - 1];
    (0..missing.len()).filter(|&j| missing[j] <= most).collect()
}

/// States and the frames in which they are known.
struct Track {
    /// `(T, n)`.
    states: Array2<f64>,
    told: Vec<bool>,
}

impl Track {
    /// The same with the moves from the frame before of the first `count` states appended.
    fn with_velocities(self, count: usize) -> Self {
        if count == 0 {
            return self;
        }
        let (frames, n) = self.states.dim();
        let mut states = Array2::zeros((frames, n + count));
        states.slice_mut(s![.., ..n]).assign(&self.states);
        let moves = &self.states.slice(s![1.., ..count]) - &self.states.slice(s![..-1, ..count]);
        states.slice_mut(s![1.., n..]).assign(&moves);
        let told = (0..frames).map(|t| t > 0 && self.told[t] && self.told[t - 1]).collect();
        Self { states, told }
    }

    /// States before and after each move between known frames.
    fn moves(&self) -> (Array2<f64>, Array2<f64>) {
        let later: Vec<usize> =
            (1..self.told.len()).filter(|&t| self.told[t] && self.told[t - 1]).collect();
        let earlier: Vec<usize> = later.iter().map(|t| t - 1).collect();
        (self.states.select(Axis(0), &earlier), self.states.select(Axis(0), &later))
    }
}

struct Regression {
    /// `(m, n)`.
    emission: Array2<f64>,
    noise: f64,
}

/// Each dimension on the states, over the frames that show it.
fn regress(
    observations: &Observations,
    track: &Track,
    basis: &Basis,
    floor: f64,
) -> Option<Regression> {
    let (values, mask) = (observations.values(), observations.mask());
    let mut emission = Array2::zeros((observations.dimensions(), track.states.ncols()));
    let (mut squares, mut count) = (0.0, 0);
    for dimensions in observations.columns_by_mask() {
        let shown = |t: &usize| track.told[*t] && mask[(*t, dimensions[0])];
        let frames: Vec<usize> = (0..observations.frames()).filter(shown).collect();
        let states = track.states.select(Axis(0), &frames);
        let values = values.select(Axis(0), &frames).select(Axis(1), &dimensions);
        let mut moment = states.t().dot(&states);
        let prior = moment.diag_mut().into_iter().zip(&basis.variances);
        prior.for_each(|(x, variance)| *x += basis.noise / variance);
        let rows = solve_symmetric(&moment, &values.t().dot(&states))?;
        let error = &values - &states.dot(&rows.t());
        squares += error.mapv(|e| e * e).sum();
        count += error.len();
        for (&j, row) in dimensions.iter().zip(rows.rows()) {
            emission.row_mut(j).assign(&row);
        }
    }
    Some(Regression { emission, noise: (squares / count.max(1) as f64).max(floor) })
}

/// The least-squares transition between consecutive states.
fn step(earlier: &Array2<f64>, later: &Array2<f64>, floor: f64) -> Option<Array2<f64>> {
    let mut moment = earlier.t().dot(earlier);
    let scale = moment.diag().iter().fold(floor, |a, x| a.max(*x));
    // The ridge is what rounding does to the moment anyway; it decides only empty directions.
    moment.diag_mut().mapv_inplace(|x| x + 1e-12 * scale);
    solve_symmetric(&moment, &later.t().dot(earlier))
}

/// The transition that adds to the first states their velocities, which come last.
fn steady(places: usize, velocities: usize) -> Array2<f64> {
    let mut transition = Array2::eye(places + velocities);
    (0..velocities).for_each(|k| transition[(k, places + k)] = 1.0);
    transition
}
