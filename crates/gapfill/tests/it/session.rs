//! What `auto` makes of other takes of the session.

use std::sync::Arc;

use gapfill::{Auto, AutoParams};
use mocap_core::{
    FillError, Filled, GapFiller, MarkerSet, Mask, Take,
    geometry::{add, distance},
};
use mocap_testkit::articulated_take;

/// The lower segment keeps two markers beside the target, so that where the target is depends on the pose of all.
const MARKERS: [usize; 7] = [0, 1, 2, 3, 4, 5, 6];
const TARGET: usize = 5;
const GAP: std::ops::Range<usize> = 50..110;

fn take(frames: usize, seed: u64) -> Take {
    articulated_take(frames, seed).select(&MARKERS).unwrap()
}

fn fill(truth: &Take, session: Vec<Arc<Take>>) -> Filled {
    let hidden =
        Mask::from_fn(truth.frames(), MARKERS.len(), |t, m| m == TARGET && GAP.contains(&t));
    let auto = Auto::new(AutoParams { session, ..AutoParams::default() }).unwrap();
    auto.fill(&truth.hide(&hidden).unwrap()).unwrap()
}

fn error_m(truth: &Take, filled: &Filled) -> f64 {
    let at = |t: usize| {
        let found = filled.take().position(t, TARGET).unwrap();
        distance(found, truth.position(t, TARGET).unwrap())
    };
    GAP.map(at).sum::<f64>() / GAP.len() as f64
}

/// Mean errors over takes without and with the session that `of` makes of a longer take.
fn errors_m(of: impl Fn(Take) -> Take) -> (f64, f64) {
    let of_seed = |seed: u64| {
        let truth = take(150, seed);
        let session = vec![Arc::new(of(take(500, 1000 + seed)))];
        let (alone, with) = (fill(&truth, Vec::new()), fill(&truth, session));
        assert_eq!(with.take().frames(), truth.frames());
        (error_m(&truth, &alone), error_m(&truth, &with))
    };
    let all: Vec<(f64, f64)> = (0..6).map(of_seed).collect();
    (all.iter().map(|e| e.0).sum::<f64>() / 6.0, all.iter().map(|e| e.1).sum::<f64>() / 6.0)
}

#[test]
fn other_takes_of_the_session_help() {
    let (alone, with) = errors_m(|take| take);
    assert!(with < 0.7 * alone, "{with} m with the session, {alone} m without");
}

/// Somebody stuck the marker elsewhere in between: what the session says is not believed.
#[test]
fn a_marker_that_was_moved_between_takes_does_no_harm() {
    let moved = |take: Take| {
        let aside = |_: usize, m: usize, p: [f64; 3]| {
            if m == TARGET { add(p, [0.03, -0.02, 0.04]) } else { p }
        };
        take.map_positions(aside).unwrap()
    };
    let (alone, with) = errors_m(moved);
    assert!(with < 1.1 * alone, "{with} m with the session, {alone} m without");
}

#[test]
fn markers_go_by_their_names_and_others_are_left_out() {
    let truth = take(150, 3);
    let other = take(500, 1003);
    let order = [6, 3, 5, 0, 4, 2, 1];
    let shuffled = other.select(&order).unwrap();
    let names = order.map(|m| format!("Ann:{}", other.markers().name(m)));
    let named = Take::from_positions(
        MarkerSet::new(names).unwrap(),
        other.rate_hz(),
        shuffled.positions().to_owned(),
    );
    let of = |session: Take| fill(&truth, vec![Arc::new(session)]);
    assert_eq!(of(other).take().positions(), of(named.unwrap()).take().positions());

    let strangers = MarkerSet::new((0..7).map(|m| format!("X{m}"))).unwrap();
    let stranger =
        Take::from_positions(strangers, truth.rate_hz(), take(500, 1003).positions().to_owned());
    let alone = fill(&truth, Vec::new());
    assert_eq!(of(stranger.unwrap()).take().positions(), alone.take().positions());
}

#[test]
fn another_sampling_rate_is_refused_by_name() {
    let truth = take(150, 3);
    let markers = Arc::clone(truth.markers());
    let slow = Take::from_positions(markers, 50.0, truth.positions().to_owned()).unwrap();
    let session = vec![Arc::new(slow)];
    let auto = Auto::new(AutoParams { session, ..AutoParams::default() }).unwrap();
    let hidden = Mask::from_fn(150, 7, |t, m| m == TARGET && GAP.contains(&t));
    let error = auto.fill(&truth.hide(&hidden).unwrap()).unwrap_err();
    assert!(matches!(error, FillError::Parameter { field: "session", .. }), "{error}");
}
