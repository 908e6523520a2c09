use metrics::{BorderStep, border_step, border_steps};
use mocap_core::{Estimates, FillReport, Filled, Gap, Mask, Take, Termination};

use crate::{along_x, assert_mm, take};

fn line(x: &[f64]) -> Take {
    take(&[along_x(x)])
}

fn gap(frames: std::ops::Range<usize>) -> Gap {
    Gap { marker: 0, frames }
}

#[test]
fn constant_acceleration_has_no_step() {
    let x: Vec<f64> = (0..10).map(|t| 0.003 * f64::from(t * t) + 0.1 * f64::from(t)).collect();
    let border = border_step(&line(&x), &gap(3..7));
    assert_mm(border.start_mm.unwrap(), 0.0);
    assert_mm(border.end_mm.unwrap(), 0.0);
}

#[test]
fn an_offset_fill_gives_the_offset() {
    let x = [0.0, 0.0, 0.0, 0.02, 0.02, 0.02, 0.0, 0.0];
    let border = border_step(&line(&x), &gap(3..6));
    assert_mm(border.start_mm.unwrap(), 20.0);
    assert_mm(border.end_mm.unwrap(), 20.0);
    assert_mm(border.max_mm().unwrap(), 20.0);
}

#[test]
fn the_mean_of_both_neighbouring_steps_is_expected() {
    // Steps 10, 50, 30 mm: 50 − ½ (10 + 30).
    let border = border_step(&line(&[0.0, 0.01, 0.06, 0.09]), &gap(2..4));
    assert_mm(border.start_mm.unwrap(), 30.0);
    assert_eq!(border.end_mm, None);
}

#[test]
fn one_neighbouring_step_stands_for_both() {
    // Frame 0 is the only sample before the gap: 50 − 30.
    let border = border_step(&line(&[0.0, 0.05, 0.08, 0.11]), &gap(1..3));
    assert_mm(border.start_mm.unwrap(), 20.0);
    assert_mm(border.end_mm.unwrap(), 0.0);
}

#[test]
fn a_border_that_cannot_be_judged_is_none() {
    let two = line(&[0.0, 0.05]);
    assert_eq!(border_step(&two, &gap(1..2)), BorderStep::default());
    let open = line(&[0.0, 0.0, f64::NAN, f64::NAN, 0.0, 0.0]);
    assert_eq!(border_step(&open, &gap(2..4)), BorderStep::default());
    assert_eq!(BorderStep::default().max_mm(), None);
}

#[test]
#[allow(clippy::reversed_empty_ranges)] // what a caller can write, the function must survive
fn gaps_of_no_take_have_no_borders() {
    let five = line(&[0.0; 5]);
    for frames in [2..2, 4..2, 3..9, usize::MAX - 1..usize::MAX] {
        assert_eq!(border_step(&five, &gap(frames)), BorderStep::default());
    }
    assert_eq!(border_step(&five, &Gap { marker: 1, frames: 1..2 }), BorderStep::default());
}

#[test]
fn all_gaps_of_a_fill_are_listed() {
    let truth = take(&[along_x(&[0.0; 9]), along_x(&[1.0; 9])]);
    let hidden = Mask::from_fn(9, 2, |t, m| t >= 3 + m && t < 5 + m);
    let input = truth.hide(&hidden).unwrap();
    let shifted = truth.map_positions(|_, m, [x, y, z]| [x + 0.01 * m as f64, y, z]).unwrap();
    let estimates = Estimates { positions: shifted.positions().to_owned(), sigma_m: None };
    let report = FillReport::new("shift", Termination::ClosedForm);
    let steps = border_steps(&Filled::merge(&input, estimates, report).unwrap());
    assert_eq!(steps.iter().map(|(g, _)| g.clone()).collect::<Vec<_>>(), input.gaps());
    assert_mm(steps[0].1.max_mm().unwrap(), 0.0);
    assert_mm(steps[1].1.max_mm().unwrap(), 10.0);
}
