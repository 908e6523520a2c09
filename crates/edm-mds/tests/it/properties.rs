//! What holds for any take.

use edm_mds::{Edm, EdmParams, EdmSolver};
use mocap_core::{GapFiller, Mask, RigidTransform, Rotation, Take, geometry::distance};
use mocap_testkit::{Claims, articulated_take, conformance, rigid_take, with_gaps};
use proptest::prelude::*;

/// Rounding in eigenproblems whose gaps are no smaller than the markers are flat.
const CLAIMS: Claims = Claims { rigid_motion_m: Some(1e-9), permutation_m: Some(1e-12) };

fn solvers() -> [Edm; 2] {
    [EdmSolver::Scaling, EdmSolver::Trilateration]
        .map(|solver| Edm::new(EdmParams { solver, ..EdmParams::default() }).unwrap())
}

#[test]
fn conforms() {
    for filler in solvers() {
        conformance(&filler, &CLAIMS);
    }
}

fn largest_difference(a: &Take, b: &Take, map: impl Fn([f64; 3]) -> [f64; 3]) -> f64 {
    assert_eq!(a.observed(), b.observed());
    let differences = a
        .observed()
        .iter()
        .map(|(t, m)| distance(map(a.position(t, m).unwrap()), b.position(t, m).unwrap()));
    differences.fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_fill_moves_with_the_take(
        seed in 0..1000_u64,
        axis in prop::array::uniform3(-1.0..1.0_f64),
        angle in -3.0..3.0_f64,
        translation in prop::array::uniform3(-5.0..5.0_f64),
    ) {
        let visible = with_gaps(articulated_take(150, seed), seed, 5, 1..=60);
        let motion = RigidTransform { rotation: Rotation::about(axis, angle), translation };
        let moved = visible.visible().map_positions(|_, _, p| motion.apply(p)).unwrap();
        // Where interpolated distances come close to those of a flat body, scaling takes the root of an
        // eigenvalue near zero, which makes 1e-8 of a rounding of 1e-16.
        for (filler, bar_m) in solvers().into_iter().zip([1e-7, 1e-9]) {
            let (here, there) =
                (filler.fill(visible.visible()).unwrap(), filler.fill(&moved).unwrap());
            let difference = largest_difference(here.take(), there.take(), |p| motion.apply(p));
            prop_assert!(difference < bar_m, "{difference}");
        }
    }

    #[test]
    fn a_rigid_body_is_recovered(
        seed in 0..1000_u64,
        markers in 5..9_usize,
        start in 0..150_usize,
        length in 1..150_usize,
    ) {
        let truth = rigid_take(markers, 200, seed);
        let hidden = Mask::from_fn(200, markers, |t, m| m == 0 && (start..start + length).contains(&t));
        prop_assume!(hidden.count() <= 190);
        for filler in solvers() {
            let filled = filler.fill(&truth.hide(&hidden).unwrap()).unwrap();
            // Four markers or more drawn at random may come close to a line, which costs digits.
            prop_assert!(largest_difference(&truth, filled.take(), |p| p) < 1e-8);
        }
    }

    /// Any pattern of visibility gives finite samples or refusals, never a panic.
    #[test]
    fn any_mask_is_accounted_for(
        seed in 0..1000_u64,
        share in 0.05..0.95_f64,
        run in 1..40_usize,
    ) {
        let truth = articulated_take(160, seed);
        // Runs of `run` frames hidden or seen by a fixed hash of marker and run.
        let hidden = Mask::from_fn(160, 8, |t, m| {
            let hash = (seed + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15)
                ^ ((t / run * 8 + m) as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
            ((hash ^ hash >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f64
                / f64::from(1 << 24) < share
        });
        let visible = truth.hide(&hidden).unwrap();
        prop_assume!(visible.observed().count() > 0);
        for filler in solvers() {
            let filled = filler.fill(&visible).unwrap();
            for gap in filled.gaps() {
                let refused = filled.report().refusals.iter().any(|r| r.gap == gap);
                for t in gap.frames.clone() {
                    prop_assert!(filled.take().is_observed(t, gap.marker) != refused);
                }
            }
        }
    }
}
