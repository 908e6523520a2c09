//! Frames a second on one core, body and markers: the motion, the posture, forward kinematics, skin, soft tissue
//! and noise.
#![allow(clippy::unwrap_used)] // benchmarks
#![allow(missing_docs)] // criterion's macros make undocumented items

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mocap_synth::{Activity, Hands, Layout, Person, Synth, SynthParams};

const FRAMES: usize = 2400;

fn synth(c: &mut Criterion) {
    let mut group = c.benchmark_group("synth");
    group.throughput(Throughput::Elements(FRAMES as u64));
    let base = SynthParams { frames: FRAMES, seed: 5, ..SynthParams::default() };
    let person = Some(Person::draw(5));
    let cases = [
        ("walk/cmu-41", base),
        ("throw/cmu-41", SynthParams { motion: Activity::Throw, ..base }),
        ("walk/production-57", SynthParams { person, layout: Layout::Production57, ..base }),
        (
            "reach/front_waist-53+20",
            SynthParams {
                motion: Activity::Reach,
                person,
                layout: Layout::FrontWaist53,
                hands: Hands::Ten,
                ..base
            },
        ),
    ];
    for (name, params) in cases {
        let synth = Synth::new(params).unwrap();
        assert_eq!(synth.take().unwrap().take().frames(), FRAMES);
        group.bench_function(format!("{name}/{FRAMES}"), |b| b.iter(|| synth.take().unwrap()));
    }
    group.finish();
}

criterion_group!(benches, synth);
criterion_main!(benches);
