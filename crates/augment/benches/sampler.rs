//! Time to draw gaps, in cells (marker-frames) a second.
// Unwrapping is how a bench fails; criterion makes public functions without documentation.
#![allow(missing_docs, clippy::unwrap_used)]

use augment::{GapSampler, GapSamplerParams, Occluder, Preset};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mocap_core::{MarkerSet, Take};
use ndarray::Array3;

const FRAMES: usize = 20_000;

/// Markers on a line, one step apart.
fn take(preset: Preset) -> Take {
    let names = MarkerSet::new(preset.markers().map(|marker| marker.0)).unwrap();
    let xyz = Array3::from_shape_fn((FRAMES, names.len(), 3), |(t, m, axis)| match axis {
        0 => 0.001 * t as f64,
        1 => 0.1 * m as f64,
        _ => 1.0,
    });
    Take::from_positions(names, 120.0, xyz).unwrap()
}

fn sampler(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sampler");
    let occluder = Some(Occluder::default());
    for (id, preset, occlusion, occluder) in [
        ("eq6/front_waist/0.1/20000", Preset::FrontWaist, 0.1, None),
        ("eq6/ten_finger/0.4/20000", Preset::TenFinger, 0.4, None),
        ("occluder/front_waist/0.1/20000", Preset::FrontWaist, 0.1, occluder),
    ] {
        let take = take(preset);
        let params = GapSamplerParams { occlusion, occluder, ..GapSamplerParams::default() };
        let sampler = GapSampler::new(preset.model().unwrap(), params).unwrap();
        let once = sampler.sample(&take).unwrap();
        assert!((once.draw.occlusion - occlusion).abs() < 0.05 * occlusion);
        group.throughput(Throughput::Elements((FRAMES * take.marker_count()) as u64));
        group.bench_function(id, |bench| bench.iter(|| sampler.sample(&take).unwrap()));
    }
    group.finish();
}

criterion_group!(benches, sampler);
criterion_main!(benches);
