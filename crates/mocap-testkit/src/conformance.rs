use std::ops::ControlFlow;

use mocap_core::{
    CellState, FillError, Filled, GapFiller, Holdout, Mask, Refusal, RigidTransform, Rotation,
    Take, Termination,
};

use crate::takes::{articulated_take, with_gaps};

/// What a filler promises beyond the contract of [`GapFiller`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Claims {
    /// Largest difference in metres when the whole take is moved rigidly; `None`: not claimed.
    pub rigid_motion_m: Option<f64>,
    /// Largest difference in metres when the markers come in another order; `None`: not claimed.
    pub permutation_m: Option<f64>,
}

const SEED: u64 = 20;

/// Checks a filler against the contract of [`GapFiller`] and its own claims.
///
/// # Panics
/// With the broken rule, if there is one.
pub fn conformance(filler: &dyn GapFiller, claims: &Claims) {
    let holdout = with_gaps(articulated_take(120, SEED), SEED, 4, 3..=11);
    let filled = fill(filler, holdout.visible());
    check_observed(holdout.visible(), &filled);
    check_accounted_for(&filled);
    check_deterministic(filler, holdout.visible(), &filled);
    check_identity(filler, holdout.truth());
    check_never_seen(filler, holdout.truth());
    check_degenerate(filler, holdout.truth());
    check_stops(filler, holdout.visible());
    if let Some(tolerance_m) = claims.permutation_m {
        check_permutation(filler, &holdout, &filled, tolerance_m);
    }
    if let Some(tolerance_m) = claims.rigid_motion_m {
        check_rigid_motion(filler, holdout.visible(), &filled, tolerance_m);
    }
}

fn fill(filler: &dyn GapFiller, take: &Take) -> Filled {
    match filler.fill(take) {
        Ok(filled) => filled,
        Err(error) => panic!("{} refuses a plain take: {error}", filler.name()),
    }
}

fn check_observed(input: &Take, filled: &Filled) {
    let same = input.observed().iter().all(|(t, m)| {
        let bits = |take: &Take| take.position(t, m).map(|p| p.map(f64::to_bits));
        bits(input) == bits(filled.take())
    });
    assert!(same, "an observed sample was altered");
}

/// Every cell of a gap is filled and finite, or its gap is refused with a reason.
fn check_accounted_for(filled: &Filled) {
    for gap in filled.gaps() {
        let refused = filled.report().refusals.iter().any(|r| r.gap == gap);
        for t in gap.frames.clone() {
            let is_filled = filled.state(t, gap.marker) == CellState::Filled;
            assert!(is_filled != refused, "gap {gap:?}: filled {is_filled}, refused {refused}");
        }
    }
    assert!(filled.filled_cells().count() > 0, "nothing was filled in a plain take");
}

fn check_deterministic(filler: &dyn GapFiller, input: &Take, first: &Filled) {
    let second = fill(filler, input);
    assert!(first.take().bit_eq(second.take()), "two runs differ");
    assert_eq!(first.report(), second.report(), "the reports of two runs differ");
}

fn check_identity(filler: &dyn GapFiller, complete: &Take) {
    let filled = fill(filler, complete);
    assert!(filled.take().bit_eq(complete), "a take without gaps was altered");
    assert_eq!(filled.report().termination, Termination::NothingToFill);
}

fn check_never_seen(filler: &dyn GapFiller, complete: &Take) {
    let ghost = complete.marker_count() - 1;
    let hidden = Mask::from_fn(complete.frames(), complete.marker_count(), |t, m| {
        m == ghost || (m == 0 && (40..50).contains(&t))
    });
    let filled = fill(filler, &visible(complete, &hidden));
    for t in 0..complete.frames() {
        assert_eq!(filled.state(t, ghost), CellState::Missing, "a never-seen marker was filled");
    }
    let said = filled.report().refusals.iter().any(|r| r.reason == Refusal::NeverSeen);
    assert!(said, "a never-seen marker is not listed as refused");
    assert_eq!(filled.state(45, 0), CellState::Filled, "a never-seen marker spoils the others");
}

/// Takes that leave nothing to work with give an error or open gaps, and never a panic.
fn check_degenerate(filler: &dyn GapFiller, complete: &Take) {
    let (frames, markers) = (complete.frames(), complete.marker_count());
    match filler.fill(&visible(complete, &Mask::all(frames, markers))) {
        Err(FillError::NothingObserved | FillError::TooFewFrames { .. }) => {}
        Err(error) => panic!("a take without any sample gives `{error}`"),
        Ok(_) => panic!("a take without any sample was filled"),
    }
    let one = Take::new(
        std::sync::Arc::clone(complete.markers()),
        complete.rate_hz(),
        complete.positions().slice(ndarray::s![..1, .., ..]).to_owned(),
        Mask::from_fn(1, markers, |_, m| m > 0),
    );
    let Ok(one) = one else { panic!("the one-frame take is no take") };
    match filler.fill(&one) {
        Err(FillError::TooFewFrames { frames: 1, .. }) => {}
        Err(error) => panic!("a one-frame take gives `{error}`"),
        Ok(filled) => assert_eq!(filled.state(0, 0), CellState::Missing),
    }
}

/// An observer that stops at once still gets a fill, which says that it was stopped.
fn check_stops(filler: &dyn GapFiller, input: &Take) {
    let mut calls = 0;
    let stopped = filler.fill_observed(input, &mut |_| {
        calls += 1;
        ControlFlow::Break(())
    });
    let Ok(stopped) = stopped else { panic!("stopping is an error") };
    check_observed(input, &stopped);
    if calls > 0 {
        assert_eq!(calls, 1, "the observer's break was ignored");
        assert_eq!(stopped.report().termination, Termination::Stopped);
    }
}

fn check_permutation(filler: &dyn GapFiller, holdout: &Holdout, filled: &Filled, tolerance_m: f64) {
    let markers = holdout.visible().marker_count();
    let order: Vec<usize> = (0..markers).rev().collect();
    let Ok(permuted) = holdout.visible().select(&order) else { panic!("no permutation") };
    let other = fill(filler, &permuted);
    let difference =
        largest_difference(filled.take(), |t, m| other.take().position(t, markers - 1 - m));
    assert!(difference <= tolerance_m, "another order of markers moves a fill by {difference} m");
}

fn check_rigid_motion(filler: &dyn GapFiller, input: &Take, filled: &Filled, tolerance_m: f64) {
    let moved = RigidTransform {
        rotation: Rotation::about([0.0, 0.0, 1.0], 0.7),
        translation: [1.5, -0.8, 0.0],
    };
    let Ok(input) = input.map_positions(|_, _, p| moved.apply(p)) else { panic!("no rotation") };
    let other = fill(filler, &input);
    let difference = largest_difference(filled.take(), |t, m| {
        other.take().position(t, m).map(|p| moved.undo(p))
    });
    assert!(difference <= tolerance_m, "a rigid motion moves a fill by {difference} m");
}

fn largest_difference(take: &Take, other: impl Fn(usize, usize) -> Option<[f64; 3]>) -> f64 {
    let mut largest = 0.0_f64;
    for (t, m) in take.observed().iter() {
        let (Some(p), Some(q)) = (take.position(t, m), other(t, m)) else {
            panic!("the two fills differ in what they leave open")
        };
        largest = largest.max(mocap_core::geometry::distance(p, q));
    }
    largest
}

fn visible(complete: &Take, hidden: &Mask) -> Take {
    match complete.hide(hidden) {
        Ok(take) => take,
        Err(error) => panic!("cannot hide cells: {error}"),
    }
}
