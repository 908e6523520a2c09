//! Time of a look at a take, by its length: it has to grow with the samples and no faster.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{hint::black_box, time::Duration};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use marker_faults::FaultDetector;
use mocap_core::{MarkerSet, Take};
use mocap_testkit::articulated_take;
use ndarray::Array3;

/// Five bodies of eight markers, with a spike in every second of each.
fn take(frames: usize) -> Take {
    let bodies: Vec<Take> = (0..5).map(|seed| articulated_take(frames, seed)).collect();
    let xyz = Array3::from_shape_fn((frames, 40, 3), |(t, m, a)| {
        let spike = if t % 120 == 3 * m && a == 0 { 0.05 } else { 0.0 };
        bodies[m / 8].positions()[(t, m % 8, a)] + spike
    });
    let names = MarkerSet::new((0..40).map(|m| format!("M{m}"))).unwrap();
    Take::from_positions(names, 120.0, xyz).unwrap()
}

/// The floor: a sample has three deviations of three coordinates with three or four products each, 60 operations, and
/// reads and writes about 200 bytes, so 30 ns.
fn detect(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("detect");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    for frames in [600, 1200, 2400, 4800] {
        let take = take(frames);
        assert!(FaultDetector::default().detect(&take).mask().count() >= 30 * (frames / 120 - 1));
        group.throughput(Throughput::Elements((frames * 40) as u64));
        group.bench_function(BenchmarkId::from_parameter(frames), |bencher| {
            bencher.iter(|| black_box(FaultDetector::default().detect(&take)));
        });
    }
    group.finish();
}

criterion_group!(benches, detect);
criterion_main!(benches);
