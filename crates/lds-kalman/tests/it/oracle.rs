//! Filter, smoother and M-step against the dense joint Gaussian.

use lds_kalman::{
    Covariance, CovarianceStructure, LdsModel, NoiseStructure, Observations, e_step, filter,
    m_step, smooth,
};
use mocap_testkit::dense::DensePosterior;
use ndarray::{Array1, Array2, s};

use crate::support::{Random, apart, dense, problem};

/// 1e-9: the promised agreement; both sides lose a few digits to conditioning.
const TOLERANCE: f64 = 1e-9;

fn cases() -> impl Iterator<Item = (LdsModel, Observations)> {
    (0..24).map(|seed| {
        let mut random = Random::new(1000 + seed);
        let (dimensions, frames) = (random.size(1, 12), random.size(1, 40));
        let hidden = random.size(1, 5);
        problem(seed, frames, dimensions, hidden)
    })
}

#[test]
fn the_smoother_equals_a_dense_solve_with_masks() {
    for (case, (model, observations)) in cases().enumerate() {
        let truth = dense(&model).posterior(observations.values(), observations.mask());
        let found = smooth(&model, &observations).unwrap();
        assert!(apart(&found.mean, &truth.state_mean) < TOLERANCE, "case {case}");
        for t in 0..observations.frames() {
            let covariance = found.covariance.slice(s![t, .., ..]);
            assert!(apart(covariance, &truth.state_block(t, t)) < TOLERANCE, "case {case}");
        }
        for t in 1..observations.frames() {
            let lag = found.lag_one.slice(s![t - 1, .., ..]);
            let block = truth.state_block(t, t - 1);
            // Lag-one blocks may be nearly zero; their scale is that of the covariances.
            let scale = truth.state_block(t, t).iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            let worst = (&lag - &block).iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            assert!(worst < TOLERANCE * scale, "case {case}, frame {t}");
        }
        let difference = (found.log_likelihood - truth.log_likelihood).abs();
        assert!(difference < TOLERANCE * (1.0 + truth.log_likelihood.abs()), "case {case}");
    }
}

#[test]
fn the_filter_equals_a_dense_solve_of_the_frames_so_far() {
    for (case, (model, observations)) in cases().take(8).enumerate() {
        let found = filter(&model, &observations).unwrap();
        let frames = observations.frames();
        for t in (0..frames).step_by(3).chain([frames - 1]) {
            let mut mask = observations.mask().to_owned();
            mask.slice_mut(s![t + 1.., ..]).fill(false);
            let truth = dense(&model).posterior(observations.values(), mask.view());
            let mean = found.mean.row(t);
            assert!(apart(mean, truth.state_mean.row(t)) < TOLERANCE, "case {case}, frame {t}");
            let covariance = found.covariance.slice(s![t, .., ..]);
            assert!(apart(covariance, &truth.state_block(t, t)) < TOLERANCE, "case {case}");
            if t + 1 < frames {
                let ahead = found.predicted_mean.row(t + 1);
                assert!(apart(ahead, truth.state_mean.row(t + 1)) < TOLERANCE, "case {case}");
                let spread = found.predicted_covariance.slice(s![t + 1, .., ..]);
                assert!(apart(spread, &truth.state_block(t + 1, t + 1)) < TOLERANCE);
            }
            if t + 1 == frames {
                let difference = (found.log_likelihood - truth.log_likelihood).abs();
                assert!(difference < TOLERANCE * (1.0 + truth.log_likelihood.abs()));
            }
        }
    }
}

/// The expected complete log-likelihood from the dense posterior, term by term.
fn expected_log_likelihood(posterior: &DensePosterior, model: &LdsModel) -> f64 {
    let (frames, h) = posterior.state_mean.dim();
    let m = posterior.observation_mean.ncols();
    let mut mean: Vec<f64> = posterior.state_mean.iter().copied().collect();
    mean.extend(posterior.observation_mean.iter());
    let mean = Array1::from(mean);
    let quantity = dense(model);
    // Each term is the Gaussian density of `A y − b` for a slice `A` of the joint vector `y`.
    let term = |a: &Array2<f64>, b: &Array1<f64>, noise: &Array2<f64>| {
        let error = a.dot(&mean) - b;
        let second = a.dot(&posterior.joint_covariance).dot(&a.t())
            + error
                .view()
                .insert_axis(ndarray::Axis(1))
                .dot(&error.view().insert_axis(ndarray::Axis(0)));
        let (inverse, log_determinant) = invert(noise);
        -0.5 * ((&inverse * &second.t()).sum()
            + log_determinant
            + noise.nrows() as f64 * std::f64::consts::TAU.ln())
    };
    let pick = |rows: usize, blocks: &[(usize, &Array2<f64>)]| {
        let mut a = Array2::zeros((rows, frames * (h + m)));
        for (at, block) in blocks {
            a.slice_mut(s![.., *at..*at + block.ncols()]).assign(block);
        }
        a
    };
    let (identity, observed) = (Array2::<f64>::eye(h), Array2::<f64>::eye(m));
    let (forward, emission) = (-&quantity.transition, -&quantity.emission);
    let mut sum =
        term(&pick(h, &[(0, &identity)]), &quantity.initial_mean, &quantity.initial_covariance);
    for t in 0..frames {
        if t > 0 {
            let a = pick(h, &[((t - 1) * h, &forward), (t * h, &identity)]);
            sum += term(&a, &Array1::zeros(h), &quantity.state_noise);
        }
        let a = pick(m, &[(t * h, &emission), (frames * h + t * m, &observed)]);
        sum += term(&a, &Array1::zeros(m), &quantity.observation_noise);
    }
    sum
}

/// Inverse and log-determinant by Gauss–Jordan elimination without pivoting.
fn invert(matrix: &Array2<f64>) -> (Array2<f64>, f64) {
    let n = matrix.nrows();
    let (mut left, mut right) = (matrix.clone(), Array2::<f64>::eye(n));
    let mut log_determinant = 0.0;
    for i in 0..n {
        let pivot = left[(i, i)];
        log_determinant += pivot.ln();
        left.row_mut(i).mapv_inplace(|x| x / pivot);
        right.row_mut(i).mapv_inplace(|x| x / pivot);
        for k in (0..n).filter(|&k| k != i) {
            let factor = left[(k, i)];
            let (l, r) = (left.row(i).to_owned(), right.row(i).to_owned());
            left.row_mut(k).scaled_add(-factor, &l);
            right.row_mut(k).scaled_add(-factor, &r);
        }
    }
    (right, log_determinant)
}

fn parts(model: &LdsModel) -> lds_kalman::LdsParts {
    lds_kalman::LdsParts {
        transition: model.transition().to_owned(),
        emission: model.emission().to_owned(),
        state_noise: model.state_noise().clone(),
        observation_noise: model.observation_noise().clone(),
        initial_mean: model.initial_mean().to_owned(),
        initial_covariance: model.initial_covariance().clone(),
    }
}

/// Every direction in which the parameters of the model may be moved.
fn moved(model: &LdsModel, step: f64) -> Vec<LdsModel> {
    let mut all = Vec::new();
    let mut add = |change: &dyn Fn(&mut lds_kalman::LdsParts)| {
        let mut moved = parts(model);
        change(&mut moved);
        all.push(LdsModel::new(moved).unwrap());
    };
    let (h, m) = (model.hidden(), model.dimensions());
    for i in 0..h {
        add(&|p| p.initial_mean[i] += step);
        (0..h).for_each(|j| add(&|p| p.transition[(i, j)] += step));
        (0..m).for_each(|j| add(&|p| p.emission[(j, i)] += step));
    }
    let shift = |covariance: &mut Covariance, at: (usize, usize)| match covariance {
        Covariance::Isotropic(v) => *v += step,
        Covariance::Diagonal(v) => v[at.0] += step,
        Covariance::Full(v) => {
            v[at] += step;
            v[(at.1, at.0)] = v[at];
        }
    };
    for i in 0..h {
        for j in 0..=i {
            add(&|p| shift(&mut p.state_noise, (i, j)));
            add(&|p| shift(&mut p.initial_covariance, (i, j)));
        }
    }
    (0..m).for_each(|j| add(&|p| shift(&mut p.observation_noise, (j, j))));
    all
}

#[test]
fn the_m_step_is_where_the_gradient_of_the_expected_likelihood_vanishes() {
    use CovarianceStructure::{Diagonal, Full, Isotropic};
    for (seed, state, observation) in
        [(1, Isotropic, Isotropic), (2, Diagonal, Diagonal), (3, Full, Diagonal)]
    {
        let (model, observations) = problem(seed, 7, 4, 2);
        let structure =
            NoiseStructure { state, observation, initial: state, variance_floor: 1e-10 };
        let posterior = dense(&model).posterior(observations.values(), observations.mask());
        let best = m_step(&e_step(&model, &observations).unwrap(), &structure).unwrap();
        let step = 1e-5;
        let up = moved(&best, step);
        let down = moved(&best, -step);
        let at_best = expected_log_likelihood(&posterior, &best);
        let at_old = expected_log_likelihood(&posterior, &model);
        assert!(at_best > at_old, "{at_best} is not above {at_old}");
        for (i, (u, d)) in up.iter().zip(&down).enumerate() {
            let (u, d) =
                (expected_log_likelihood(&posterior, u), expected_log_likelihood(&posterior, d));
            let gradient = (u - d) / (2.0 * step);
            let curvature = (u + d - 2.0 * at_best) / (step * step);
            // Central differences err by the third derivative times step², and by rounding of
            // the value over the step; both are far below the curvature of every direction.
            assert!(curvature < 0.0, "seed {seed}, direction {i}: curvature {curvature}");
            assert!(
                gradient.abs() < 1e-5 * curvature.abs().max(1.0),
                "seed {seed}, direction {i}: gradient {gradient}, curvature {curvature}"
            );
        }
    }
}
