//! Time of one EM iteration with soft bones beside one without, one marker missing in 30 % of the frames.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{hint::black_box, time::Duration};

use bolero_sc::{BoleroSc, BoleroScParams, Bones};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lds_kalman::filler::{Coordinates, Hidden, LdsFillerParams};
use mocap_core::{BoneRule, BoneSet, GapFiller, MarkerSet, Mask, Take};
use ndarray::Array3;

const MARKERS: usize = 41;
const ITERATIONS: usize = 20;

/// Markers on a chain that sways, and the bones along it.
fn take(frames: usize) -> (Take, BoneSet) {
    let positions = Array3::from_shape_fn((frames, MARKERS, 3), |(t, m, a)| {
        let (t, m, a) = (t as f64 / 120.0, m as f64, a as f64);
        0.05 * m + 0.3 * (5.0 * t + 0.2 * m + a).sin() + 0.1 * (9.0 * t + 0.3 * m * (a + 1.0)).cos()
    });
    let names = MarkerSet::new((0..MARKERS).map(|m| format!("M{m}"))).unwrap();
    let truth = Take::from_positions(names, 120.0, positions).unwrap();
    let pairs = (1..MARKERS).map(|m| (m - 1, m)).collect();
    let bones = BoneSet::estimate(&truth, &BoneRule::Pairs(pairs)).unwrap();
    let gap = frames / 3..frames / 3 + frames * 3 / 10;
    let hidden = Mask::from_fn(frames, MARKERS, |t, m| m == 17 && gap.contains(&t));
    (truth.hide(&hidden).unwrap(), bones)
}

fn filler(bones: &BoneSet, lambda: f64, iterations: usize) -> BoleroSc {
    BoleroSc::new(BoleroScParams {
        model: LdsFillerParams {
            hidden: Hidden::Exactly(16),
            iterations,
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

fn em_iteration(criterion: &mut Criterion) {
    for (name, lambda) in [("em_iteration_plain", 0.0), ("em_iteration_bones", 1e6)] {
        let mut group = criterion.benchmark_group(name);
        group.sample_size(10).measurement_time(Duration::from_secs(3));
        for frames in [145, 644, 1472] {
            let (take, bones) = take(frames);
            // One iteration is the difference of a long and a short fit, as in `lds-kalman`.
            let long = filler(&bones, lambda, 2 + ITERATIONS);
            let short = filler(&bones, lambda, 2);
            assert!(long.fill(&take).unwrap().take().gaps().is_empty());
            let time = |filler: &BoleroSc| {
                let clock = std::time::Instant::now();
                black_box(filler.fill(&take).unwrap());
                clock.elapsed()
            };
            group.bench_function(BenchmarkId::from_parameter(frames), |bencher| {
                bencher.iter_custom(|rounds| {
                    let each = || time(&long).saturating_sub(time(&short));
                    (0..rounds).map(|_| each().div_f64(ITERATIONS as f64)).sum()
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, em_iteration);
criterion_main!(benches);
