//! Time of `auto` on a take of 1500 frames and 41 markers, by its number of gaps: it has to grow with them and no
//! faster.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{hint::black_box, time::Duration};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gapfill::{Auto, AutoParams};
use mocap_core::{GapFiller, Mask, Take};
use mocap_synth::{Activity, Synth, SynthParams};

/// A runner with so many gaps of 0.1 to 1 s, each in a marker of its own.
fn take(gaps: usize) -> Take {
    let params =
        SynthParams { motion: Activity::Run, frames: 1500, seed: 3, ..SynthParams::default() };
    let recorded = Synth::new(params).unwrap().take().unwrap();
    let take = recorded.take();
    let hidden = Mask::from_fn(take.frames(), take.marker_count(), |t, m| {
        let (k, start) = (m / 2, 50 + m * 677 % 1300);
        m % 2 == 0 && k < gaps && (start..start + 12 + k * 37 % 109).contains(&t)
    });
    take.hide(&hidden).unwrap()
}

/// The floor of a gap: ten processes of about 200 frames. For each, a factor takes n³ / 3 = 2.7 million operations,
/// the inverse of its last 130 rows 0.7, covariances of frames with each other and with those of the gap 30 000
/// exponentials of 30 operations; for each of eight views, products of features 2 million. Together 60 million
/// operations, which is 5 ms at 12 a nanosecond.
fn auto(criterion: &mut Criterion) {
    let filler = Auto::new(AutoParams::default()).unwrap();
    let mut group = criterion.benchmark_group("auto/synth-1500x41/gaps");
    group.sample_size(10).measurement_time(Duration::from_secs(5));
    for gaps in [5, 10, 20] {
        let take = take(gaps);
        assert_eq!(take.gaps().len(), gaps);
        assert!(filler.fill(&take).unwrap().report().refusals.is_empty());
        group.throughput(Throughput::Elements(gaps as u64));
        group.bench_function(BenchmarkId::from_parameter(gaps), |bencher| {
            bencher.iter(|| black_box(filler.fill(&take)));
        });
    }
    group.finish();
}

criterion_group!(benches, auto);
criterion_main!(benches);
