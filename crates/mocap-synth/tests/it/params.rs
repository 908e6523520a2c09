use mocap_synth::{Activity, Hands, Layout, Person, Synth, SynthError, SynthParams};
use proptest::prelude::*;

use crate::record;

#[test]
fn every_field_out_of_range_is_refused_by_name() {
    let ok = SynthParams::default();
    let cases = [
        ("rate_hz", SynthParams { rate_hz: 0.0, ..ok }),
        ("rate_hz", SynthParams { rate_hz: f64::NAN, ..ok }),
        ("rate_hz", SynthParams { rate_hz: 2000.1, ..ok }),
        ("stature_m", SynthParams { stature_m: 1.1, ..ok }),
        ("stature_m", SynthParams { stature_m: f64::INFINITY, ..ok }),
        ("noise_m", SynthParams { noise_m: -0.001, ..ok }),
        ("noise_m", SynthParams { noise_m: 0.02, ..ok }),
        ("marker_radius_m", SynthParams { marker_radius_m: 0.031, ..ok }),
        ("marker_radius_m", SynthParams { marker_radius_m: f64::NAN, ..ok }),
        ("soft_tissue", SynthParams { soft_tissue: 3.5, ..ok }),
        ("soft_tissue", SynthParams { soft_tissue: f64::NAN, ..ok }),
    ];
    for (field, params) in cases {
        match Synth::new(params).err() {
            Some(SynthError::OutOfRange { name, min, max, .. }) => {
                assert_eq!(name, field);
                assert!(min < max);
            }
            other => panic!("{field}: {other:?}"),
        }
    }
}

#[test]
fn frames_out_of_range_are_refused() {
    for frames in [0, 1_000_001, usize::MAX] {
        let refused = Synth::new(SynthParams { frames, ..SynthParams::default() }).err();
        assert_eq!(refused, Some(SynthError::Frames { frames, min: 1, max: 1_000_000 }));
    }
}

#[test]
fn a_message_names_value_and_range() {
    let params = SynthParams { stature_m: 175.0, ..SynthParams::default() };
    let text = Synth::new(params).err().unwrap().to_string();
    assert_eq!(
        text,
        "`stature_m` = 175 is not between 1.2 and 2.2 m; choose a value in that range"
    );
}

#[test]
fn activities_are_read_and_written_by_name() {
    for activity in Activity::ALL {
        assert_eq!(activity.to_string().parse(), Ok(activity));
        assert_eq!(activity.to_string().to_uppercase().parse(), Ok(activity));
    }
    let refused = "swim".parse::<Activity>();
    assert_eq!(refused, Err(SynthError::UnknownActivity { word: "swim".into() }));
}

proptest! {
    // A case settles up to a thousand frames before it records, so 64 of them take about a second.
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_allowed_parameter_gives_a_complete_finite_take(
        activity in 0_usize..9,
        layout in 0_usize..3,
        hands in 0_usize..3,
        person in proptest::option::of(any::<u64>()),
        marker_radius_m in 0.0..=0.03,
        frames in 1_usize..60,
        rate_hz in 10.0..=2000.0,
        seed in any::<u64>(),
        stature_m in 1.2..=2.2,
        noise_m in 0.0..=0.01,
        soft_tissue in 0.0..=3.0,
    ) {
        let motion = Activity::ALL[activity];
        let (layout, hands) = (Layout::ALL[layout], Hands::ALL[hands]);
        let person = person.map(Person::draw);
        let recorded = record(SynthParams {
            motion,
            frames,
            rate_hz,
            seed,
            stature_m,
            person,
            layout,
            hands,
            marker_radius_m,
            noise_m,
            soft_tissue,
        });
        let take = recorded.take();
        let markers = layout.markers().count() + 2 * hands.per_hand();
        prop_assert_eq!((take.frames(), take.marker_count()), (frames, markers));
        prop_assert_eq!(recorded.joints().dim(), (frames, if hands == Hands::None { 22 } else { 52 }, 3));
        prop_assert!(take.gaps().is_empty());
        // Nobody reaches higher than 1.9 statures, and no track is wider than 30 m.
        let within = |t: usize, m: usize| {
            let [x, y, z] = take.position(t, m).unwrap();
            x.abs() < 30.0 && y.abs() < 30.0 && (-0.1..1.9 * 2.2).contains(&z)
        };
        prop_assert!((0..frames).all(|t| (0..markers).all(|m| within(t, m))));
    }
}
