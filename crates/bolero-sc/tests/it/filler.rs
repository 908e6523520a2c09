//! The filler against its contract and its claims.

use bolero_sc::{BoleroSc, BoleroScParams, Solver};
use lds_kalman::filler::{LdsFiller, LdsFillerParams};
use mocap_core::{
    Bone, BoneRule, BoneSet, BoneSource, CoreError, FillError, Filled, GapFiller, Mask, RigidPairs,
    Take,
};
use mocap_testkit::{Claims, articulated_take, conformance};
use proptest::prelude::*;

fn filler(params: BoleroScParams) -> BoleroSc {
    BoleroSc::new(params).unwrap()
}

#[test]
fn the_filler_conforms() {
    // From the data's own subspace every step commutes with rotations, translations and
    // permutations; the iterations let rounding grow.
    let claims = Claims { rigid_motion_m: Some(1e-6), permutation_m: Some(1e-6) };
    conformance(&BoleroSc::default(), &claims);
}

/// Markers 2 and 3 (one segment) hidden in the given frames.
fn with_gap(truth: &Take, frames: std::ops::Range<usize>) -> Take {
    let hidden = Mask::from_fn(truth.frames(), truth.marker_count(), |t, m| {
        (2..4).contains(&m) && frames.contains(&t)
    });
    truth.hide(&hidden).unwrap()
}

/// Largest deviation of a distance within the segment from what it is in the truth.
fn worst_bone(truth: &Take, filled: &Filled, frames: std::ops::Range<usize>) -> f64 {
    let pairs = [(0, 2), (1, 2), (0, 3), (1, 3), (2, 3)];
    frames
        .flat_map(|t| pairs.map(|(a, b)| (t, a, b)))
        .map(|(t, a, b)| {
            let of = |take: &Take| take.distance(t, a, b).unwrap();
            (of(filled.take()) - of(truth)).abs()
        })
        .fold(0.0, f64::max)
}

#[test]
fn bones_keep_their_length_where_the_plain_system_stretches_them() {
    let truth = articulated_take(200, 9);
    let take = with_gap(&truth, 60..140);
    let worst = |lambda| {
        let filler = filler(BoleroScParams { lambda, ..BoleroScParams::default() });
        worst_bone(&truth, &filler.fill(&take).unwrap(), 60..140)
    };
    // The noise of this take is 0.1 mm, so that a prediction weighs 1e8 m⁻²; bones of 0.1 m count
    // for more than that only with a weight well above 1e10 m⁻⁴.
    let (plain, soft) = (worst(0.0), worst(1e12));
    assert!(soft < 0.005 && soft < 0.1 * plain, "soft {soft} m, plain {plain} m");
}

#[test]
fn without_bones_it_is_the_plain_system() {
    let take = with_gap(&articulated_take(100, 3), 40..60);
    let model = BoleroScParams::default().model;
    let plain = LdsFiller::new(model).unwrap().fill(&take).unwrap();
    for params in [
        BoleroScParams { lambda: 0.0, ..BoleroScParams::default() },
        BoleroScParams {
            bones: BoneSource::Given(BoneSet::default()),
            ..BoleroScParams::default()
        },
    ] {
        let filled = filler(params).fill(&take).unwrap();
        assert!(filled.take().bit_eq(plain.take()));
    }
}

#[test]
fn the_published_descent_comes_close_to_the_converged_minimum() {
    let truth = articulated_take(120, 5);
    let take = with_gap(&truth, 40..80);
    let fill = |solver| {
        filler(BoleroScParams { solver, ..BoleroScParams::default() }).fill(&take).unwrap()
    };
    let exact = fill(Solver::DampedNewton);
    let slow = fill(Solver::AdaptiveGradient { evaluations: 5000 });
    let apart = (40..80)
        .flat_map(|t| [2, 3].map(|m| (t, m)))
        .map(|(t, m)| {
            let of = |filled: &Filled| filled.take().position(t, m).unwrap();
            mocap_core::geometry::distance(of(&exact), of(&slow))
        })
        .fold(0.0, f64::max);
    // Millimetres: descent crawls along the valley that the bones make.
    assert!(apart < 0.01, "{apart} m apart");
}

fn on_threads(threads: usize, take: &Take) -> Filled {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| BoleroSc::default().fill(take).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, ..ProptestConfig::default() })]

    #[test]
    fn any_number_of_threads_gives_the_same_bits_and_keeps_observed_ones(
        seed in 0_u64..1000,
        start in 5_usize..40,
        length in 1_usize..40,
    ) {
        let truth = articulated_take(90, seed);
        let take = with_gap(&truth, start..start + length);
        let one = on_threads(1, &take);
        prop_assert!(one.take().bit_eq(on_threads(2, &take).take()));
        for (t, m) in take.observed().iter() {
            let bits = |take: &Take| take.position(t, m).unwrap().map(f64::to_bits);
            prop_assert_eq!(bits(one.take()), bits(&take));
        }
    }
}

#[test]
fn bad_parameters_and_bones_are_refused() {
    for lambda in [-1.0, f64::NAN, f64::INFINITY] {
        let error = BoleroSc::new(BoleroScParams { lambda, ..BoleroScParams::default() });
        assert!(matches!(error, Err(FillError::Parameter { field: "lambda", .. })), "{lambda}");
    }
    let model = LdsFillerParams { iterations: 0, ..LdsFillerParams::default() };
    let error = BoleroSc::new(BoleroScParams { model, ..BoleroScParams::default() });
    assert!(matches!(error, Err(FillError::Parameter { field: "iterations", .. })));
    let stray = BoneSet::new([Bone::new(0, 99, 0.3).unwrap()]).unwrap();
    let params = BoleroScParams { bones: BoneSource::Given(stray), ..BoleroScParams::default() };
    let error = filler(params).fill(&with_gap(&articulated_take(50, 1), 10..20)).unwrap_err();
    assert!(matches!(error, FillError::Core(CoreError::OutOfRange { marker: 99, .. })), "{error}");
}

#[test]
fn contradicting_bones_end_in_a_compromise() {
    let bones = BoneSet::new([
        Bone::new(0, 2, 0.01).unwrap(),
        Bone::new(1, 2, 2.0).unwrap(),
        Bone::new(2, 3, 5.0).unwrap(),
    ])
    .unwrap();
    let params = BoleroScParams { bones: BoneSource::Given(bones), ..BoleroScParams::default() };
    let filled = filler(params).fill(&with_gap(&articulated_take(60, 2), 20..30)).unwrap();
    assert!(filled.report().refusals.is_empty());
}

#[test]
fn unnamed_markers_get_their_bones_from_rigidity() {
    let take = with_gap(&articulated_take(100, 6), 40..50);
    let found = BoneSource::default().find(&take).unwrap();
    let rule = BoneRule::Rigid(RigidPairs::default());
    assert_eq!(found, BoneSet::estimate(&take, &rule).unwrap());
    assert!(found.touching(2).count() > 0);
}
