//! What `auto` promises for any gaps of bodies whose neighbours are seen.

use std::sync::Arc;

use gapfill::{Auto, AutoParams};
use metrics::border_step;
use mocap_core::{
    Filled, GapFiller, Holdout, Mask, RigidTransform, Rotation, Take, geometry::distance,
};
use mocap_testkit::{articulated_take, rigid_take, with_gaps};
use proptest::prelude::*;

fn fill(take: &Take) -> Filled {
    Auto::new(AutoParams::default()).unwrap().fill(take).unwrap()
}

fn fill_in_session(take: &Take, session: &[&Take]) -> Filled {
    let session = session.iter().map(|&take| Arc::new(take.clone())).collect();
    Auto::new(AutoParams { session, ..AutoParams::default() }).unwrap().fill(take).unwrap()
}

fn largest_difference(a: &Take, b: &Take, map: impl Fn([f64; 3]) -> [f64; 3]) -> f64 {
    assert_eq!(a.observed(), b.observed());
    let differences = a
        .observed()
        .iter()
        .map(|(t, m)| distance(map(a.position(t, m).unwrap()), b.position(t, m).unwrap()));
    differences.fold(0.0, f64::max)
}

/// Two gaps in markers of one half of the body, some at the start or the end of the take; enough neighbours are seen.
fn gapped(seed: u64) -> Holdout {
    with_gaps(articulated_take(200, seed), seed, 2, 1..=40)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_fill_moves_with_the_take(
        seed in 0..1000_u64,
        axis in prop::array::uniform3(-1.0..1.0_f64),
        angle in -3.0..3.0_f64,
        translation in prop::array::uniform3(-5.0..5.0_f64),
    ) {
        let take = gapped(seed).visible().clone();
        let motion = RigidTransform { rotation: Rotation::about(axis, angle), translation };
        let moved = take.map_positions(|_, _, p| motion.apply(p)).unwrap();
        let (here, there) = (fill(&take), fill(&moved));
        let difference = largest_difference(here.take(), there.take(), |p| motion.apply(p));
        prop_assert!(difference < 1e-9, "{difference}");
    }

    /// Curves, components and systems compete where a whole segment, or all of the body, is lost.
    #[test]
    fn a_fill_of_lost_segments_moves_with_the_take(
        seed in 0..1000_u64,
        axis in prop::array::uniform3(-1.0..1.0_f64),
        angle in -3.0..3.0_f64,
        length in 5..40_usize,
        all in prop::bool::ANY,
    ) {
        let truth = articulated_take(300, seed);
        let lost = if all { 0..8 } else { 4..8 };
        let hidden =
            Mask::from_fn(300, 8, |t, m| lost.contains(&m) && (120..120 + length).contains(&t));
        let take = truth.hide(&hidden).unwrap();
        let motion =
            RigidTransform { rotation: Rotation::about(axis, angle), translation: [0.3, 2.0, -1.0] };
        let moved = take.map_positions(|_, _, p| motion.apply(p)).unwrap();
        let (here, there) = (fill(&take), fill(&moved));
        let difference = largest_difference(here.take(), there.take(), |p| motion.apply(p));
        prop_assert!(difference < 1e-9, "{difference}");
    }

    #[test]
    fn the_order_of_markers_does_not_matter(
        seed in 0..1000_u64,
        order in Just((0..8).collect::<Vec<usize>>()).prop_shuffle(),
    ) {
        let take = gapped(seed).visible().clone();
        let (plain, shuffled) = (fill(&take), fill(&take.select(&order).unwrap()));
        let sorted = plain.take().select(&order).unwrap();
        let difference = largest_difference(&sorted, shuffled.take(), |p| p);
        prop_assert!(difference < 1e-9, "{difference}");
    }

    /// The step at a border is at most that of the hidden samples, and what a marker moves in a frame if it speeds up by
    /// thirty times gravity: 21 mm at 120 frames a second. The fade of what was drawn to the samples adds a tenth of it.
    #[test]
    fn fills_join_the_samples_beside_a_gap(seed in 0..1000_u64) {
        let holdout = gapped(seed);
        let filled = fill(holdout.visible());
        for gap in filled.gaps() {
            let truth = border_step(holdout.truth(), &gap).max_mm().unwrap_or(0.0);
            let step = border_step(filled.take(), &gap).max_mm().unwrap_or(0.0);
            let most = 1.1e3 * 300.0 / holdout.truth().rate_hz().powi(2);
            prop_assert!(step <= truth + most, "{step} {truth} {most}");
        }
    }

    #[test]
    fn a_rigid_body_is_recovered(
        seed in 0..1000_u64,
        markers in 5..9_usize,
        start in 0..150_usize,
        length in 1..100_usize,
    ) {
        let truth = rigid_take(markers, 200, seed);
        let hidden =
            Mask::from_fn(200, markers, |t, m| m == 0 && (start..start + length).contains(&t));
        let filled = fill(&truth.hide(&hidden).unwrap());
        let difference = largest_difference(&truth, filled.take(), |p| p);
        // Four markers or more drawn at random may come close to a line, which costs digits.
        prop_assert!(difference < 1e-8, "{difference}");
    }

    /// Any pattern of visibility gives finite samples or refusals, never a panic, and leaves what was observed.
    #[test]
    fn any_mask_is_accounted_for(seed in 0..1000_u64, share in 0.1..0.8_f64, run in 3..40_usize) {
        let hash = |t: usize, m: usize| {
            let hash = (seed + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15)
                ^ ((t / run * 8 + m) as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
            ((hash ^ hash >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f64
                / f64::from(1 << 24)
        };
        let truth = articulated_take(120, seed);
        let take = truth.hide(&Mask::from_fn(120, 8, |t, m| hash(t, m) < share)).unwrap();
        prop_assume!(take.observed().count() > 0);
        let filled = fill(&take);
        for gap in take.gaps() {
            let refused = filled.report().refusals.iter().any(|r| r.gap == gap);
            for t in gap.frames.clone() {
                prop_assert!(filled.take().is_observed(t, gap.marker) != refused);
            }
        }
    }

    #[test]
    fn a_fill_moves_with_take_and_session(seed in 0..1000_u64, angle in -3.0..3.0_f64) {
        let take = gapped(seed).visible().clone();
        let motion = RigidTransform {
            rotation: Rotation::about([0.4, 1.0, -0.3], angle),
            translation: [1.0, -2.0, 0.5],
        };
        let moved = |take: &Take| take.map_positions(|_, _, p| motion.apply(p)).unwrap();
        let other = articulated_take(150, seed + 1);
        let here = fill_in_session(&take, &[&other]);
        let there = fill_in_session(&moved(&take), &[&moved(&other)]);
        let difference = largest_difference(here.take(), there.take(), |p| motion.apply(p));
        prop_assert!(difference < 1e-9, "{difference}");
    }

    #[test]
    fn observed_samples_stay_bit_for_bit(seed in 0..1000_u64) {
        let take = gapped(seed).visible().clone();
        let filled = fill_in_session(&take, &[&articulated_take(90, seed + 2)]);
        for (t, m) in take.observed().iter() {
            let (before, after) = (take.position(t, m), filled.take().position(t, m));
            let bits = |p: Option<[f64; 3]>| p.map(|p| p.map(f64::to_bits));
            prop_assert_eq!(bits(before), bits(after));
        }
    }
}
