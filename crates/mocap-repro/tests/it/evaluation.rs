use std::fs;

use mocap_repro::{
    Coordinates, Evaluation, Finished, Knowledge, Matrix, Store, Variant, bolero_report, run,
};

use crate::fixtures;

const ITERATIONS: usize = 2;

fn matrices(evaluation: &Evaluation, methods: &[&str]) -> Vec<Matrix> {
    let variants: Vec<Variant> = methods.iter().map(|m| Variant::parse(m).unwrap()).collect();
    // Two iterations for the sweeps too, which have numbers of their own.
    let mut matrices = evaluation.matrices(&variants, &[Coordinates::Body], Some(ITERATIONS));
    for trial in matrices.iter_mut().flat_map(|matrix| &mut matrix.trials) {
        trial.iterations = trial.iterations.map(|number| number.min(ITERATIONS));
    }
    matrices
}

#[test]
fn a_report_holds_every_figure_and_table_of_the_paper() {
    let methods = [
        "linear",
        "spline",
        "ridge",
        "dynammo+published",
        "bolero-sc+published+lambda=0",
        "bolero-sc+published",
        "bolero-sc",
    ];
    let evaluation = Evaluation::of_fixtures(&fixtures()).unwrap();
    let matrices = matrices(&evaluation, &methods);
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::open(&folder.path().join("cells.jsonl")).unwrap();
    let cells = run(&matrices, &mut store, 2, &|_| ()).unwrap();
    let variants = &matrices[0].variants;
    let report = bolero_report(&evaluation, variants, Some(ITERATIONS), &cells).unwrap();
    let [markdown, page] = report.write(folder.path(), "bolero").unwrap();

    let markdown = fs::read_to_string(markdown).unwrap();
    let page = fs::read_to_string(page).unwrap();
    assert!(page.contains("<svg") && !page.contains("src=") && !page.contains("href="));
    for figure in [
        "fig-1",
        "fig-2",
        "fig-3",
        "fig-4a-fixtures-body-oracle",
        "fig-4bc-fixtures-body-oracle",
        "fig-4a-random90-body-oracle",
        "fig-4bc-random90-body-oracle",
        "lambda",
        "seeds",
        "iterations",
    ] {
        let png = fs::read(folder.path().join(format!("{figure}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG"), "{figure}");
        assert!(markdown.contains(&format!("({figure}.svg)")), "{figure}");
    }
    for table in ["table-1", "cases", "trials", "masks", "wins", "motions-fixtures", "failures"] {
        assert!(
            folder.path().join(format!("{table}.csv")).metadata().unwrap().len() > 0,
            "{table}"
        );
    }
    assert!(markdown.contains("Soft bone lengths do not win every trial."));
    // A filler that knows its error is told from one that does not, and one that refuses a black-out
    // from one that fills it.
    let row =
        |method: &str| markdown.lines().find(|l| l.starts_with(&format!("| {method} |"))).unwrap();
    assert!(
        row("ridge").contains("left open") && row("ridge").contains(" and "),
        "{}",
        row("ridge")
    );
    assert!(
        row("spline").contains("| no | 1") || row("spline").contains("| no |"),
        "{}",
        row("spline")
    );
    knows_no_more_than_it_is_told(&cells);
}

/// In world coordinates a method without bones is told nothing by an oracle.
fn knows_no_more_than_it_is_told(cells: &[Finished<'_>]) {
    assert!(cells.iter().all(|cell| cell.outcome.error.is_none()));
    let of = |knowledge| {
        let is_it = |cell: &&Finished<'_>| {
            cell.variant.label() == "linear"
                && cell.trial.set == "cases"
                && cell.coordinates == Coordinates::Body
                && cell.knowledge == knowledge
        };
        cells.iter().filter(is_it).count()
    };
    assert_eq!((of(Knowledge::Oracle), of(Knowledge::Visible)), (3, 3));
}

#[test]
fn methods_that_are_not_run_leave_their_figures_out() {
    let evaluation = Evaluation::of_fixtures(&fixtures()).unwrap();
    let matrices = matrices(&evaluation, &["linear"]);
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::open(&folder.path().join("cells.jsonl")).unwrap();
    let cells = run(&matrices, &mut store, 1, &|_| ()).unwrap();
    assert!(cells.iter().all(|cell| cell.variant.label() == "linear"));
    let report =
        bolero_report(&evaluation, &matrices[0].variants, Some(ITERATIONS), &cells).unwrap();
    report.write(folder.path(), "bolero").unwrap();
    assert!(!folder.path().join("lambda.png").exists());
}

/// The nine motions and the list, where they are there.
#[test]
fn the_papers_trials_are_the_cases_the_list_and_the_random_rule() {
    let Some(data) = std::env::var_os("MOCAP_DATA").map(std::path::PathBuf::from) else {
        println!("skipped: MOCAP_DATA is not set");
        return;
    };
    let evaluation = Evaluation::of_paper(&data).unwrap();
    let variants = [Variant::parse("linear").unwrap()];
    let matrices = evaluation.matrices(&variants, &[Coordinates::Body], Some(100));
    matrices.iter().try_for_each(Matrix::check).unwrap();
    let of = |set: &str| {
        let all = matrices.iter().flat_map(|matrix| &matrix.trials);
        all.filter(|trial| trial.set == set).cloned().collect::<Vec<_>>()
    };
    assert_eq!((of("trials90").len(), of("trials35").len(), of("random90").len()), (90, 35, 90));
    let cases = of("cases");
    let knee = &cases[0].hidden[0];
    assert_eq!((knee.marker.as_str(), knee.start, knee.end), ("RKNE", 24, 90));
    // Lengths uniform over 1 to all frames: a mean of a half, with a standard error of 0.03.
    let share = |trial: &mocap_repro::Trial| {
        let hide = &trial.hidden[0];
        let frames = matrices[0].motions[&trial.motion].take().frames();
        (hide.end - hide.start) as f64 / frames as f64
    };
    let mean = of("random90").iter().map(share).sum::<f64>() / 90.0;
    assert!((mean - 0.5).abs() < 0.12, "{mean}");
}
