use mocap_core::geometry::norm;
use mocap_synth::{Activity, Measure, Person, Sex, SynthError, SynthParams};
use proptest::prelude::*;

use crate::{params, record};

fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let n = pairs.len() as f64;
    let mean = [0, 1].map(|k| pairs.iter().map(|p| p[k]).sum::<f64>() / n);
    let product =
        |i: usize, j: usize| pairs.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum::<f64>();
    product(0, 1) / (product(0, 0) * product(1, 1)).sqrt()
}

/// Within one sex, as surveys state correlations.
fn between(a: Measure, b: Measure) -> f64 {
    let men = (0..3000).map(Person::draw).filter(|p| p.sex() == Sex::Male);
    correlation(&men.map(|p| [p.metres(a), p.metres(b)]).collect::<Vec<_>>())
}

#[test]
fn measures_go_together_as_surveys_say() {
    // Bounds are round numbers about the published correlations of soldiers; 1500 men leave an error of 0.025.
    for (a, b, low, high) in [
        (Measure::Stature, Measure::Trochanter, 0.80, 0.93),
        (Measure::Stature, Measure::UpperArm, 0.65, 0.85),
        (Measure::Stature, Measure::FootLength, 0.60, 0.80),
        (Measure::Stature, Measure::Biacromial, 0.40, 0.62),
        (Measure::Stature, Measure::WaistCircumference, 0.05, 0.35),
        (Measure::WaistCircumference, Measure::WaistDepth, 0.85, 0.97),
        (Measure::Thigh, Measure::WaistCircumference, 0.70, 0.90),
        (Measure::Trochanter, Measure::Tibial, 0.80, 0.96),
        (Measure::UpperArm, Measure::Forearm, 0.65, 0.90),
        (Measure::HeadBreadth, Measure::Tibial, -0.1, 0.3),
    ] {
        let found = between(a, b);
        assert!((low..high).contains(&found), "{a:?} and {b:?}: {found}");
    }
}

#[test]
fn women_and_men_have_the_statures_of_surveys() {
    for (sex, mean) in [(Sex::Female, 1.629), (Sex::Male, 1.756)] {
        let tall: Vec<f64> =
            (0..2000).map(Person::draw).filter(|p| p.sex() == sex).map(|p| p.stature_m()).collect();
        let found = tall.iter().sum::<f64>() / tall.len() as f64;
        // A thousand draws of 6.7 cm: a standard error of 2 mm.
        assert!((found - mean).abs() < 0.008, "{sex:?}: {found}");
        let spread = tall.iter().map(|s| (s - found).powi(2)).sum::<f64>() / tall.len() as f64;
        assert!((0.055..0.075).contains(&spread.sqrt()), "{sex:?}: {}", spread.sqrt());
    }
}

#[test]
fn a_stature_can_be_asked_for() {
    let tall = Person::draw_as(3, Sex::Female, 1.82).unwrap();
    assert!((tall.stature_m() - 1.82).abs() < 1e-12);
    for wrong in [0.9, f64::NAN, 182.0] {
        let refused = Person::draw_as(3, Sex::Female, wrong);
        assert!(matches!(refused, Err(SynthError::OutOfRange { name: "stature_m", .. })));
    }
}

#[test]
fn bones_of_people_vary_and_never_stretch() {
    let mut shares = Vec::new();
    for seed in 0..40 {
        let person = Person::draw(seed);
        let recorded = record(SynthParams {
            person: Some(person),
            frames: 30,
            ..params(Activity::Kick, seed)
        });
        let joints = recorded.motion().skeleton().joints();
        for (j, joint) in joints.iter().enumerate() {
            let Some(parent) = joint.parent else { continue };
            let length = norm(joint.offset_m);
            assert!((0.02..0.65).contains(&length), "{seed} {}: {length}", joint.name);
            for t in 0..30 {
                let between = [0, 1, 2]
                    .map(|a| recorded.joints()[(t, j, a)] - recorded.joints()[(t, parent, a)]);
                // Two rounded subtractions at metre scale, 52 joints deep.
                assert!((norm(between) - length).abs() < 1e-12, "{} in frame {t}", joint.name);
            }
        }
        let of = |name: &str| norm(joints.iter().find(|j| j.name == name).unwrap().offset_m);
        shares.push((of("left_knee") + of("left_ankle")) / person.stature_m());
    }
    let (low, high) = shares.iter().fold((1.0_f64, 0.0_f64), |(l, h), s| (l.min(*s), h.max(*s)));
    // Leg shares of adults scatter by some 2 %.
    assert!(low > 0.42 && high < 0.54 && high / low > 1.04, "{low} to {high}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn joints_of_people_turn_no_further_than_joints_do(seed in any::<u64>(), activity in 0_usize..9) {
        let person = Some(Person::draw(seed));
        let motion = Activity::ALL[activity];
        let recorded = record(SynthParams { person, frames: 600, ..params(motion, seed) });
        let skeleton = recorded.motion().skeleton();
        let turned = |name: &str| {
            let joint = skeleton.find(name).unwrap();
            recorded.motion().poses().iter().map(move |pose| pose.rotations[joint])
        };
        // Hinges turn about y, the forearm's own turn aside: knees back, elbows ahead.
        for (part, sign) in [("knee", 1.0), ("elbow", -1.0)] {
            for side in ["left", "right"] {
                for rotation in turned(&format!("{side}_{part}")) {
                    let (w, v) = rotation.quaternion();
                    let bend = (2.0 * (sign * v[1]).atan2(w)).to_degrees();
                    prop_assert!((0.0..150.0).contains(&bend), "{motion} {side} {part}: {bend}");
                }
            }
        }
        // From neutral, in any direction; ranges of healthy adults, spine and neck by the joint.
        let ends = [
            ("lower_spine", 25.0), ("middle_spine", 25.0), ("upper_spine", 25.0), ("neck", 50.0), ("head", 50.0),
            ("left_wrist", 75.0), ("right_wrist", 75.0), ("left_hip", 130.0), ("right_hip", 130.0),
            ("left_clavicle", 60.0), ("right_clavicle", 60.0),
        ];
        for (name, most) in ends {
            let largest = turned(name).map(|r| r.angle().to_degrees()).fold(0.0, f64::max);
            prop_assert!(largest < most, "{motion} {name}: {largest}");
        }
    }
}

proptest! {
    #[test]
    fn every_person_is_put_together_in_order(seed in any::<u64>()) {
        let person = Person::draw(seed);
        let of = |m: Measure| person.metres(m);
        prop_assert!(Measure::all().all(|m| of(m) > 0.0 && of(m).is_finite()));
        let heights =
            [Measure::Malleolus, Measure::Tibial, Measure::Trochanter, Measure::Cervicale, Measure::Stature];
        prop_assert!(heights.windows(2).all(|pair| of(pair[0]) < of(pair[1])));
        prop_assert!(of(Measure::HandBreadth) < of(Measure::HandLength));
    }
}
