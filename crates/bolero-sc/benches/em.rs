//! Time of one EM iteration with soft bones beside one without, one marker missing in 30 % of the frames.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use bolero_sc::{BoleroSc, BoleroScParams};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lds_kalman::filler::{Coordinates, Hidden, LdsFillerParams};
use mocap_core::{BoneRule, BoneSet, BoneSource, GapFiller, MarkerSet, Mask, Take};
use ndarray::Array3;

const MARKERS: usize = 41;
const ITERATIONS: usize = 20;

/// Ways to move that the bones share.
const WAYS: usize = 8;

/// Markers on a chain of bones that is bent at random, seen with half a millimetre of noise.
fn take(frames: usize) -> (Take, BoneSet) {
    let mut count = 0.0_f64;
    // Even noise between −1 and 1 that needs no generator.
    let mut noise = move || {
        count += 1.0;
        2.0 * (1e4 * (12.989_8 * count).sin()).rem_euclid(1.0) - 1.0
    };
    let mut ways = [0.0; WAYS];
    let mut paces = [0.0; WAYS];
    let shares = [(); 2 * MARKERS * WAYS].map(|()| noise());
    let mut positions = Array3::zeros((frames, MARKERS, 3));
    for t in 0..frames {
        for (way, pace) in ways.iter_mut().zip(&mut paces) {
            *pace = 0.95 * *pace + 0.005 * noise();
            *way = 0.99 * *way + *pace;
        }
        let mut place = [ways[0], ways[1], ways[2]];
        for m in 0..MARKERS {
            let angle = |which: usize| {
                let shares = shares[(2 * m + which) * WAYS..].iter();
                1.0 + m as f64 + shares.zip(&ways).map(|(share, way)| share * way).sum::<f64>()
            };
            let (tilt, turn) = (angle(0), angle(1));
            let bone = [tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), tilt.cos()];
            for a in 0..3 {
                place[a] += 0.1 * bone[a];
                positions[(t, m, a)] = place[a] + 0.000_5 * noise();
            }
        }
    }
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
        bones: BoneSource::Given(bones.clone()),
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
