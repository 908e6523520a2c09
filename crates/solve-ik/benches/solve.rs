//! Frames a second on one core, for 22 body joints and 41 markers, after calibration.
#![allow(missing_docs, clippy::unwrap_used)] // benches

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use mocap_synth::{Activity, Synth, SynthParams};
use solve_ik::{Body, IkParams, IkSolver};

fn frames(c: &mut Criterion) {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut group = c.benchmark_group("solve-ik");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    for frames in [1024, 4096] {
        let params =
            SynthParams { motion: Activity::Run, frames, seed: 1, ..SynthParams::default() };
        let take = Synth::new(params).unwrap().take().unwrap().into_take();
        let body =
            IkSolver::new(Body::cmu_41(), IkParams::default()).unwrap().calibrate(&take).unwrap();
        let calibrated = IkParams { calibration_rounds: 0, ..IkParams::default() };
        let solver = IkSolver::new(body, calibrated).unwrap();
        let solution = one.install(|| solver.solve(&take)).unwrap();
        assert!(solution.residual_m.iter().all(|miss| *miss < 0.03));
        group.throughput(Throughput::Elements(frames as u64));
        group.bench_function(BenchmarkId::new("run/none", frames), |b| {
            b.iter(|| one.install(|| solver.solve(&take).unwrap().steps));
        });
    }
    group.finish();
}

criterion_group!(benches, frames);
criterion_main!(benches);
