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

/// What cameras add. Without it the last hidden dimensions would have nothing to learn, and numbers too
/// small for the processor's fast paths.
const NOISE_M: f64 = 0.000_5;

/// A rhythm that all dimensions share, each at its own phase.
fn wave(k: f64, t: f64, j: f64) -> f64 {
    0.5 / (k * k) * (3.1 * k * t + (0.3 + 0.1 * k) * j + 0.01 * k * j * j).sin()
}

/// Even noise between −1 and 1 that needs no generator.
fn noise(i: f64) -> f64 {
    2.0 * (1e4 * (12.989_8 * i).sin()).rem_euclid(1.0) - 1.0
}

fn observations(frames: usize) -> Observations {
    let values = Array2::from_shape_fn((frames, DIMENSIONS), |(t, j)| {
        let (t, j) = (t as f64 / 120.0, j as f64);
        let waves: f64 = (1..=8).map(|k| wave(f64::from(k), t, j)).sum();
        waves + NOISE_M * noise(t * 120.0 * DIMENSIONS as f64 + j)
    });
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
