//! Random models, data and masks.

use lds_kalman::{Covariance, LdsModel, LdsParts, Observations};
use mocap_testkit::dense::DenseLds;
use ndarray::{Array1, Array2};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::{Distribution, StandardNormal, Uniform};

pub struct Random(pub ChaCha8Rng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    pub fn uniform(&mut self) -> f64 {
        Uniform::new(0.0, 1.0).unwrap().sample(&mut self.0)
    }

    pub fn size(&mut self, from: usize, to: usize) -> usize {
        Uniform::new_inclusive(from, to).unwrap().sample(&mut self.0)
    }

    pub fn matrix(&mut self, rows: usize, columns: usize) -> Array2<f64> {
        Array2::from_shape_simple_fn((rows, columns), || self.normal())
    }

    pub fn vector(&mut self, n: usize) -> Array1<f64> {
        Array1::from_shape_simple_fn(n, || self.normal())
    }

    /// A positive definite matrix with condition number of about a hundred.
    pub fn definite(&mut self, n: usize) -> Array2<f64> {
        let a = self.matrix(n, n);
        a.dot(&a.t()) / n as f64 + Array2::<f64>::eye(n) * 0.1
    }

    pub fn covariance(&mut self, n: usize, full: bool) -> Covariance {
        match self.size(0, if full { 2 } else { 1 }) {
            0 => Covariance::Isotropic(0.1 + self.uniform()),
            1 => Covariance::Diagonal(Array1::from_shape_simple_fn(n, || 0.1 + self.uniform())),
            _ => Covariance::Full(self.definite(n)),
        }
    }

    /// A model whose states neither explode nor vanish at once.
    pub fn model(&mut self, hidden: usize, dimensions: usize) -> LdsModel {
        LdsModel::new(LdsParts {
            transition: self.matrix(hidden, hidden) * (0.6 / (hidden as f64).sqrt())
                + Array2::<f64>::eye(hidden) * 0.4,
            emission: self.matrix(dimensions, hidden),
            state_noise: self.covariance(hidden, true),
            observation_noise: self.covariance(dimensions, false),
            initial_mean: self.vector(hidden),
            initial_covariance: self.covariance(hidden, true),
        })
        .unwrap()
    }

    /// A mask with single holes, holes of several frames and whole frames missing.
    pub fn mask(&mut self, frames: usize, dimensions: usize) -> Array2<bool> {
        let mut mask = Array2::from_elem((frames, dimensions), true);
        let share = self.uniform() * 0.5;
        mask.iter_mut().for_each(|seen| *seen = self.uniform() >= share);
        let (from, to) = (self.size(0, frames - 1), self.size(0, frames - 1));
        let dimension = self.size(0, dimensions - 1);
        (from.min(to)..=from.max(to)).for_each(|t| mask[(t, dimension)] = false);
        let empty = self.size(0, frames - 1);
        mask.row_mut(empty).fill(false);
        mask
    }
}

/// A random model with a draw from it of which part is missing (NaN there).
pub fn problem(
    seed: u64,
    frames: usize,
    dimensions: usize,
    hidden: usize,
) -> (LdsModel, Observations) {
    let mut random = Random::new(seed);
    let model = random.model(hidden, dimensions);
    let mut values = model.sample(frames, seed).unwrap().observations;
    let mask = random.mask(frames, dimensions);
    values.zip_mut_with(&mask, |x, &seen| {
        if !seen {
            *x = f64::NAN;
        }
    });
    let observations = Observations::new(values.view(), mask.view()).unwrap();
    (model, observations)
}

pub fn dense(model: &LdsModel) -> DenseLds {
    let (hidden, dimensions) = (model.hidden(), model.dimensions());
    DenseLds {
        transition: model.transition().to_owned(),
        emission: model.emission().to_owned(),
        state_noise: model.state_noise().to_matrix(hidden),
        observation_noise: model.observation_noise().to_matrix(dimensions),
        initial_mean: model.initial_mean().to_owned(),
        initial_covariance: model.initial_covariance().to_matrix(hidden),
    }
}

/// Largest difference relative to the largest entry of the second.
pub fn apart<'a>(
    a: impl IntoIterator<Item = &'a f64>,
    b: impl IntoIterator<Item = &'a f64>,
) -> f64 {
    let (size, change) = a.into_iter().zip(b).fold((0.0_f64, 0.0_f64), |(size, change), (x, y)| {
        (size.max(y.abs()), change.max((x - y).abs()))
    });
    change / size
}
