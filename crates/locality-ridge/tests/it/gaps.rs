//! One gap of each kind.

use locality_ridge::{LocalRidge, LocalRidgeParams, Residual};
use mocap_core::{
    CellState, FillError, Filled, GapFiller, MarkerSet, Mask, Refusal, Rotation, Take,
    geometry::{add, distance, scale, sub},
};
use mocap_testkit::{articulated_take, rigid_take};
use ndarray::Array3;

/// Positions of a metre or two through a rotation and back, with a condition below 1e4.
const ROUNDING_M: f64 = 1e-10;

fn hide(take: &Take, hidden: impl Fn(usize, usize) -> bool) -> Take {
    take.hide(&Mask::from_fn(take.frames(), take.marker_count(), hidden)).unwrap()
}

fn fill(take: &Take) -> Filled {
    LocalRidge::default().fill(take).unwrap()
}

fn error(truth: &Take, filled: &Filled, t: usize, m: usize) -> f64 {
    distance(truth.position(t, m).unwrap(), filled.take().position(t, m).unwrap())
}

fn refusals(filled: &Filled) -> Vec<Refusal> {
    filled.report().refusals.iter().map(|r| r.reason).collect()
}

const SHAPE: [[f64; 3]; 5] =
    [[0.1, 0.0, 0.0], [0.0, 0.15, 0.0], [-0.1, 0.0, 0.05], [0.0, -0.1, 0.1], [0.05, 0.05, 0.2]];
const FRAMES: usize = 200;

fn pose(t: usize) -> (Rotation, [f64; 3]) {
    let x = t as f64 / 120.0;
    let turn = Rotation::about([0.2, 1.0, -0.4], 0.9 * (2.0 * x).sin());
    (turn, [x, (3.0 * x).cos(), 1.0])
}

/// How far the first marker has slid on the body, in body coordinates.
fn slide(t: usize) -> [f64; 3] {
    let x = t as f64 / 120.0;
    [0.02 * (4.0 * x).sin(), 0.01 * (5.0 * x).cos(), 0.0]
}

fn on_body(t: usize, m: usize, offset: [f64; 3]) -> [f64; 3] {
    let (turn, place) = pose(t);
    add(turn.apply(add(SHAPE[m], offset)), place)
}

/// A rigid body whose first marker slides.
fn sliding_take() -> Take {
    let xyz = Array3::from_shape_fn((FRAMES, SHAPE.len(), 3), |(t, m, a)| {
        on_body(t, m, if m == 0 { slide(t) } else { [0.0; 3] })[a]
    });
    let names = MarkerSet::new((0..SHAPE.len()).map(|m| format!("M{m}"))).unwrap();
    Take::from_positions(names, 120.0, xyz).unwrap()
}

/// Regressors that never move teach the mean, so that the whole slide is error at the borders and
/// the ramp has a closed form.
#[test]
fn a_ramp_carries_the_border_errors_exactly() {
    let filled = fill(&hide(&sliding_take(), |t, m| m == 0 && (60..110).contains(&t)));
    for t in 60..110 {
        let share = (t - 59) as f64 / 51.0;
        let slid = add(scale(1.0 - share, slide(59)), scale(share, slide(110)));
        let found = filled.take().position(t, 0).unwrap();
        assert!(distance(found, on_body(t, 0, slid)) < ROUNDING_M, "frame {t}");
    }
}

#[test]
fn one_border_is_carried_alone() {
    let filled = fill(&hide(&sliding_take(), |t, m| m == 0 && !(40..150).contains(&t)));
    for t in (0..40).chain(150..FRAMES) {
        let slid = slide(if t < 40 { 40 } else { 149 });
        let found = filled.take().position(t, 0).unwrap();
        assert!(distance(found, on_body(t, 0, slid)) < ROUNDING_M, "frame {t}");
    }
}

#[test]
fn an_exponential_kernel_fades_to_the_mean() {
    let residual = Residual::Exponential { tau_s: 0.05 };
    let filler =
        LocalRidge::new(LocalRidgeParams { residual, ..LocalRidgeParams::default() }).unwrap();
    let filled = filler.fill(&hide(&sliding_take(), |t, m| m == 0 && t < 100)).unwrap();
    let sum = (100..FRAMES).fold([0.0; 3], |sum, t| add(sum, slide(t)));
    let mean = scale(1.0 / 100.0, sum);
    for t in 0..100 {
        let weight = (-((100 - t) as f64) / 6.0).exp();
        let slid = add(mean, scale(weight, sub(slide(100), mean)));
        let found = filled.take().position(t, 0).unwrap();
        assert!(distance(found, on_body(t, 0, slid)) < ROUNDING_M, "frame {t}");
    }
}

/// The error of a fill starts at a border with what the regression's error changes in a frame:
/// white noise of 0.1 mm on the marker and its neighbours, seldom above 1 mm together.
#[test]
fn no_jump_at_the_borders() {
    let truth = articulated_take(400, 5);
    let visible = hide(&truth, |t, m| m == 2 && (100..200).contains(&t));
    let filled = fill(&visible);
    assert!(error(&truth, &filled, 100, 2) < 0.001);
    assert!(error(&truth, &filled, 199, 2) < 0.001);
}

#[test]
fn a_gap_may_leave_a_tenth_of_the_take() {
    let truth = rigid_take(6, 400, 3);
    let filled = fill(&hide(&truth, |t, m| m == 1 && t >= 40));
    assert!((40..400).all(|t| error(&truth, &filled, t, 1) < ROUNDING_M));
}

#[test]
fn markers_missing_together_are_learnt_from_the_others() {
    let truth = rigid_take(9, 200, 8);
    let filled = fill(&hide(&truth, |t, m| m < 4 && (50..120).contains(&t)));
    for m in 0..4 {
        let worst = (50..120).map(|t| error(&truth, &filled, t, m)).fold(0.0, f64::max);
        assert!(worst < ROUNDING_M, "marker {m}: {worst}");
    }
}

/// No neighbour is seen throughout: marker `m` hides for a third of the gap.
#[test]
fn neighbours_that_come_and_go_cut_the_gap() {
    let truth = rigid_take(10, 300, 4);
    let visible = hide(&truth, |t, m| match m {
        0 => (100..190).contains(&t),
        m => (100 + 30 * (m % 3)..130 + 30 * (m % 3)).contains(&t),
    });
    let filled = fill(&visible);
    assert!(refusals(&filled).is_empty());
    let worst = (100..190).map(|t| error(&truth, &filled, t, 0)).fold(0.0, f64::max);
    // Segments are joined by a cubic, which the curve leaves by so much.
    assert!(worst < 1e-6, "{worst}");
}

/// Before the joint the neighbours are the marker's own body, after it those of a body that moves
/// otherwise, so that the two predictions lie centimetres apart; the path runs on between them.
#[test]
fn segments_join_without_a_step() {
    let xyz = Array3::from_shape_fn((300, 9, 3), |(t, m, a)| {
        let (turn, place) = pose(t);
        let other = Rotation::about([0.0, 0.0, 1.0], (t as f64 / 100.0).cos()).after(turn);
        if m < 5 {
            add(turn.apply(SHAPE[m]), place)[a]
        } else {
            add(other.apply(SHAPE[m - 4]), place)[a]
        }
    });
    let names = MarkerSet::new((0..9).map(|m| format!("M{m}"))).unwrap();
    let truth = Take::from_positions(names, 120.0, xyz).unwrap();
    let filled = fill(&hide(&truth, |t, m| match m {
        0 => (150..250).contains(&t),
        1..5 => (200..260).contains(&t),
        _ => (140..200).contains(&t),
    }));
    let bend = |take: &Take| {
        let p = |t: usize| take.position(t, 0).unwrap();
        (151..249).map(|t| distance(add(p(t - 1), p(t + 1)), scale(2.0, p(t)))).fold(0.0, f64::max)
    };
    let worst = (150..250).map(|t| error(&truth, &filled, t, 0)).fold(0.0, f64::max);
    // A bare step would bend the path by the distance of the predictions in a single frame. Spread
    // over 12 frames on either side it bends it by a twentieth of that at most.
    assert!(worst > 0.02);
    assert!(bend(filled.take()) < bend(&truth) + 0.1 * worst, "{}", bend(filled.take()));
}

#[test]
fn a_black_out_is_refused() {
    let truth = articulated_take(200, 2);
    let filled = fill(&hide(&truth, |t, _| (80..120).contains(&t)));
    assert_eq!(filled.filled_cells().count(), 0);
    assert_eq!(refusals(&filled).len(), 8);
}

#[test]
fn a_short_black_out_within_a_gap_is_bridged_and_a_long_one_is_not() {
    let truth = rigid_take(6, 300, 9);
    let bridged = |last: usize| {
        let black = move |t: usize| (140..last).contains(&t);
        let visible = hide(&truth, |t, m| (m == 0 && (100..200).contains(&t)) || black(t));
        let filled = fill(&visible);
        (100..200).all(|t| filled.state(t, 0) == CellState::Filled)
    };
    // 12 frames are 0.1 s.
    assert!(bridged(152));
    assert!(!bridged(153));
}

/// With one neighbour the offset to it is interpolated, as no frame turns with it.
#[test]
fn one_neighbour_gives_its_offset() {
    let take = sliding_take().select(&[0, 1]).unwrap();
    let filled = fill(&hide(&take, |t, m| m == 0 && (60..110).contains(&t)));
    let offset = |t: usize| sub(take.position(t, 0).unwrap(), take.position(t, 1).unwrap());
    for t in 60..110 {
        let share = (t - 59) as f64 / 51.0;
        let at = add(scale(1.0 - share, offset(59)), scale(share, offset(110)));
        let expected = add(take.position(t, 1).unwrap(), at);
        assert!(distance(filled.take().position(t, 0).unwrap(), expected) < ROUNDING_M);
    }
}

/// Neighbours on a line leave a turn about it open; the body here turns little, and the marker lies
/// 10 cm off the line, so that a made-up turn would show.
#[test]
fn neighbours_on_a_line_make_up_no_turn() {
    let xyz = Array3::from_shape_fn((FRAMES, 4, 3), |(t, m, a)| {
        let shape = [[0.0, 0.1, 0.0], [0.0; 3], [0.2, 0.0, 0.0], [0.45, 0.0, 0.0]][m];
        let x = t as f64 / 120.0;
        let turn = Rotation::about([0.0, 0.0, 1.0], 0.3 * (2.0 * x).sin());
        add(turn.apply(shape), [x, 0.0, 1.0])[a]
    });
    let names = MarkerSet::new(["A", "B", "C", "D"]).unwrap();
    let truth = Take::from_positions(names, 120.0, xyz).unwrap();
    let filled = fill(&hide(&truth, |t, m| m == 0 && (60..110).contains(&t)));
    // Linear in sine and cosine, so the regression is exact but for the penalty.
    assert!((60..110).all(|t| error(&truth, &filled, t, 0) < 0.001));
}

/// A marker above the plane of its neighbours stays on its side.
#[test]
fn flat_neighbours_do_not_mirror() {
    let xyz = Array3::from_shape_fn((FRAMES, 5, 3), |(t, m, a)| {
        let shape = [
            [0.0, 0.0, 0.1],
            [0.1, 0.0, 0.0],
            [-0.1, 0.05, 0.0],
            [0.0, -0.1, 0.0],
            [0.1, 0.1, 0.0],
        ];
        let (turn, place) = pose(t);
        add(turn.apply(shape[m]), place)[a]
    });
    let names = MarkerSet::new(["A", "B", "C", "D", "E"]).unwrap();
    let truth = Take::from_positions(names, 120.0, xyz).unwrap();
    let filled = fill(&hide(&truth, |t, m| m == 0 && (60..110).contains(&t)));
    assert!((60..110).all(|t| error(&truth, &filled, t, 0) < ROUNDING_M));
}

/// A neighbour that is hardly ever seen together with the marker is passed over.
#[test]
fn a_neighbour_that_costs_the_training_is_passed_over() {
    let truth = articulated_take(300, 6);
    let visible = hide(&truth, |t, m| match m {
        0 => (100..160).contains(&t),
        1 => !(95..175).contains(&t),
        _ => false,
    });
    let others: Vec<usize> = (0..8).filter(|&m| m != 1).collect();
    let (with, without) = (fill(&visible), fill(&visible.select(&others).unwrap()));
    for t in 100..160 {
        assert_eq!(with.take().position(t, 0), without.take().position(t, 0));
    }
}

/// Markers that stand still while the body goes by say nothing about it.
#[test]
fn another_body_is_no_neighbour() {
    let xyz = Array3::from_shape_fn((FRAMES, 6, 3), |(t, m, a)| {
        if m < 5 { on_body(t, m, [0.0; 3])[a] + 0.05 * t as f64 } else { 0.3 }
    });
    let names = MarkerSet::new((0..6).map(|m| format!("M{m}"))).unwrap();
    let truth = Take::from_positions(names, 120.0, xyz).unwrap();
    let filled = fill(&hide(&truth, |t, m| m < 5 && (60..110).contains(&t)));
    assert_eq!((filled.filled_cells().count(), refusals(&filled).len()), (0, 5));
}

#[test]
fn a_marker_seen_too_seldom_is_refused() {
    let filled = fill(&hide(&articulated_take(100, 1), |t, m| m == 0 && t >= 9));
    assert_eq!(refusals(&filled), [Refusal::TooFewSamples { seen: 9, needed: 10 }]);
}

#[test]
fn parameters_out_of_range_are_named() {
    let default = LocalRidgeParams::default();
    let fades = |tau_s| Residual::Exponential { tau_s };
    let cases = [
        ("core", LocalRidgeParams { core: 2, ..default }),
        ("regressors", LocalRidgeParams { regressors: 5, ..default }),
        ("ridge", LocalRidgeParams { ridge: 0.0, ..default }),
        ("ridge", LocalRidgeParams { ridge: f64::NAN, ..default }),
        ("tau_s", LocalRidgeParams { residual: fades(-1.0), ..default }),
        ("tau_s", LocalRidgeParams { residual: fades(f64::INFINITY), ..default }),
        ("max_spread_m", LocalRidgeParams { max_spread_m: -0.1, ..default }),
        ("min_training", LocalRidgeParams { min_training: 1, ..default }),
    ];
    for (name, params) in cases {
        let Err(FillError::Parameter { field, .. }) = LocalRidge::new(params) else {
            panic!("{name} is accepted")
        };
        assert_eq!(field, name);
    }
}
