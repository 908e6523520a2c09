//! What holds for any take.

use marker_faults::FaultDetector;
use mocap_core::{MarkerSet, Mask, RigidTransform, Rotation, Take};
use mocap_testkit::articulated_take;
use ndarray::Array3;
use proptest::prelude::*;

#[test]
fn takes_with_nothing_in_them() {
    for (frames, markers) in [(0, 0), (0, 3), (1, 3), (5, 1), (40, 2)] {
        let names = MarkerSet::new((0..markers).map(|m| format!("M{m}"))).unwrap();
        for hole in [f64::NAN, 0.5] {
            let xyz = Array3::from_elem((frames, markers, 3), hole);
            let take = Take::from_positions(names.clone(), 100.0, xyz).unwrap();
            assert_eq!(FaultDetector::default().detect(&take).list(), []);
        }
    }
}

/// Shifts of single samples by 5 cm, one in `1 / share`.
fn spoilt(seed: u64, share: f64) -> (Take, usize) {
    let take = articulated_take(240, seed);
    let hash = |t: usize, m: usize| {
        let x = (seed + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15)
            ^ ((t * 8 + m) as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
        ((x ^ x >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f64 / f64::from(1 << 24)
    };
    let inside = |t: usize| (5..235).contains(&t);
    let mut count = 0;
    let moved = take.map_positions(|t, m, p| {
        if !inside(t) || hash(t, m) >= share {
            return p;
        }
        count += 1;
        let turn = 6.0 * hash(t, m) / share;
        [p[0] + 0.05 * turn.cos(), p[1] + 0.05 * turn.sin(), p[2]]
    });
    (moved.unwrap(), count)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Up to one sample in fifty. What is missed, and what is blamed instead, stands next to other shifts by the same offset: of
    /// 3000 draws the worst missed 2 of 15 and blamed 4 beside 48.
    #[test]
    fn scattered_shifts_are_found(seed in 0..1000_u64, share in 0.002..0.02_f64) {
        let (take, count) = spoilt(seed, share);
        let (clean, faults) = (articulated_take(240, seed), FaultDetector::default().detect(&take));
        let is_moved = |(t, m): &(usize, usize)| take.position(*t, *m) != clean.position(*t, *m);
        let found = faults.mask().iter().filter(is_moved).count();
        let alarms = faults.mask().count() - found;
        prop_assert!(found as f64 >= 0.9 * count as f64 - 1.0, "{found} of {count}");
        prop_assert!(alarms as f64 <= 2.0 + 0.1 * count as f64, "{alarms} alarms, {count} shifts");
    }

    /// Where the origin lies and where the axes point does not matter, up to limits that rounding may cross.
    #[test]
    fn faults_move_with_the_take(
        seed in 0..1000_u64,
        angle in -3.0..3.0_f64,
        translation in prop::array::uniform3(-5.0..5.0_f64),
    ) {
        let (take, _) = spoilt(seed, 0.01);
        let motion = RigidTransform { rotation: Rotation::about([0.0, 0.0, 1.0], angle), translation };
        let moved = take.map_positions(|_, _, p| motion.apply(p)).unwrap();
        let detector = FaultDetector::default();
        let (here, there) = (detector.detect(&take), detector.detect(&moved));
        // The middle deviation is taken axis by axis, which other axes change a little.
        prop_assert_eq!(here.mask(), there.mask());
    }

    /// Any pattern of visibility, any scatter: faults lie in the take, on observed samples, and twice the same.
    #[test]
    fn any_take_is_looked_at(seed in 0..1000_u64, share in 0.0..1.0_f64, run in 1..30_usize, scatter in 0.0..0.5_f64) {
        let (take, _) = spoilt(seed, 0.05);
        let draw = |t: usize, m: usize| {
            let x = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ ((t * 8 + m) as u64 + 7).wrapping_mul(0xD6E8_FEB8_6659_FD93);
            ((x ^ x >> 32).wrapping_mul(0xD6E8_FEB8_6659_FD93) >> 40) as f64 / f64::from(1 << 24)
        };
        let mask = Mask::from_fn(240, 8, |t, m| draw(t / run, m) < share);
        let noisy = take.map_positions(|t, m, p| p.map(|c| c + scatter * (draw(t, m) - 0.5))).unwrap();
        let visible = noisy.hide(&mask).unwrap();
        let detector = FaultDetector::default();
        let faults = detector.detect(&visible);
        prop_assert_eq!(&faults, &detector.detect(&visible));
        for fault in faults.list() {
            prop_assert!(fault.marker < 8 && fault.frames.start < fault.frames.end && fault.frames.end <= 240);
            prop_assert!(fault.size_m.is_finite());
        }
        prop_assert!(faults.mask().iter().all(|(t, m)| visible.is_observed(t, m)));
    }
}
