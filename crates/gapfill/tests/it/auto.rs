//! What `auto` promises beyond the contract that every filler keeps.

use gapfill::{Auto, AutoParams, Edges};
use mocap_core::{
    FillError, GapFiller, Mask, Refusal, RigidTransform, Rotation, Take, geometry::distance,
};
use mocap_testkit::{articulated_take, rigid_take};

fn auto(max_error_m: Option<f64>) -> Auto {
    Auto::new(AutoParams { max_error_m, ..AutoParams::default() }).unwrap()
}

/// One marker missing in frames 60 to 89.
fn gapped(take: &Take) -> Take {
    let hidden =
        Mask::from_fn(take.frames(), take.marker_count(), |t, m| m == 1 && (60..90).contains(&t));
    take.hide(&hidden).unwrap()
}

#[test]
fn a_rigid_body_is_recovered() {
    let truth = rigid_take(8, 150, 4);
    let filled = auto(None).fill(&gapped(&truth)).unwrap();
    for t in 60..90 {
        let found = filled.take().position(t, 1).unwrap();
        assert!(distance(found, truth.position(t, 1).unwrap()) < 1e-9, "frame {t}");
    }
}

#[test]
fn fills_move_with_the_take() {
    let take = gapped(&articulated_take(150, 4));
    let motion = RigidTransform {
        rotation: Rotation::about([0.3, -0.5, 1.0], 1.1),
        translation: [2.0, -1.0, 0.5],
    };
    let moved = take.map_positions(|_, _, p| motion.apply(p)).unwrap();
    let (here, there) = (auto(None).fill(&take).unwrap(), auto(None).fill(&moved).unwrap());
    for t in 60..90 {
        let back = motion.undo(there.take().position(t, 1).unwrap());
        assert!(distance(here.take().position(t, 1).unwrap(), back) < 1e-9, "frame {t}");
    }
}

#[test]
fn what_is_too_uncertain_stays_open_and_says_so() {
    let take = gapped(&articulated_take(150, 4));
    let filled = auto(Some(1e-12)).fill(&take).unwrap();
    let refused = &filled.report().refusals;
    assert!(
        matches!(refused[..], [ref r] if matches!(r.reason, Refusal::TooUncertain { .. })),
        "{refused:?}"
    );
    assert!(filled.take().position(70, 1).is_none());
    let generous = auto(Some(10.0)).fill(&take).unwrap();
    let choice = &generous.report().choices[0];
    let sum: f64 = choice.shares.iter().map(|(_, share)| share).sum();
    assert!((sum - 1.0).abs() < 1e-9 && choice.expected_m.is_some());
    assert!((60..90).all(|t| generous.sigma_m(t, 1).is_some()));
}

#[test]
fn a_limit_out_of_range_is_named() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let params = AutoParams { max_error_m: Some(value), ..AutoParams::default() };
        let error = Auto::new(params).map(|_| ()).unwrap_err();
        assert!(matches!(error, FillError::Parameter { field: "max_error_m", .. }));
    }
}

/// What a body does before anybody sees it nobody can know; a user who wants it filled may say so.
#[test]
fn ends_without_any_marker_stay_open_unless_asked() {
    let truth = articulated_take(200, 4);
    let dark = |t: usize, m: usize| t < 30 || (m == 2 && t < 50) || (m == 5 && t > 190);
    let take = truth.hide(&Mask::from_fn(200, 8, dark)).unwrap();
    let filled = auto(None).fill(&take).unwrap();
    let refused: Vec<usize> = filled.report().refusals.iter().map(|r| r.gap.marker).collect();
    assert_eq!(refused, (0..8).collect::<Vec<_>>());
    assert!(filled.report().refusals.iter().all(|r| r.reason == Refusal::OneSided));
    assert!(filled.take().position(195, 5).is_some(), "its neighbours are seen");
    let params = AutoParams { edges: Edges::Hold, ..AutoParams::default() };
    let held = Auto::new(params).unwrap().fill(&take).unwrap();
    assert!(held.report().refusals.is_empty() && held.take().position(0, 0).is_some());
}

/// A body of giants, so that what is off by centimetres is off by metres.
#[test]
fn fills_that_are_off_by_metres_are_refused_unasked() {
    let giant = articulated_take(200, 4).map_positions(|_, _, p| p.map(|c| 300.0 * c)).unwrap();
    let hidden = Mask::from_fn(200, 8, |t, m| m > 3 && (60..150).contains(&t));
    let take = giant.hide(&hidden).unwrap();
    let filled = auto(None).fill(&take).unwrap();
    let refused = &filled.report().refusals;
    assert!(!refused.is_empty());
    for refused in refused {
        let Refusal::TooUncertain { expected_m, limit_m } = refused.reason else {
            panic!("{:?}", refused.reason)
        };
        assert!(expected_m > limit_m && (limit_m - 1.0).abs() < 1e-12);
    }
    assert!(auto(Some(1e6)).fill(&take).unwrap().report().refusals.is_empty());
}
