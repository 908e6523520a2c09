//! Time of one EM iteration with one marker missing in 30 % of the frames.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{hint::black_box, ops::ControlFlow, time::Duration};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lds_kalman::{EStep, EmParams, Observations, Prediction, fit_em};
use ndarray::Array2;

const DIMENSIONS: usize = 123;
const ITERATIONS: usize = 20;

fn observations(frames: usize) -> Observations {
    let values = Array2::from_shape_fn((frames, DIMENSIONS), |(t, j)| {
        let (t, j) = (t as f64 / 120.0, j as f64);
        (5.0 * t + j).sin() + 0.4 * (9.0 * t + 0.3 * j * j).cos() + 0.1 * (23.0 * t + 1.7 * j).sin()
    });
    let gap = frames / 3..frames / 3 + frames * 3 / 10;
    let mask = Array2::from_shape_fn(values.dim(), |(t, j)| j / 3 != 17 || !gap.contains(&t));
    Observations::new(values.view(), mask.view()).unwrap()
}

/// A fit of `iterations`; criterion divides by the number of iterations it asked for.
fn fit(observations: &Observations, e_step: EStep, iterations: usize) -> f64 {
    let params = EmParams { iterations, tolerance: 0.0, e_step, ..EmParams::default() };
    let fit =
        fit_em(observations, &params, &mut Prediction, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(fit.iterations(), iterations);
    fit.filled.sum()
}

fn em_iteration(criterion: &mut Criterion) {
    for (name, e_step) in
        [("em_iteration", EStep::FilledAsObserved), ("em_iteration_exact", EStep::Exact)]
    {
        let mut group = criterion.benchmark_group(name);
        group.sample_size(10).measurement_time(Duration::from_secs(3));
        for frames in [145, 644, 1472] {
            let observations = observations(frames);
            assert!(fit(&observations, e_step, 2).is_finite());
            group.bench_function(BenchmarkId::from_parameter(frames), |bencher| {
                // One iteration is the difference of a long and a short fit, so that the start
                // (a singular value decomposition) does not count.
                bencher.iter_custom(|rounds| {
                    let mut total = Duration::ZERO;
                    for _ in 0..rounds {
                        let clock = std::time::Instant::now();
                        black_box(fit(&observations, e_step, 1 + ITERATIONS));
                        let long = clock.elapsed();
                        let clock = std::time::Instant::now();
                        black_box(fit(&observations, e_step, 1));
                        let short = clock.elapsed();
                        total += long.saturating_sub(short).div_f64(ITERATIONS as f64);
                    }
                    total
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, em_iteration);
criterion_main!(benches);
