//! Reading C3D files held in memory: parse, then decode every sample.
#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use mocap_io::c3d::{C3d, C3dOptions, NewC3d, NewStorage, Processor};

/// A recording of 41 markers, a tenth of the samples missing.
fn recording(processor: Processor, storage: NewStorage, frames: usize) -> Vec<u8> {
    let mut new = NewC3d::new((0..41).map(|marker| format!("M{marker:02}")).collect(), 120.0);
    new.processor = processor;
    new.storage = storage;
    let at = |index: usize| (index as f64 * 0.37).sin() * 900.0;
    new.xyz = (0..frames * 41).map(|index| [at(index), at(index + 7), at(index + 13)]).collect();
    new.missing = (0..frames * 41).map(|index| index % 10 == 3).collect();
    new.encode().unwrap()
}

fn read(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("c3d_read");
    group.sample_size(20);
    let storages = [("real", NewStorage::Real), ("int", NewStorage::Integer { scale: 0.1 })];
    let processors =
        [("intel", Processor::Intel), ("dec", Processor::Dec), ("sgi", Processor::Sgi)];
    for (processor_name, processor) in processors {
        for (storage_name, storage) in storages {
            let bytes = recording(processor, storage, 20_000);
            let parsed = C3d::parse(bytes.clone(), &C3dOptions::default()).unwrap();
            assert_eq!(parsed.decode_points().counts().negative_residual, 20_000 * 41 / 10);
            group.throughput(Throughput::Bytes(bytes.len() as u64));
            group.bench_function(format!("{processor_name}/{storage_name}/20000x41"), |bencher| {
                bencher.iter_batched(
                    || bytes.clone(),
                    |bytes| {
                        let file = C3d::parse(bytes, &C3dOptions::default()).unwrap();
                        black_box(file.decode_points())
                    },
                    BatchSize::LargeInput,
                );
            });
        }
    }
    group.finish();
}

criterion_group!(benches, read);
criterion_main!(benches);
