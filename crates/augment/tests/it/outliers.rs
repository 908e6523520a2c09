use augment::{
    AugmentError, ShiftModel, ShiftParams, SwapParams, shift_markers, swap_markers, swap_pair,
};
use proptest::prelude::*;

use crate::{take, take_seen};

#[test]
fn shifts_are_as_many_as_the_models_say() {
    let take = take(20_000, 10);
    let count = |model| {
        let params = ShiftParams { model, ..ShiftParams::default() };
        shift_markers(&take, &params).unwrap().shifts.len() as f64 / 200_000.0
    };
    // 200 000 trials of 1 %: a standard error of 0.02 %; five of them.
    assert!((count(ShiftModel::Fixed { probability: 0.01 }) - 0.01).abs() < 0.001);
    // E min(|z|, 2) = 0.781; whole frames share their probability, so the error is larger.
    assert!((count(ShiftModel::PerFrame { deviation: 0.05 }) / 0.05 - 0.781).abs() < 0.04);
    assert_eq!(count(ShiftModel::Fixed { probability: 0.0 }), 0.0);
    assert_eq!(count(ShiftModel::Fixed { probability: 1.0 }), 1.0);
}

#[test]
fn offsets_fill_their_range() {
    let model = ShiftModel::Fixed { probability: 1.0 };
    let params = ShiftParams { model, range_m: 0.02, seed: 3 };
    let shifts = shift_markers(&take(4000, 5), &params).unwrap().shifts;
    let all: Vec<f64> = shifts.iter().flat_map(|shift| shift.offset_m).collect();
    assert!(all.iter().all(|x| x.abs() <= 0.02));
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let square = all.iter().map(|x| x * x).sum::<f64>() / all.len() as f64;
    // Uniform on ±β: mean 0, variance β²/3; 60 000 draws are good for 1 %.
    assert!(mean.abs() < 2e-4 && (square / (0.02 * 0.02 / 3.0) - 1.0).abs() < 0.03);
}

#[test]
fn a_swap_carries_gaps_along() {
    let before = take_seen(10, 3, |t, m| m != 1 || t != 4);
    let after = swap_pair(&before, 0, 1, 3..6).unwrap();
    assert_eq!(after.position(4, 0), None);
    assert_eq!(after.position(4, 1), before.position(4, 0));
    assert_eq!(after.position(3, 0), before.position(3, 1));
    assert_eq!(after.position(2, 0), before.position(2, 0));
    assert_eq!(after.position(4, 2), before.position(4, 2));
}

#[test]
fn swaps_are_between_near_markers() {
    let params = SwapParams { count: 30, reach: 1, longest_frames: 20, ..SwapParams::default() };
    let swapped = swap_markers(&take(2000, 10), &params).unwrap();
    assert_eq!(swapped.swaps.len(), 30);
    assert!(swapped.swaps.iter().all(|swap| swap.markers.1 - swap.markers.0 == 1));
    assert!(swapped.swaps.iter().all(|swap| (1..=20).contains(&swap.frames.len())));
}

#[test]
fn swaps_that_find_no_room_are_left_out() {
    let params = SwapParams { count: 9, shortest_frames: 4, ..SwapParams::default() };
    assert_eq!(swap_markers(&take(4, 2), &params).unwrap().swaps.len(), 1);
    let unseen = take_seen(9, 3, |_, _| false);
    assert_eq!(swap_markers(&unseen, &SwapParams::default()).unwrap().swaps, []);
    // Only swaps that reach the one frame in which something is seen change anything.
    let glimpse = take_seen(12, 4, |t, _| t == 0);
    let params = SwapParams { count: 2, longest_frames: 3, ..SwapParams::default() };
    let swaps = swap_markers(&glimpse, &params).unwrap().swaps;
    assert!(!swaps.is_empty() && swaps.iter().all(|swap| swap.frames.start == 0));
}

#[test]
fn outliers_refuse_what_makes_no_sense() {
    let good = take(9, 2);
    let params =
        ShiftParams { model: ShiftModel::Fixed { probability: 1.1 }, ..Default::default() };
    let refused = shift_markers(&good, &params).unwrap_err();
    assert!(matches!(refused, AugmentError::OutOfRange { name: "probability", .. }));
    let params = ShiftParams { range_m: f64::NAN, ..Default::default() };
    let refused = shift_markers(&good, &params).unwrap_err();
    assert!(matches!(refused, AugmentError::OutOfRange { name: "range_m", .. }));
    let empty = AugmentError::EmptyTake { frames: 0, markers: 2 };
    assert_eq!(shift_markers(&take(0, 2), &ShiftParams::default()).unwrap_err(), empty);
    assert_eq!(swap_markers(&take(0, 2), &SwapParams::default()).unwrap_err(), empty);
    let one = swap_markers(&take(9, 1), &SwapParams::default()).unwrap_err();
    assert_eq!(one, AugmentError::MarkerCount { wanted: 2, found: 1 });
    let long = SwapParams { shortest_frames: 10, ..SwapParams::default() };
    assert!(matches!(swap_markers(&good, &long), Err(AugmentError::OutOfRange { .. })));
    assert_eq!(swap_pair(&good, 1, 1, 0..2).unwrap_err(), AugmentError::SelfSwap { marker: 1 });
    let outside = AugmentError::Segment { start: 8, end: 10, frames: 9 };
    assert_eq!(swap_pair(&good, 0, 1, 8..10).unwrap_err(), outside);
    assert!(matches!(swap_pair(&good, 0, 2, 0..2), Err(AugmentError::Core(_))));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn the_list_of_shifts_is_all_that_changed(seed in any::<u64>(), probability in 0.0..0.5_f64) {
        let before = take_seen(60, 4, |t, m| (t + m) % 5 != 0);
        let params =
            ShiftParams { model: ShiftModel::Fixed { probability }, range_m: 0.05, seed };
        let shifted = shift_markers(&before, &params).unwrap();
        let mut expected = before.positions().to_owned();
        for shift in &shifted.shifts {
            for axis in 0..3 {
                expected[(shift.frame, shift.marker, axis)] += shift.offset_m[axis];
            }
        }
        let names = before.markers().clone();
        let expected = mocap_core::Take::from_positions(names, 120.0, expected).unwrap();
        prop_assert!(shifted.take.bit_eq(&expected));
        prop_assert!(shift_markers(&before, &params).unwrap().take.bit_eq(&shifted.take));
    }

    #[test]
    fn undoing_the_listed_swaps_gives_the_take_back(seed in any::<u64>(), count in 0..12_usize) {
        let before = take_seen(150, 5, |t, m| (t + 3 * m) % 11 != 0);
        let params = SwapParams { count, longest_frames: 40, seed, ..SwapParams::default() };
        let swapped = swap_markers(&before, &params).unwrap();
        prop_assert!(swapped.swaps.is_empty() || !swapped.take.bit_eq(&before));
        let undone = swapped.swaps.iter().fold(swapped.take.clone(), |take, swap| {
            swap_pair(&take, swap.markers.0, swap.markers.1, swap.frames.clone()).unwrap()
        });
        prop_assert!(undone.bit_eq(&before));
        prop_assert!(swap_markers(&before, &params).unwrap().take.bit_eq(&swapped.take));
    }
}
