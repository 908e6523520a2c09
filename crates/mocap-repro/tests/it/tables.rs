use mocap_repro::{
    Coordinates, Finished, Knowledge, LengthOutcome, Outcome, Reference, Stats, Sureness, Trial,
    Variant, compare, duels, fixture_trials, leaderboard_report, summarise,
};

fn outcome(mse_m2: f64, mean_mm: f64) -> Outcome {
    Outcome {
        mse_m2: Some(mse_m2),
        mean_mm: Some(mean_mm),
        median_mm: Some(mean_mm),
        p95_mm: Some(2.0 * mean_mm),
        hidden: 10,
        iterations: 1,
        termination: "converged".to_owned(),
        seconds: 0.5,
        ..Outcome::default()
    }
}

fn failed() -> Outcome {
    Outcome {
        mse_m2: None,
        mean_mm: None,
        median_mm: None,
        p95_mm: None,
        unfilled: 10,
        error: Some("no".to_owned()),
        ..outcome(0.0, 0.0)
    }
}

#[test]
fn statistics_agree_with_hand_computed_ones() {
    let outcomes = [outcome(4.0, 1.0), outcome(1.0, 2.0), outcome(2.0, 6.0), failed()];
    let stats = Stats::of(&outcomes);
    assert_eq!((stats.trials, stats.failed, stats.hidden, stats.unfilled), (4, 1, 40, 10));
    // 1, 2, 4: mean 7/3, median 2, third quartile half way between 2 and 4.
    assert!((stats.mse_mean.unwrap() - 7.0 / 3.0).abs() < 1e-15, "one rounding of a third");
    assert_eq!(stats.mse_median, Some(2.0));
    assert_eq!(stats.mse_p75, Some(3.0));
    assert_eq!(stats.mse_max, Some(4.0));
    assert_eq!((stats.mm_mean, stats.mm_median, stats.mm_p95), (Some(3.0), Some(2.0), Some(6.0)));
    assert_eq!(stats.seconds, Some(0.5));
    assert_eq!(Stats::of(&[failed()]).mse_mean, None);
}

/// Three trials by two methods, with errors of choice.
fn cells<'a>(
    trials: &'a [Trial],
    variants: &'a [Variant],
    errors: [[f64; 3]; 2],
) -> Vec<Finished<'a>> {
    let mut cells = Vec::new();
    for (trial, t) in trials.iter().zip(0..3) {
        for (variant, v) in variants.iter().zip(0..2) {
            let error = errors[v][t];
            let outcome = if error < 0.0 { failed() } else { outcome(error, error) };
            let (coordinates, knowledge) = (Coordinates::Body, Knowledge::Oracle);
            cells.push(Finished { trial, variant, coordinates, knowledge, outcome });
        }
    }
    cells
}

#[test]
fn wins_count_trials_that_both_filled() {
    let trials = fixture_trials();
    let variants = ["linear", "spline"].map(|text| Variant::parse(text).unwrap());
    let cells = cells(&trials, &variants, [[1.0, 4.0, 1.0], [2.0, 1.0, -1.0]]);
    let duels = duels(&cells, &["linear"], &["spline", "linear", "lds"]);
    assert_eq!(duels.len(), 1);
    assert_eq!((duels[0].wins, duels[0].trials), (1, 2));
    // 2/1 and 1/4.
    assert_eq!(duels[0].median_ratio, Some(1.125));
}

#[test]
fn a_reference_meets_the_row_of_the_same_case() {
    let trials = fixture_trials();
    let variants = ["linear", "spline"].map(|text| Variant::parse(text).unwrap());
    let rows = summarise(&cells(&trials, &variants, [[1.0, 4.0, 1.0], [2.0, 1.0, 3.0]]));
    let reference = Reference {
        set: trials[0].set.clone(),
        class: trials[0].class.clone(),
        coordinates: Coordinates::Body,
        knowledge: Knowledge::Oracle,
        method: "spline".to_owned(),
        figure: "mse_mean".to_owned(),
        value: 4.0,
        source: "hand".to_owned(),
    };
    let elsewhere = Reference { knowledge: Knowledge::Visible, ..reference.clone() };
    let unknown = Reference { figure: "beauty".to_owned(), ..reference.clone() };
    let compared = compare(&rows, &[elsewhere, unknown, reference]);
    assert_eq!(compared.len(), 1);
    assert_eq!((compared[0].ours, compared[0].ratio()), (2.0, 0.5));
}

#[test]
fn every_built_in_reference_is_readable() {
    let lines = include_str!("../../data/reference.csv").lines().count() - 1;
    let references = Reference::built_in();
    assert_eq!(references.len(), lines);
    assert!(references.iter().all(|reference| reference.value > 0.0));
    // A single-trial case has one figure, by whatever statistic it is called.
    let figures = ["mse_mean", "mse_median", "mse_min", "mse_max", "mm_mean", "mm_median"];
    assert!(references.iter().all(|reference| figures.contains(&reference.figure.as_str())));
}

#[test]
fn a_leaderboard_has_a_row_for_each_gap() {
    let trials = fixture_trials();
    let variants = ["linear", "spline"].map(|text| Variant::parse(text).unwrap());
    let cells = cells(&trials, &variants, [[1.0, 4.0, 1.0], [2.0, 1.0, -1.0]]);
    let report = leaderboard_report(&cells);
    let text = report.to_markdown();
    assert!(text.contains("| fixtures | synthetic | 2.0 | 1.5 (66 %) |"), "{text}");
    assert!(
        text.contains("| fixtures | synthetic | linear | 2.0 | – |"),
        "only what filled everything is ranked"
    );
    assert_eq!(report.rows.len(), 2);
    assert_eq!((report.rows[1].stats.failed, report.rows[1].stats.unfilled), (1, 10));
}

/// One class of gap lengths: ten samples, so many of them within one and two sigma.
fn class(class: usize, mean_mm: f64, within: [usize; 2]) -> LengthOutcome {
    let mut counts = [0; 12];
    (counts[3], counts[7]) = (within[0], within[1]);
    let sureness = Sureness { samples: 10, within: counts, ..Sureness::default() };
    let mean_mm = Some(mean_mm);
    LengthOutcome {
        class,
        mean_mm,
        median_mm: mean_mm,
        p95_mm: mean_mm,
        hidden: 10,
        sureness,
        ..Default::default()
    }
}

#[test]
fn mixed_gaps_are_told_apart_by_length_and_sigmas_add_up() {
    let trials =
        fixture_trials().into_iter().map(|trial| Trial { set: "realistic".to_owned(), ..trial });
    let trials: Vec<Trial> = trials.collect();
    let variants = ["linear", "ridge"].map(|text| Variant::parse(text).unwrap());
    let mut cells = cells(&trials, &variants, [[1.0; 3], [2.0; 3]]);
    for cell in cells.iter_mut().filter(|cell| cell.variant.label() == "ridge") {
        cell.outcome.by_length = vec![class(0, 1.0, [6, 9]), class(2, 8.0, [8, 10])];
    }
    let report = leaderboard_report(&cells);
    let row = |class: &str| report.rows.iter().find(|row| row.class == class).unwrap();
    assert_eq!(row("gaps up to 0.1 s").stats.mm_mean, Some(1.0));
    assert_eq!(row("gaps of 0.25–0.5 s").stats.mm_median, Some(8.0));
    let text = report.to_markdown();
    // 42 of 60 and 57 of 60 samples over three trials of two classes.
    assert!(text.contains("| ridge | all | all | 60 | 70.0 | 95.0 |"), "{text}");
    assert!(text.contains("| ridge | all | gaps up to 0.1 s | 30 | 60.0 | 90.0 |"), "{text}");
    assert!(!text.contains("| linear | all |"), "a method without sigma has no calibration");
}
