use mocap_repro::{
    Coordinates, Entry, Finished, Knowledge, Outcome, Reference, Stats, Table, Trial, Variant,
    bolero_report, compare, duels, fixture_trials, leaderboard_report, leaderboard_trials,
    summarise,
};

use crate::{run_in, small_matrix};

fn outcome(mse_m2: f64, mean_mm: f64) -> Outcome {
    Outcome {
        mse_m2: Some(mse_m2),
        mean_mm: Some(mean_mm),
        median_mm: Some(mean_mm),
        p95_mm: Some(2.0 * mean_mm),
        bone_mm: None,
        hidden: 10,
        unfilled: 0,
        iterations: 1,
        termination: "converged".to_owned(),
        seconds: 0.5,
        error: None,
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
    let figures = ["mse_mean", "mse_median", "mm_mean", "mm_median"];
    assert!(references.iter().all(|reference| figures.contains(&reference.figure.as_str())));
}

#[test]
fn tables_say_the_same_in_every_form() {
    let table = Table {
        id: "t",
        title: "A < B".to_owned(),
        note: String::new(),
        columns: vec!["the name".to_owned(), "x".to_owned()],
        rows: vec![
            vec![Entry::Text("a|b, c".to_owned()), Entry::Scientific(Some(0.001_234_5))],
            vec![Entry::Text("d".to_owned()), Entry::Fixed(None, 1)],
        ],
    };
    assert_eq!(
        table.to_markdown(),
        "## A < B\n\n| the name | x |\n| --- | ---: |\n| a\\|b, c | 1.23e-3 |\n| d | \u{2013} |\n"
    );
    assert_eq!(table.to_csv(), "the_name,x\n\"a|b, c\",0.0012345\nd,\n");
    assert!(table.to_html().contains("<h2>A &lt; B</h2>"));
}

#[test]
fn a_report_writes_tables_figures_and_one_page() {
    let matrix = small_matrix();
    let folder = tempfile::tempdir().unwrap();
    let cells = run_in(&matrix, folder.path(), 2);
    // 8 trials, 3 methods, 2 coordinates, 2 kinds of knowledge.
    assert_eq!(cells.len(), 96);
    let report = bolero_report(&cells);
    let [markdown, page] = report.write(folder.path(), "bolero").unwrap();
    assert!(std::fs::read_to_string(markdown).unwrap().contains("| dynammo |"));
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("<svg") && !page.contains("src=") && !page.contains("href="));
    for file in ["trials.csv", "motions.csv", "mse-by-motion-body-oracle.png"] {
        assert!(folder.path().join(file).metadata().unwrap().len() > 0, "{file}");
    }
    // In world coordinates a method without bones is told nothing by an oracle.
    let of = |knowledge| {
        let is_it = |cell: &&Finished<'_>| {
            cell.variant.label() == "dynammo"
                && cell.coordinates == Coordinates::World
                && cell.knowledge == knowledge
        };
        cells.iter().filter(is_it).map(|cell| &cell.outcome).collect::<Vec<_>>()
    };
    assert_eq!(of(Knowledge::Oracle), of(Knowledge::Visible));
    assert!(cells.iter().all(|cell| cell.outcome.error.is_none() && cell.outcome.unfilled == 0));
}

#[test]
fn protocols_draw_the_same_gaps_every_time_and_fit_their_motions() {
    use mocap_repro::Protocol;
    let matrix = small_matrix();
    let none = std::path::Path::new("");
    for protocol in [Protocol::Multi, Protocol::Limb, Protocol::Blackout] {
        let trials = leaderboard_trials(protocol, none, &matrix.motions).unwrap();
        assert_eq!(trials, leaderboard_trials(protocol, none, &matrix.motions).unwrap());
        assert!(!trials.is_empty());
        for trial in &trials {
            let take = matrix.motions[&trial.motion].take();
            let holdout = trial.cut(take).unwrap();
            assert!(holdout.hidden().iter().all(|(t, _)| (10..take.frames() - 10).contains(&t)));
        }
        let same = mocap_repro::Matrix { trials, iterations: Some(1), ..matrix.clone() };
        same.check().unwrap();
        // So many different markers as the class says.
        let five = same.trials.iter().find(|trial| trial.class.starts_with("5 markers"));
        let markers = |trial: &Trial| {
            let mut names: Vec<String> = trial.hidden.iter().map(|h| h.marker.clone()).collect();
            names.sort();
            names.dedup();
            names.len()
        };
        assert!(five.is_none_or(|trial| markers(trial) == 5));
    }
}

#[test]
fn a_leaderboard_has_a_row_for_each_gap() {
    let trials = fixture_trials();
    let variants = ["linear", "spline"].map(|text| Variant::parse(text).unwrap());
    let cells = cells(&trials, &variants, [[1.0, 4.0, 1.0], [2.0, 1.0, -1.0]]);
    let report = leaderboard_report(&cells);
    let text = report.to_markdown();
    assert!(text.contains("| fixtures | synthetic | 2.0 | 1.5 |"), "{text}");
    assert_eq!(report.rows.len(), 2);
    assert_eq!((report.rows[1].stats.failed, report.rows[1].stats.unfilled), (1, 10));
}
