//! Expectation maximisation: monotone, deterministic, and faithful to what was observed.

use std::ops::ControlFlow;

use lds_kalman::{
    CovarianceStructure, EStep, EmParams, Fit, LdsError, MissingEntries, MissingUpdate,
    NoiseStructure, Observations, Prediction, Start, Termination, UpdateContext, fit_em,
};
use ndarray::Array2;

use crate::support::{Random, problem};

fn fit(observations: &Observations, params: &EmParams) -> Result<Fit, LdsError> {
    fit_em(observations, params, &mut Prediction, &mut |_| ControlFlow::Continue(()))
}

fn wave(frames: usize, dimensions: usize) -> Array2<f64> {
    Array2::from_shape_fn((frames, dimensions), |(t, j)| {
        let (t, j) = (t as f64, j as f64);
        (0.13 * t + 0.7 * j).sin() + 0.5 * (0.05 * t * (1.0 + j / 9.0)).cos()
    })
}

/// Random systems may be unstable in a direction that is hardly observed; then the filter runs out of
/// digits, and the fit has to say so and keep the model before. Nearly all must run to their end.
#[test]
fn exact_em_never_lowers_the_likelihood() {
    let forms =
        [CovarianceStructure::Isotropic, CovarianceStructure::Diagonal, CovarianceStructure::Full];
    for seed in 0..200_u64 {
        let mut random = Random::new(seed);
        let (dimensions, frames) = (random.size(2, 8), random.size(5, 30));
        let hidden = random.size(1, dimensions.min(4));
        let (_, observations) = problem(seed, frames, dimensions, hidden);
        let state = forms[random.size(0, 2)];
        let observation = forms[random.size(0, 1)];
        let start = [Start::Random, Start::Subspace][random.size(0, 1)];
        let structure = NoiseStructure { state, observation, initial: state, variance_floor: 1e-4 };
        let params = EmParams {
            hidden,
            iterations: 25,
            tolerance: 0.0,
            seed,
            start,
            structure,
            ..EmParams::default()
        };
        let fit = fit(&observations, &params).unwrap();
        for pair in fit.log_likelihoods.windows(2) {
            // A millionth of a likelihood of some hundred is far above the rounding of a sound pass.
            assert!(pair[1] >= pair[0] - 1e-6 * (1.0 + pair[0].abs()), "seed {seed}: {pair:?}");
        }
        assert!(fit.filled.iter().all(|x| x.is_finite()), "seed {seed}");
        assert_ne!(fit.termination, Termination::Stalled, "seed {seed}");
    }
}

#[test]
fn every_e_step_fills_a_wave_and_leaves_observed_entries_alone() {
    let truth = wave(150, 6);
    let mask = Array2::from_shape_fn((150, 6), |(t, j)| !(j == 2 && (60..90).contains(&t)));
    let observations = Observations::new(truth.view(), mask.view()).unwrap();
    // Fills that count as observed keep what a subspace start makes of the straight line.
    let cases = [
        (EStep::Exact, Start::Random),
        (EStep::Exact, Start::Subspace),
        (EStep::Dynammo, Start::Random),
        (EStep::Dynammo, Start::Subspace),
        (EStep::FilledAsObserved, Start::Random),
    ];
    for (e_step, start) in cases {
        let params = EmParams { hidden: 5, iterations: 300, e_step, start, ..EmParams::default() };
        let fit = fit(&observations, &params).unwrap();
        let mut worst = 0.0_f64;
        for ((at, &x), &seen) in fit.filled.indexed_iter().zip(&mask) {
            if seen {
                assert_eq!(x.to_bits(), truth[at].to_bits());
            } else {
                worst = worst.max((x - truth[at]).abs());
            }
        }
        // A straight line is off by 1.3 here; the wave is nearly a linear system.
        assert!(worst < 0.1, "{e_step:?} from {start:?}: {worst}");
        assert_eq!(fit.deviation.is_some(), e_step == EStep::Exact);
    }
}

#[test]
fn the_deviation_is_zero_where_observed_and_covers_the_error_elsewhere() {
    let (model, observations) = problem(77, 60, 5, 2);
    let truth = model.sample(60, 77).unwrap().observations;
    let params = EmParams { hidden: 2, iterations: 60, ..EmParams::default() };
    let fit = fit(&observations, &params).unwrap();
    let deviation = fit.deviation.unwrap();
    let (mut square, mut count) = (0.0, 0.0);
    for ((at, &seen), &d) in observations.mask().indexed_iter().zip(&deviation) {
        assert_eq!(seen, d == 0.0);
        if !seen {
            square += ((fit.filled[at] - truth[at]) / d).powi(2);
            count += 1.0;
        }
    }
    // Standardised errors have mean square one; a learnt model is a little too sure of itself.
    let mean = square / count;
    assert!((0.5..2.0).contains(&mean), "mean square {mean} over {count} entries");
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_does_not() {
    let observations = problem(5, 40, 6, 3).1;
    let params = |seed| EmParams {
        hidden: 3,
        iterations: 10,
        seed,
        start: Start::Random,
        ..EmParams::default()
    };
    let first = fit(&observations, &params(1)).unwrap();
    assert_eq!(first, fit(&observations, &params(1)).unwrap());
    assert_ne!(first.filled, fit(&observations, &params(2)).unwrap().filled);
}

#[test]
fn the_observer_stops_the_fit_and_the_trace_says_how_far_it_came() {
    let observations = problem(6, 40, 6, 3).1;
    let params = EmParams { hidden: 3, iterations: 50, tolerance: 0.0, ..EmParams::default() };
    let mut seen = Vec::new();
    let fit = fit_em(&observations, &params, &mut Prediction, &mut |progress| {
        seen.push(progress.log_likelihood);
        if progress.iteration == 7 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
    .unwrap();
    assert_eq!(fit.termination, Termination::Stopped);
    assert_eq!((fit.iterations(), &seen), (7, &fit.log_likelihoods));
}

#[test]
fn a_loose_tolerance_converges_and_a_strict_one_meets_the_limit() {
    let observations = problem(8, 40, 6, 3).1;
    let ended = |tolerance, iterations| {
        let params = EmParams { hidden: 3, iterations, tolerance, ..EmParams::default() };
        fit(&observations, &params).unwrap().termination
    };
    assert_eq!(ended(1e-2, 500), Termination::Converged);
    assert_eq!(ended(0.0, 5), Termination::IterationLimit);
}

struct Vandal;

impl MissingUpdate for Vandal {
    fn update(&mut self, context: &UpdateContext<'_>, missing: &mut MissingEntries<'_>) {
        assert_eq!(context.prediction.dim(), context.mask.dim());
        missing.fill_from(Array2::from_elem(context.mask.dim(), 7.0).view());
        for t in 0..context.mask.nrows() {
            missing.set(t, 0, -1.0);
        }
    }
}

#[test]
fn a_hook_decides_missing_entries_and_cannot_touch_observed_ones() {
    let truth = wave(30, 4);
    let mask = Array2::from_shape_fn((30, 4), |(t, j)| !(j == 1 && t > 20));
    let observations = Observations::new(truth.view(), mask.view()).unwrap();
    let params = EmParams { hidden: 2, iterations: 3, ..EmParams::default() };
    let fit =
        fit_em(&observations, &params, &mut Vandal, &mut |_| ControlFlow::Continue(())).unwrap();
    for ((at, &x), &seen) in fit.filled.indexed_iter().zip(&mask) {
        assert_eq!(x, if seen { truth[at] } else { 7.0 });
    }
}

#[test]
fn constant_data_and_blackouts_end_without_panic() {
    let flat = Array2::from_elem((20, 3), 1.5);
    let observations = Observations::from_finite(flat.view()).unwrap();
    for start in [Start::Random, Start::Subspace] {
        let params = EmParams { hidden: 3, start, ..EmParams::default() };
        let fit = fit(&observations, &params).unwrap();
        assert!(fit.states.iter().all(|x| x.is_finite()));
    }
    let truth = wave(80, 4);
    let mask = Array2::from_shape_fn((80, 4), |(t, _)| !(30..40).contains(&t));
    let observations = Observations::new(truth.view(), mask.view()).unwrap();
    let params = EmParams { hidden: 4, ..EmParams::default() };
    assert!(fit(&observations, &params).unwrap().filled.iter().all(|x| x.is_finite()));
}
