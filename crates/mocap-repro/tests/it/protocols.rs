use std::path::Path;

use mocap_repro::{Matrix, Protocol, Trial, protocol_trials};

use crate::small_matrix;

const NONE: &str = "";

fn trials(protocol: Protocol, matrix: &Matrix) -> Vec<Trial> {
    protocol_trials(protocol, Path::new(NONE), &matrix.motions).unwrap()
}

fn markers(trial: &Trial) -> usize {
    let mut names: Vec<&str> = trial.hidden.iter().map(|hide| hide.marker.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names.len()
}

#[test]
fn protocols_draw_the_same_gaps_every_time_and_fit_their_motions() {
    let matrix = small_matrix();
    for protocol in Protocol::ALL.into_iter().filter(|p| *p != Protocol::Bolero90) {
        let drawn = trials(protocol, &matrix);
        assert_eq!(drawn, trials(protocol, &matrix), "{protocol}");
        assert!(!drawn.is_empty(), "{protocol}");
        let mut names: Vec<&str> = drawn.iter().map(|trial| trial.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), drawn.len(), "{protocol}: names are unique");
        Matrix { trials: drawn, iterations: Some(1), ..matrix.clone() }.check().unwrap();
    }
}

#[test]
fn gaps_leave_frames_on_either_side_and_have_the_length_of_their_class() {
    let matrix = small_matrix();
    for protocol in [Protocol::Multi, Protocol::Limb, Protocol::Blackout, Protocol::PseudoGaps] {
        for trial in trials(protocol, &matrix) {
            let take = matrix.motions[&trial.motion].take();
            let seen = 10..=take.frames() - 10;
            assert!(trial.hidden.iter().all(|h| seen.contains(&h.start) && seen.contains(&h.end)));
            let frames = trial.hidden[0].end - trial.hidden[0].start;
            let said = trial.class.rsplit_once(", ").unwrap().1;
            let (number, unit) = said.split_once(' ').unwrap();
            let number: f64 = number.parse().unwrap();
            let due = if unit == "s" { (number * take.rate_hz()).round() } else { number };
            assert_eq!(frames as f64, due, "{}", trial.name);
        }
    }
}

#[test]
fn classes_hide_the_markers_that_they_name() {
    let matrix = small_matrix();
    let of = |protocol, class: &str| {
        let found =
            trials(protocol, &matrix).into_iter().find(|trial| trial.class.starts_with(class));
        markers(&found.unwrap())
    };
    for (class, count) in [("1 marker,", 1), ("3 markers", 3), ("5 markers", 5), ("10 markers", 10)]
    {
        assert_eq!(of(Protocol::Multi, class), count);
    }
    let all = matrix.motions.values().next().unwrap().take().marker_count();
    assert_eq!(of(Protocol::Blackout, "all markers"), all);
    // Upper arm, elbow, forearm, two at the wrist, hand; thigh, knee, shin, ankle, heel, two at the toes.
    assert_eq!((of(Protocol::Limb, "left arm"), of(Protocol::Limb, "right leg")), (6, 7));
}

#[test]
fn realistic_gaps_are_of_many_lengths_and_as_many_as_asked_for() {
    let matrix = small_matrix();
    let drawn = trials(Protocol::Realistic, &matrix);
    let lengths = |class: &str| {
        let own = drawn.iter().filter(|trial| trial.class == class);
        let mut lengths: Vec<usize> =
            own.flat_map(|t| t.hidden.iter().map(|hide| hide.end - hide.start)).collect();
        lengths.sort_unstable();
        lengths
    };
    let (alone, together) = (lengths("independent markers"), lengths("neighbours together"));
    assert_eq!(alone, together, "an occluder moves gaps and changes none");
    assert!(alone[0] == 1 && alone[alone.len() - 1] > 50, "{alone:?}");
    let cells: usize = matrix
        .motions
        .values()
        .map(|motion| motion.take().frames() * motion.take().marker_count())
        .sum();
    let share = alone.iter().sum::<usize>() as f64 / cells as f64;
    // 41 markers of four short takes, each off by at most one long gap.
    assert!((share / 0.05 - 1.0).abs() < 0.2, "{share}");
}
