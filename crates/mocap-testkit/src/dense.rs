//! A linear dynamical system written out as one joint Gaussian, as slow and as plain as it gets.
//!
//! The oracle for filters and smoothers: it knows nothing of recursions, only of the joint
//! covariance of all states and of conditioning by one dense solve.

use ndarray::{Array1, Array2, ArrayView1, ArrayView2, Axis, s};

/// A linear dynamical system as plain arrays: `H` hidden and `m` observed dimensions.
#[derive(Debug, Clone)]
pub struct DenseLds {
    /// `(H, H)`.
    pub transition: Array2<f64>,
    /// `(m, H)`.
    pub emission: Array2<f64>,
    /// `(H, H)`.
    pub state_noise: Array2<f64>,
    /// `(m, m)`.
    pub observation_noise: Array2<f64>,
    /// `(H)`.
    pub initial_mean: Array1<f64>,
    /// `(H, H)`.
    pub initial_covariance: Array2<f64>,
}

/// The posterior of all states and observations given the observed entries.
#[derive(Debug, Clone)]
pub struct DensePosterior {
    /// Means of the states, `(T, H)`.
    pub state_mean: Array2<f64>,
    /// Covariance of all states stacked frame by frame, `(T·H, T·H)`.
    pub state_covariance: Array2<f64>,
    /// Means of the observations, `(T, m)`; the values themselves where observed.
    pub observation_mean: Array2<f64>,
    /// Covariance of states (first `T·H`) and observations (then `T·m`) stacked frame by frame.
    pub joint_covariance: Array2<f64>,
    /// Log-density of the observed entries.
    pub log_likelihood: f64,
}

impl DenseLds {
    /// Mean and covariance of all states (first `T·H`) and observations (then `T·m`).
    #[must_use]
    pub fn joint(&self, frames: usize) -> (Array1<f64>, Array2<f64>) {
        let (m, h) = self.emission.dim();
        let (states, all) = (frames * h, frames * (h + m));
        let mut mean = Array1::zeros(all);
        let mut covariance = Array2::zeros((all, all));
        let mut marginal_mean = self.initial_mean.clone();
        let mut marginal = self.initial_covariance.clone();
        for t in 0..frames {
            mean.slice_mut(s![t * h..(t + 1) * h]).assign(&marginal_mean);
            let mut reach = marginal.clone();
            for u in t..frames {
                let (rows, columns) = (u * h..(u + 1) * h, t * h..(t + 1) * h);
                covariance.slice_mut(s![rows.clone(), columns.clone()]).assign(&reach);
                covariance.slice_mut(s![columns, rows]).assign(&reach.t());
                reach = self.transition.dot(&reach);
            }
            marginal_mean = self.transition.dot(&marginal_mean);
            marginal = self.transition.dot(&marginal).dot(&self.transition.t()) + &self.state_noise;
        }
        let mut wide = Array2::zeros((frames * m, states));
        for t in 0..frames {
            wide.slice_mut(s![t * m..(t + 1) * m, t * h..(t + 1) * h]).assign(&self.emission);
        }
        let seen_mean = wide.dot(&mean.slice(s![..states]));
        let cross = wide.dot(&covariance.slice(s![..states, ..states]));
        let mut seen = cross.dot(&wide.t());
        for t in 0..frames {
            let mut block = seen.slice_mut(s![t * m..(t + 1) * m, t * m..(t + 1) * m]);
            block += &self.observation_noise;
        }
        mean.slice_mut(s![states..]).assign(&seen_mean);
        covariance.slice_mut(s![states.., ..states]).assign(&cross);
        covariance.slice_mut(s![..states, states..]).assign(&cross.t());
        covariance.slice_mut(s![states.., states..]).assign(&seen);
        (mean, covariance)
    }

    /// Conditions the joint Gaussian on the entries of `values`, `(T, m)`, whose mask is `true`.
    #[must_use]
    pub fn posterior(
        &self,
        values: ArrayView2<'_, f64>,
        mask: ArrayView2<'_, bool>,
    ) -> DensePosterior {
        let (frames, m) = values.dim();
        let h = self.transition.nrows();
        let states = frames * h;
        let (mean, covariance) = self.joint(frames);
        let observed: Vec<usize> =
            mask.iter().enumerate().filter_map(|(i, &seen)| seen.then_some(states + i)).collect();
        let data: Array1<f64> =
            values.iter().zip(mask).filter_map(|(&x, &seen)| seen.then_some(x)).collect();
        let prior = mean.select(Axis(0), &observed);
        let cross = covariance.select(Axis(1), &observed);
        let seen = cross.select(Axis(0), &observed);
        let error = &data - &prior;
        let factor = cholesky(seen.view());
        let white = solve_lower(factor.view(), error.view());
        let half = solve_lower_columns(factor.view(), cross.t());
        let mean = mean + half.t().dot(&white);
        let joint_covariance = &covariance - &half.t().dot(&half);
        let log_determinant: f64 = factor.diag().iter().map(|x| 2.0 * x.ln()).sum();
        let constant = data.len() as f64 * std::f64::consts::TAU.ln();
        let reshape = |part: ArrayView1<'_, f64>, columns: usize| {
            Array2::from_shape_fn((frames, columns), |(t, j)| part[t * columns + j])
        };
        DensePosterior {
            state_mean: reshape(mean.slice(s![..states]), h),
            state_covariance: joint_covariance.slice(s![..states, ..states]).to_owned(),
            observation_mean: reshape(mean.slice(s![states..]), m),
            joint_covariance,
            log_likelihood: -0.5 * (white.dot(&white) + log_determinant + constant),
        }
    }
}

impl DensePosterior {
    /// Covariance of the states of two frames, `(H, H)`.
    #[must_use]
    pub fn state_block(&self, row_frame: usize, column_frame: usize) -> Array2<f64> {
        let h = self.state_mean.ncols();
        let at = |t: usize| t * h..(t + 1) * h;
        self.state_covariance.slice(s![at(row_frame), at(column_frame)]).to_owned()
    }
}

/// Lower Cholesky factor; NaN where the matrix is not positive definite.
fn cholesky(matrix: ArrayView2<'_, f64>) -> Array2<f64> {
    let n = matrix.nrows();
    let mut lower = Array2::<f64>::zeros((n, n));
    for i in 0..n {
        for j in 0..=i {
            let done = lower.slice(s![i, ..j]).dot(&lower.slice(s![j, ..j]));
            let rest = matrix[(i, j)] - done;
            lower[(i, j)] = if i == j { rest.sqrt() } else { rest / lower[(j, j)] };
        }
    }
    lower
}

fn solve_lower(lower: ArrayView2<'_, f64>, right: ArrayView1<'_, f64>) -> Array1<f64> {
    solve_lower_columns(lower, right.insert_axis(Axis(1))).remove_axis(Axis(1))
}

fn solve_lower_columns(lower: ArrayView2<'_, f64>, right: ArrayView2<'_, f64>) -> Array2<f64> {
    let mut solution = right.to_owned();
    for i in 0..lower.nrows() {
        let done = lower.slice(s![i, ..i]).dot(&solution.slice(s![..i, ..]));
        let row = (&solution.row(i) - &done) / lower[(i, i)];
        solution.row_mut(i).assign(&row);
    }
    solution
}
