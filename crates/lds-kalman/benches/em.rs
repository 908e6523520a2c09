//! Time of one EM iteration with one marker missing in 30 % of the frames.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{
    hint::black_box,
    ops::ControlFlow,
    time::{Duration, Instant},
};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lds_kalman::{EStep, EmParams, Observations, Prediction, fit_em};
use ndarray::Array2;

const DIMENSIONS: usize = 123;
const ITERATIONS: usize = 20;

/// Ways to move that the dimensions share, more than the hidden ones, each weaker than the last.
const WAYS: usize = 24;

/// Places that are pushed about at random, seen through fixed directions with half a millimetre of noise. A
/// periodic motion without noise would be learnt as one that never errs, and its covariances would settle late.
fn observations(frames: usize) -> Observations {
    let mut count = 0.0_f64;
    // Even noise between −1 and 1 that needs no generator.
    let mut noise = move || {
        count += 1.0;
        2.0 * (1e4 * (12.989_8 * count).sin()).rem_euclid(1.0) - 1.0
    };
    let directions = Array2::from_shape_fn((WAYS, DIMENSIONS), |(k, _)| noise() / (1 + k) as f64);
    let mut places = Array2::zeros((frames, WAYS));
    for k in 0..WAYS {
        let mut pace = 0.0;
        for t in 1..frames {
            pace = 0.95 * pace + 0.005 * noise();
            places[(t, k)] = 0.99 * places[(t - 1, k)] + pace;
        }
    }
    let values = places.dot(&directions).mapv(|x| x + 0.000_5 * noise());
    let gap = frames / 3..frames / 3 + frames * 3 / 10;
    let mask = Array2::from_shape_fn(values.dim(), |(t, j)| j / 3 != 17 || !gap.contains(&t));
    Observations::new(values.view(), mask.view()).unwrap()
}

/// Time of one iteration of a fit, from the end of the first to the end of the last, so that the
/// start (an eigenvalue decomposition) does not count.
fn iteration(observations: &Observations, e_step: EStep) -> Duration {
    let params =
        EmParams { iterations: 1 + ITERATIONS, tolerance: 0.0, e_step, ..EmParams::default() };
    let mut ends = Vec::new();
    let fit = fit_em(observations, &params, &mut Prediction, &mut |_| {
        ends.push(Instant::now());
        ControlFlow::Continue(())
    });
    black_box(fit.unwrap());
    assert_eq!(ends.len(), 1 + ITERATIONS);
    (ends[ITERATIONS] - ends[0]).div_f64(ITERATIONS as f64)
}

fn em_iteration(criterion: &mut Criterion) {
    for (name, e_step) in
        [("em_iteration", EStep::FilledAsObserved), ("em_iteration_exact", EStep::Exact)]
    {
        let mut group = criterion.benchmark_group(name);
        group.sample_size(10).measurement_time(Duration::from_secs(3));
        for frames in [145, 644, 1472] {
            let observations = observations(frames);
            group.bench_function(BenchmarkId::from_parameter(frames), |bencher| {
                bencher.iter_custom(|rounds| {
                    (0..rounds).map(|_| iteration(&observations, e_step)).sum()
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, em_iteration);
criterion_main!(benches);
