//! Time of a missing sample, by way of solving and by the frames that are missing.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{hint::black_box, time::Duration};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edm_mds::{Edm, EdmParams, EdmSolver};
use mocap_core::{GapFiller, Mask, Take};
use mocap_synth::{Activity, Synth, SynthParams};

/// A runner with eight markers missing for so many frames.
fn take(missing: usize) -> Take {
    let params =
        SynthParams { motion: Activity::Run, frames: 1500, seed: 3, ..SynthParams::default() };
    let recorded = Synth::new(params).unwrap().take().unwrap();
    let take = recorded.take();
    let hidden = Mask::from_fn(take.frames(), take.marker_count(), |t, m| {
        m % 5 == 0 && m < 40 && (30 + m..30 + m + missing).contains(&t)
    });
    take.hide(&hidden).unwrap()
}

/// The floor by scaling: the extents of the neighbours take 900 operations, sums of products with the borders 200, four
/// rotations 1200, and the leading subspace of six rows 1200 in eight steps, together 3500 operations or 1.2 µs at three
/// a nanosecond. Ranking the neighbours adds 40 · 1500 distances a marker, 0.2 µs a sample where a thousand are missing
/// and 0.8 µs where 250 are.
fn edm(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("edm/synth-1500x41");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    for (name, solver) in
        [("scaling", EdmSolver::Scaling), ("trilateration", EdmSolver::Trilateration)]
    {
        let filler = Edm::new(EdmParams { solver, ..EdmParams::default() }).unwrap();
        for missing in [250, 500, 1000] {
            let take = take(missing);
            let samples = 8 * missing;
            assert_eq!(filler.fill(&take).unwrap().filled_cells().count(), samples);
            group.throughput(Throughput::Elements(samples as u64));
            group.bench_function(BenchmarkId::new(name, samples), |bencher| {
                bencher.iter(|| black_box(filler.fill(&take)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, edm);
criterion_main!(benches);
