//! One fault of each kind, injected where it can be named.

use augment::swap_pair;
use marker_faults::{Fault, FaultDetector, FaultKind, FaultParams};
use mocap_core::{MarkerSet, Mask, Take, geometry::add};
use mocap_testkit::articulated_take;
use ndarray::Array3;

fn detect(take: &Take) -> Vec<Fault> {
    FaultDetector::default().detect(take).list().to_vec()
}

/// Adds an offset to one marker in some frames.
fn shifted(take: &Take, marker: usize, frames: std::ops::Range<usize>, offset: [f64; 3]) -> Take {
    let moved =
        |t: usize, m: usize, p| if m == marker && frames.contains(&t) { add(p, offset) } else { p };
    take.map_positions(moved).unwrap()
}

fn hidden(take: &Take, marker: usize, frames: std::ops::Range<usize>) -> Take {
    let mask = Mask::from_fn(take.frames(), take.marker_count(), |t, m| {
        m == marker && frames.contains(&t)
    });
    take.hide(&mask).unwrap()
}

fn kinds(faults: &[Fault]) -> Vec<(usize, std::ops::Range<usize>, FaultKind)> {
    faults.iter().map(|fault| (fault.marker, fault.frames.clone(), fault.kind)).collect()
}

#[test]
fn a_clean_take_has_no_faults() {
    for seed in 0..20 {
        assert_eq!(detect(&articulated_take(400, seed)), []);
    }
}

#[test]
fn spikes_of_one_to_three_frames() {
    for length in 1..=3 {
        let take = shifted(&articulated_take(300, 2), 5, 100..100 + length, [0.02, -0.02, 0.015]);
        let faults = detect(&take);
        assert_eq!(kinds(&faults), [(5, 100..100 + length, FaultKind::Spike)], "{length}");
        assert!(faults[0].size_m > faults[0].limit_m);
    }
}

#[test]
fn a_jump_away_and_back() {
    for length in [4, 7, 20, 60] {
        let take = shifted(&articulated_take(300, 3), 1, 120..120 + length, [0.0, 0.04, 0.0]);
        let faults = detect(&take);
        assert_eq!(kinds(&faults), [(1, 120..120 + length, FaultKind::Jump)], "{length}");
        // White noise of 0.1 mm, which the parabola through three samples makes four times as large.
        assert!((faults[0].size_m - 0.04).abs() < 0.004);
    }
}

#[test]
fn swaps_of_any_length() {
    for length in [1, 2, 3, 4, 10, 90, 140] {
        let take = swap_pair(&articulated_take(300, 4), 1, 2, 80..80 + length).unwrap();
        let expected = [
            (1, 80..80 + length, FaultKind::Swap { with: 2 }),
            (2, 80..80 + length, FaultKind::Swap { with: 1 }),
        ];
        assert_eq!(kinds(&detect(&take)), expected, "{length}");
    }
}

/// Labels that stay exchanged to the end: the distances to the others tell which part is wrong.
#[test]
fn a_swap_without_a_way_back() {
    for frames in [200..300, 0..100] {
        let take = swap_pair(&articulated_take(300, 4), 0, 3, frames.clone()).unwrap();
        let expected = [
            (0, frames.clone(), FaultKind::Swap { with: 3 }),
            (3, frames, FaultKind::Swap { with: 0 }),
        ];
        assert_eq!(kinds(&detect(&take)), expected);
    }
}

#[test]
fn junk_beside_a_gap() {
    let take = hidden(&articulated_take(300, 6), 2, 100..130);
    assert_eq!(detect(&take), []);
    let after = shifted(&take, 2, 130..133, [0.05, 0.0, 0.0]);
    assert_eq!(kinds(&detect(&after)), [(2, 130..133, FaultKind::GapEdge)]);
    let before = shifted(&take, 2, 98..100, [0.0, 0.0, -0.05]);
    assert_eq!(kinds(&detect(&before)), [(2, 98..100, FaultKind::GapEdge)]);
}

/// A run between two gaps that belongs to something else.
#[test]
fn a_misplaced_run() {
    let take = hidden(&hidden(&articulated_take(400, 7), 1, 100..120), 1, 180..210);
    assert_eq!(detect(&take), []);
    let take = shifted(&take, 1, 120..180, [0.3, 0.3, 0.0]);
    assert_eq!(kinds(&detect(&take)), [(1, 120..180, FaultKind::Misplaced)]);
}

/// A ninth marker that stands still while the eight of the body move by half a metre.
#[test]
fn a_ghost() {
    let body = articulated_take(600, 8);
    let xyz = Array3::from_shape_fn((600, 9, 3), |(t, m, a)| {
        if m < 8 { body.positions()[(t, m, a)] } else { 1.0 + 1e-4 * (t % 3) as f64 }
    });
    let names = MarkerSet::new((0..9).map(|m| format!("M{m}"))).unwrap();
    let take = Take::from_positions(names, 120.0, xyz).unwrap();
    assert_eq!(kinds(&detect(&take)), [(8, 0..600, FaultKind::Ghost)]);
}

/// A frame in which the whole body is elsewhere is no marker's fault.
#[test]
fn a_shift_of_everything_blames_no_marker() {
    let take = articulated_take(300, 9);
    let moved = |t: usize, _: usize, p| if t == 150 { add(p, [0.1, 0.0, 0.0]) } else { p };
    assert_eq!(detect(&take.map_positions(moved).unwrap()), []);
}

/// Limits are lengths and accelerations: at 30 Hz a centimetre within a frame is nothing, at 240 Hz three are much.
#[test]
fn limits_do_not_depend_on_the_rate() {
    let params = FaultParams::default();
    let spike = |rate_hz: f64, size: f64| {
        let names = MarkerSet::new(["A"]).unwrap();
        let xyz = Array3::from_shape_fn((90, 1, 3), |(t, _, a)| {
            let s = t as f64 / rate_hz;
            if t == 40 && a == 0 { size + s } else { s }
        });
        let take = Take::from_positions(names, rate_hz, xyz).unwrap();
        FaultDetector::new(params).unwrap().detect(&take).list().len()
    };
    assert_eq!([spike(120.0, 0.03), spike(240.0, 0.03), spike(1000.0, 0.03)], [1, 1, 1]);
    // 0.03 m within 1 / 30 s are 27 m/s², which a limb can do.
    assert_eq!([spike(30.0, 0.03), spike(30.0, 0.2)], [0, 1]);
}

#[test]
fn hiding_alters_nothing_else() {
    let take = shifted(&articulated_take(300, 2), 5, 100..102, [0.02, -0.02, 0.015]);
    let faults = FaultDetector::default().detect(&take);
    let left = faults.hide(&take).unwrap();
    assert_eq!(faults.mask().count(), 2);
    for (t, m) in take.observed().iter() {
        let bits = |take: &Take| take.position(t, m).map(|p| p.map(f64::to_bits));
        assert_eq!(bits(&left), if faults.mask().contains(t, m) { None } else { bits(&take) });
    }
    assert!(faults.hide(&articulated_take(200, 2)).is_err(), "another take");
}

#[test]
fn parameters_out_of_range_are_named() {
    let default = FaultParams::default();
    for (name, params) in [
        ("size_m", FaultParams { size_m: 0.0, ..default }),
        ("step_m", FaultParams { step_m: f64::NAN, ..default }),
        ("acceleration", FaultParams { acceleration: -1.0, ..default }),
        ("longest_jump_s", FaultParams { longest_jump_s: f64::INFINITY, ..default }),
        ("edge_s", FaultParams { edge_s: 0.0, ..default }),
        ("still_m", FaultParams { still_m: 0.0, ..default }),
        ("strange_m", FaultParams { strange_m: 0.0, ..default }),
        ("delta", FaultParams { delta: 0.0, ..default }),
        ("slack_m", FaultParams { slack_m: 0.0, ..default }),
    ] {
        assert_eq!(FaultDetector::new(params).unwrap_err().field, name);
    }
}
