//! Time of one EM iteration with soft bones beside one without, one marker missing in 30 % of the frames.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use bolero_sc::{BoleroSc, BoleroScParams, Bones};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lds_kalman::filler::{Coordinates, Hidden, LdsFillerParams};
use mocap_core::{BoneRule, BoneSet, GapFiller, MarkerSet, Mask, Take};
use ndarray::Array3;

const MARKERS: usize = 41;
const ITERATIONS: usize = 20;

/// What cameras add; without it the last hidden dimensions would have nothing to learn.
const NOISE_M: f64 = 0.000_5;

/// Markers on a chain that sways, and the bones along it.
fn take(frames: usize) -> (Take, BoneSet) {
    let positions = Array3::from_shape_fn((frames, MARKERS, 3), |(t, m, a)| {
        let noise = NOISE_M
            * (2.0 * (1e4 * ((t * MARKERS + m) as f64 + a as f64 / 3.0).sin()).rem_euclid(1.0)
                - 1.0);
        let (t, m, a) = (t as f64 / 120.0, m as f64, a as f64);
        noise
            + 0.05 * m
            + 0.3 * (5.0 * t + 0.2 * m + a).sin()
            + 0.1 * (9.0 * t + 0.3 * m * (a + 1.0)).cos()
    });
    let names = MarkerSet::new((0..MARKERS).map(|m| format!("M{m}"))).unwrap();
    let truth = Take::from_positions(names, 120.0, positions).unwrap();
    let pairs = (1..MARKERS).map(|m| (m - 1, m)).collect();
    let bones = BoneSet::estimate(&truth, &BoneRule::Pairs(pairs)).unwrap();
    let gap = frames / 3..frames / 3 + frames * 3 / 10;
    let hidden = Mask::from_fn(frames, MARKERS, |t, m| m == 17 && gap.contains(&t));
    (truth.hide(&hidden).unwrap(), bones)
}

fn filler(bones: &BoneSet, lambda: f64) -> BoleroSc {
    BoleroSc::new(BoleroScParams {
        model: LdsFillerParams {
            hidden: Hidden::Exactly(16),
            iterations: 1 + ITERATIONS,
            tolerance: 0.0,
            coordinates: Coordinates::World,
            ..LdsFillerParams::default()
        },
        lambda,
        bones: Bones::Given(bones.clone()),
        ..BoleroScParams::default()
    })
    .unwrap()
}

/// Time of one iteration of a fill, from the end of the first to the end of the last.
fn iteration(filler: &BoleroSc, take: &Take) -> Duration {
    let mut ends = Vec::new();
    let filled = filler.fill_observed(take, &mut |_| {
        ends.push(Instant::now());
        ControlFlow::Continue(())
    });
    assert!(filled.unwrap().take().gaps().is_empty());
    assert_eq!(ends.len(), 1 + ITERATIONS);
    (ends[ITERATIONS] - ends[0]).div_f64(ITERATIONS as f64)
}

fn em_iteration(criterion: &mut Criterion) {
    for (name, lambda) in [("em_iteration_plain", 0.0), ("em_iteration_bones", 1e6)] {
        let mut group = criterion.benchmark_group(name);
        group.sample_size(10).measurement_time(Duration::from_secs(3));
        for frames in [145, 644, 1472] {
            let (take, bones) = take(frames);
            let filler = filler(&bones, lambda);
            group.bench_function(BenchmarkId::from_parameter(frames), |bencher| {
                bencher.iter_custom(|rounds| (0..rounds).map(|_| iteration(&filler, &take)).sum());
            });
        }
        group.finish();
    }
}

criterion_group!(benches, em_iteration);
criterion_main!(benches);
