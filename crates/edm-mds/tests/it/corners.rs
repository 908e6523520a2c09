//! Every corner case of gaps filled from distances.

use edm_mds::{Edm, EdmParams, EdmSolver};
use mocap_core::{
    FillError, Filled, GapFiller, MarkerSet, Mask, Refusal, Rotation, Take,
    geometry::{add, distance, norm, scale, sub},
};
use mocap_testkit::{articulated_take, rigid_take};
use ndarray::Array3;

/// Positions of a metre or two through eigenvectors and square roots of squares.
const ROUNDING_M: f64 = 1e-9;
const FRAMES: usize = 160;
const GAP: std::ops::Range<usize> = 60..110;

fn hide(take: &Take, hidden: impl Fn(usize, usize) -> bool) -> Take {
    take.hide(&Mask::from_fn(take.frames(), take.marker_count(), hidden)).unwrap()
}

fn solvers() -> [Edm; 2] {
    [EdmSolver::Scaling, EdmSolver::Trilateration]
        .map(|solver| Edm::new(EdmParams { solver, ..EdmParams::default() }).unwrap())
}

fn worst(truth: &Take, filled: &Filled) -> f64 {
    let cells = filled.filled_cells();
    assert!(cells.count() > 0);
    let errors = cells.iter().map(|(t, m)| {
        distance(truth.position(t, m).unwrap(), filled.take().position(t, m).unwrap())
    });
    errors.fold(0.0, f64::max)
}

fn refusals(filled: &Filled) -> Vec<Refusal> {
    filled.report().refusals.iter().map(|r| r.reason).collect()
}

/// A body with these markers, and `offset(t)` added in body coordinates to marker `who`.
fn body(shape: &[[f64; 3]], who: usize, offset: impl Fn(usize) -> [f64; 3]) -> Take {
    let xyz = Array3::from_shape_fn((FRAMES, shape.len(), 3), |(t, m, a)| {
        let x = t as f64 / 120.0;
        let turn = Rotation::about([0.2, 1.0, -0.4], 0.9 * (2.0 * x).sin());
        let place = if m == who { add(shape[m], offset(t)) } else { shape[m] };
        add(turn.apply(place), [x, (3.0 * x).cos(), 1.0])[a]
    });
    let names = MarkerSet::new((0..shape.len()).map(|m| format!("M{m}"))).unwrap();
    Take::from_positions(names, 120.0, xyz).unwrap()
}

fn still(_: usize) -> [f64; 3] {
    [0.0; 3]
}

const SOLID: [[f64; 3]; 8] = [
    [0.1, 0.0, 0.0],
    [0.0, 0.15, 0.0],
    [-0.1, 0.0, 0.05],
    [0.0, -0.1, 0.1],
    [0.05, 0.05, 0.2],
    [-0.1, 0.1, -0.1],
    [0.15, -0.1, -0.05],
    [0.0, 0.2, 0.15],
];

fn gap_of_first(take: &Take) -> Take {
    hide(take, |t, m| m == 0 && GAP.contains(&t))
}

/// Row "neighbour also occluded": at a frame of the gap or at a border, the next best takes its place.
#[test]
fn an_occluded_neighbour_is_passed_over() {
    let truth = articulated_take(FRAMES, 3);
    for moment in [GAP.start - 1, GAP.start + 20, GAP.end] {
        let visible = hide(&gap_of_first(&truth), |t, m| m == 1 && t == moment);
        let without = visible.select(&[0, 2, 3, 4, 5, 6, 7]).unwrap();
        for filler in solvers() {
            let (a, b) = (filler.fill(&visible).unwrap(), filler.fill(&without).unwrap());
            assert!(GAP.clone().all(|t| a.take().position(t, 0) == b.take().position(t, 0)));
        }
    }
}

/// Row "neighbour also occluded": one that spreads too far is dropped even if fewer than K are left.
#[test]
fn a_neighbour_that_spreads_too_far_is_dropped() {
    let wild = |t: usize| [0.0, 0.0, 0.2 * (t as f64 / 9.0).sin()];
    let truth = body(&SOLID[..6], 5, wild);
    for filler in solvers() {
        let filled = filler.fill(&gap_of_first(&truth)).unwrap();
        assert!(worst(&truth, &filled) < ROUNDING_M);
    }
    let lenient = EdmParams { max_spread_m: f64::INFINITY, ..EdmParams::default() };
    let filled = Edm::new(lenient).unwrap().fill(&gap_of_first(&truth)).unwrap();
    assert!(worst(&truth, &filled) > 1e-4, "the wild neighbour has no say");
}

/// Row "fewer candidates than K": any three that are not on a line will do.
#[test]
fn three_to_five_neighbours_do() {
    for markers in 4..7 {
        let truth = body(&SOLID[..markers], 0, still);
        for filler in solvers() {
            let filled = filler.fill(&gap_of_first(&truth)).unwrap();
            assert!(worst(&truth, &filled) < ROUNDING_M, "{markers} markers");
        }
    }
}

/// Row "coplanar": the marker stays on its side of the plane of its neighbours, at any height.
#[test]
fn flat_neighbours_do_not_mirror() {
    for height in [0.1, 0.01, 0.001, -0.001, -0.05] {
        for neighbours in [3, 6] {
            let mut shape = SOLID[..=neighbours].to_vec();
            for p in &mut shape {
                p[2] = 0.0;
            }
            shape[0][2] = height;
            let truth = body(&shape, 0, still);
            for filler in solvers() {
                let filled = filler.fill(&gap_of_first(&truth)).unwrap();
                assert!(worst(&truth, &filled) < ROUNDING_M, "height {height}");
            }
        }
    }
}

/// Row "coplanar": neighbours that are flat but for a millimetre do not mirror either, and the
/// marker may pass through their plane in the gap.
#[test]
fn a_marker_may_pass_through_the_plane() {
    let mut shape = SOLID[..7].to_vec();
    for p in &mut shape {
        p[2] *= 0.004;
    }
    shape[0] = [0.02, 0.0, 0.0];
    let passes = |t: usize| [0.0, 0.0, 0.02 * (t as f64 - 85.0) / 25.0];
    let truth = body(&shape, 0, passes);
    for filler in solvers() {
        let filled = filler.fill(&gap_of_first(&truth)).unwrap();
        // The straight path is what carrying along gives; heights below a centimetre change squared
        // distances by their square, so distances alone would be off by up to two centimetres.
        assert!(worst(&truth, &filled) < 0.003, "{}", worst(&truth, &filled));
    }
}

/// Row "k < 3": one neighbour keeps its interpolated distance, in the interpolated direction.
#[test]
fn one_neighbour_gives_distance_and_direction() {
    let truth = body(&SOLID[..2], 0, |t| [0.0, 0.0, 0.001 * t as f64]);
    let offset = |t: usize| sub(truth.position(t, 0).unwrap(), truth.position(t, 1).unwrap());
    for filler in solvers() {
        let filled = filler.fill(&gap_of_first(&truth)).unwrap();
        for t in GAP {
            let share = (t + 1 - GAP.start) as f64 / (GAP.len() + 1) as f64;
            let (before, after) = (offset(GAP.start - 1), offset(GAP.end));
            let mix = |x: f64, y: f64| (1.0 - share) * x + share * y;
            let along: [f64; 3] = std::array::from_fn(|a| mix(before[a], after[a]));
            let length = mix(norm(before).powi(2), norm(after).powi(2)).sqrt();
            let expected = add(truth.position(t, 1).unwrap(), scale(length / norm(along), along));
            let found = filled.take().position(t, 0).unwrap();
            // Damping leaves less than a thousandth of the last correction.
            assert!(distance(found, expected) < 1e-7);
        }
    }
}

/// Row "k < 3": two neighbours keep both distances.
#[test]
fn two_neighbours_keep_their_distances() {
    let truth = body(&SOLID[..3], 0, still);
    for filler in solvers() {
        let filled = filler.fill(&gap_of_first(&truth)).unwrap();
        for (t, m) in GAP.flat_map(|t| [(t, 1), (t, 2)]) {
            let error = filled.take().distance(t, 0, m).unwrap() - truth.distance(t, 0, m).unwrap();
            assert!(error.abs() < 1e-6, "{error}");
        }
    }
}

/// Row "k < 3": without any neighbour in some frame the gap stays open.
#[test]
fn a_black_out_is_refused() {
    let truth = rigid_take(6, FRAMES, 2);
    let filled = Edm::default().fill(&hide(&truth, |t, _| GAP.contains(&t))).unwrap();
    assert_eq!((filled.filled_cells().count(), refusals(&filled).len()), (0, 6));
}

/// Rows "start gap" and "end gap": constant local coordinates.
#[test]
fn one_sided_gaps_keep_local_coordinates() {
    let truth = body(&SOLID, 0, still);
    let visible = hide(&truth, |t, m| m == 0 && !(50..100).contains(&t));
    for filler in solvers() {
        let filled = filler.fill(&visible).unwrap();
        assert_eq!(filled.filled_cells().count(), FRAMES - 50);
        assert!(worst(&truth, &filled) < ROUNDING_M);
    }
}

/// Row "both ends missing": the marker is listed, and the others are filled.
#[test]
fn a_marker_never_seen_is_listed() {
    let truth = body(&SOLID, 0, still);
    let visible = hide(&truth, |t, m| m == 1 || (m == 0 && GAP.contains(&t)));
    let filled = Edm::default().fill(&visible).unwrap();
    assert_eq!(refusals(&filled), [Refusal::NeverSeen]);
    assert!(worst(&truth, &filled) < ROUNDING_M);
}

/// Row "not a valid distance matrix": the borders' poses differ so much that no points have the
/// distances between; the answer is finite and near the body.
#[test]
fn distances_of_no_points_still_give_a_position() {
    let slide = |t: usize| [0.0, 0.001 * t as f64, 0.03 * (t as f64 / 7.0).sin()];
    let truth = body(&SOLID[..6], 3, slide);
    let visible = hide(&truth, |t, m| m == 0 && GAP.contains(&t));
    for filler in solvers() {
        let filled = filler.fill(&visible).unwrap();
        assert_eq!(filled.filled_cells().count(), GAP.len());
        assert!(worst(&truth, &filled) < 0.1);
    }
}

/// Row "all neighbours collinear": no turn about the line is made up.
#[test]
fn neighbours_on_a_line_make_up_no_turn() {
    let shape = [[0.0, 0.1, 0.0], [0.0; 3], [0.2, 0.0, 0.0], [0.4, 0.0, 0.0], [0.5, 0.0, 0.0]];
    let xyz = Array3::from_shape_fn((FRAMES, 5, 3), |(t, m, a)| {
        add(shape[m], [t as f64 / 120.0, 0.0, 1.0])[a]
    });
    let names = MarkerSet::new((0..5).map(|m| format!("M{m}"))).unwrap();
    let truth = Take::from_positions(names, 120.0, xyz).unwrap();
    for filler in solvers() {
        let filled = filler.fill(&gap_of_first(&truth)).unwrap();
        assert!(worst(&truth, &filled) < ROUNDING_M);
    }
}

/// Row "border frame is an outlier": a shifted border spoils the gap, and hiding it, as detection
/// does, heals it.
#[test]
fn an_outlier_at_a_border_is_to_be_hidden_first() {
    let shifted = |t: usize| if t == GAP.start - 1 { [0.05, 0.0, 0.0] } else { [0.0; 3] };
    let clean = body(&SOLID, 0, still);
    let visible = gap_of_first(&body(&SOLID, 0, shifted));
    for filler in solvers() {
        let spoilt = filler.fill(&visible).unwrap();
        let error = |filled: &Filled, t: usize| {
            distance(filled.take().position(t, 0).unwrap(), clean.position(t, 0).unwrap())
        };
        assert!(error(&spoilt, GAP.start) > 0.02);
        let hidden = hide(&visible, |t, m| m == 0 && t == GAP.start - 1);
        let healed = filler.fill(&hidden).unwrap();
        assert!(GAP.clone().all(|t| error(&healed, t) < ROUNDING_M));
    }
}

/// Row "continuity": the first and last filled frames differ from the truth by what the distances
/// change in a frame, here 0.2 mm.
#[test]
fn the_fill_meets_the_borders() {
    let slide = |t: usize| [0.02 * (t as f64 / 100.0), 0.0, 0.015 * (t as f64 / 90.0).cos()];
    let truth = body(&SOLID, 0, slide);
    for filler in solvers() {
        let filled = filler.fill(&gap_of_first(&truth)).unwrap();
        for t in [GAP.start, GAP.end - 1] {
            let (p, q) = (filled.take().position(t, 0).unwrap(), truth.position(t, 0).unwrap());
            assert!(distance(p, q) < 0.0004, "{}", distance(p, q));
        }
    }
}

/// Row "swapped labels": not detected; the fill stays finite and the samples as they are.
#[test]
fn swapped_labels_pass() {
    let truth = body(&SOLID, 0, still);
    let swapped = truth
        .map_positions(|t, m, p| match m {
            1 if t >= 80 => truth.position(t, 2).unwrap(),
            2 if t >= 80 => truth.position(t, 1).unwrap(),
            _ => p,
        })
        .unwrap();
    let filled = Edm::default().fill(&gap_of_first(&swapped)).unwrap();
    assert_eq!(filled.filled_cells().count(), GAP.len());
}

/// Row "one neighbour drifts": it weighs less than the steady ones.
#[test]
fn a_drifting_neighbour_weighs_little() {
    let drift = |t: usize| [0.0, 0.03 * (t as f64 / 20.0).sin(), 0.0];
    let truth = body(&SOLID[..7], 6, drift);
    for filler in solvers() {
        let filled = filler.fill(&gap_of_first(&truth)).unwrap();
        // The neighbour errs by up to 3 cm, and its weight is below a hundredth of the others'.
        assert!(worst(&truth, &filled) < 0.002, "{}", worst(&truth, &filled));
    }
}

/// No neighbour is seen throughout the gap, but each frame has some that the borders show as well.
#[test]
fn neighbours_may_come_and_go() {
    let truth = rigid_take(10, 200, 4);
    let visible = hide(&truth, |t, m| match m {
        0 => (60..120).contains(&t),
        m => (60 + 20 * (m % 3)..80 + 20 * (m % 3)).contains(&t) && !(60..61).contains(&t),
    });
    for filler in solvers() {
        let filled = filler.fill(&visible).unwrap();
        let refused = filled.report().refusals.iter().any(|r| r.gap.marker == 0);
        assert!(!refused && worst(&truth, &filled) < 1e-8);
    }
}

#[test]
fn a_marker_seen_too_seldom_is_refused() {
    let truth = body(&SOLID, 0, still);
    let filled = Edm::default().fill(&hide(&truth, |t, m| m == 0 && t >= 9)).unwrap();
    assert_eq!(refusals(&filled), [Refusal::TooFewSamples { seen: 9, needed: 10 }]);
}

#[test]
fn parameters_out_of_range_are_named() {
    let default = EdmParams::default();
    let cases = [
        ("neighbours", EdmParams { neighbours: 2, ..default }),
        ("neighbours", EdmParams { neighbours: 17, ..default }),
        ("max_spread_m", EdmParams { max_spread_m: 0.0, ..default }),
        ("max_spread_m", EdmParams { max_spread_m: f64::NAN, ..default }),
        ("min_shared", EdmParams { min_shared: 1, ..default }),
    ];
    for (name, params) in cases {
        let Err(FillError::Parameter { field, .. }) = Edm::new(params) else {
            panic!("{name} is accepted")
        };
        assert_eq!(field, name);
    }
}
