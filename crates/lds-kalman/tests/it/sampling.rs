//! Draws have the moments of the joint Gaussian.

use crate::support::{Random, dense};

#[test]
fn sample_moments_match_the_joint_gaussian() {
    let model = Random::new(21).model(2, 3);
    let frames = 3;
    let draws = 20_000;
    let (mean, covariance) = dense(&model).joint(frames);
    let stacked = |seed| {
        let sample = model.sample(frames, seed).unwrap();
        sample.states.iter().chain(&sample.observations).copied().collect::<Vec<f64>>()
    };
    let size = mean.len();
    let (mut sums, mut products) = (vec![0.0; size], vec![0.0; size * size]);
    for seed in 0..draws {
        let draw = stacked(seed);
        for i in 0..size {
            let a = draw[i] - mean[i];
            sums[i] += a;
            for j in 0..size {
                products[i * size + j] += a * (draw[j] - mean[j]);
            }
        }
    }
    let count = draws as f64;
    for i in 0..size {
        // 4.5 standard errors: one test in 1e4 would fail by chance, and the seeds are fixed.
        let error = (sums[i] / count).abs();
        assert!(error < 4.5 * (covariance[(i, i)] / count).sqrt(), "mean {i}");
        for j in 0..size {
            let found = products[i * size + j] / count;
            let variance = covariance[(i, i)] * covariance[(j, j)] + covariance[(i, j)].powi(2);
            let error = (found - covariance[(i, j)]).abs();
            assert!(error < 4.5 * (variance / count).sqrt(), "covariance {i}, {j}");
        }
    }
}

#[test]
fn a_draw_repeats_with_its_seed() {
    let model = Random::new(22).model(3, 4);
    assert_eq!(model.sample(9, 4).unwrap(), model.sample(9, 4).unwrap());
    assert_ne!(model.sample(9, 4).unwrap(), model.sample(9, 5).unwrap());
}
