//! Tables of the evaluation.

use mocap_report::Entry;

use super::{
    Evaluation, findings::findings, paper_figures, set, sweep_figures, sweeps, table_one,
    trial_figures,
};
use crate::{
    Duel, Finished, Reference, Report, ReproError, Row, Section, Variant, compare, duels,
    figure::Legend,
    reference,
    report::{STATS_NOTE, stats_table},
    summarise,
};

/// The tables and figures of [Li10], from finished cells and, for Figs. 1 to 3, from fills made here.
///
/// # Errors
/// As [`run`](crate::run).
pub fn bolero_report(
    evaluation: &Evaluation,
    variants: &[Variant],
    iterations: Option<usize>,
    cells: &[Finished<'_>],
) -> Result<Report, ReproError> {
    let rows = summarise(cells);
    let labels = labels(cells);
    let legend = Legend::of(labels.iter().copied());
    let bones: Vec<&str> = labels.iter().copied().filter(|l| l.starts_with("bolero")).collect();
    let plain: Vec<&str> =
        ["dynammo+published", "lds", "spline"].into_iter().filter(|l| labels.contains(l)).collect();
    let trials = of_sets(cells, |name| ![set::CASES, set::PART, set::MASKS].contains(&name));
    let duels = duels(&of_sets(&trials, is_no_sweep), &bones, &plain);
    let compared = compare(&rows, &Reference::built_in());
    let cases = [&evaluation.running, &evaluation.walking, &evaluation.blackout];
    let of_set = |wanted: &dyn Fn(&str) -> bool| -> Vec<&Row> {
        rows.iter().filter(|row| wanted(&row.set) && is_no_sweep(&row.set)).collect()
    };
    let mut sections: Vec<Section> =
        table_one::section(cells, cases.map(String::as_str)).into_iter().collect();
    sections.push(reference::table(&compared));
    let case_rows = of_set(&|name| name == set::CASES);
    sections.push(stats_table("cases", "Case studies", STATS_NOTE, &case_rows));
    let trial_rows = of_set(&|name| name != set::CASES && name != set::MASKS);
    sections.push(stats_table("trials", "All trials", STATS_NOTE, &trial_rows));
    let mask_rows = of_set(&|name| name == set::MASKS);
    sections.push(stats_table("masks", "Masks that are no tidy gaps", STATS_NOTE, &mask_rows));
    sections.push(duel_table(&duels));
    for set in [set::LISTED, "fixtures", set::RANDOM] {
        sections.push(motion_table(set, &of_sets(cells, |name| name == set)));
    }
    sections.extend(sweeps::sections(&rows));
    sections.retain(|section| !section.table.is_empty());
    sections.push(failure_table(cells));
    let mut figures = paper_figures::figures(evaluation, variants, iterations)?;
    figures.extend(trial_figures::figures(cells));
    figures.extend(sweep_figures::figures(cells, &legend));
    Ok(Report {
        title: "Bone-length constrained gap filling: the paper's evaluation, ours beside theirs"
            .to_owned(),
        intro: vec![
            "Told `oracle`: bone lengths and body frame come from the complete motion, hidden samples \
             included, as in the published evaluation. Told `visible`: from what is left of it, as \
             for any user. A method that reads neither gives the same figures in world coordinates."
                .to_owned(),
            "`dynammo+published` is the baseline that the paper calls LDS/DynaMMo, `bolero-sc+published` and \
             `bolero-hc+published` are its soft and hard bone lengths, all with its own settings; \
             `+lambda=0` switches the soft ones off. `lds`, `bolero-sc` and `bolero-hc` are ours: exact \
             EM of a larger system from a start that no fill has a part in, 20 iterations."
                .to_owned(),
        ],
        findings: findings(cells),
        sections,
        figures,
        rows,
        duels,
        compared,
    })
}

fn is_no_sweep(name: &str) -> bool {
    ![set::LAMBDA, set::SEEDS, set::CAPS].contains(&name)
}

fn of_sets<'a>(cells: &[Finished<'a>], wanted: impl Fn(&str) -> bool) -> Vec<Finished<'a>> {
    cells.iter().filter(|cell| wanted(&cell.trial.set)).cloned().collect()
}

/// The methods, in their order; those of the sweeps last.
fn labels<'a>(cells: &[Finished<'a>]) -> Vec<&'a str> {
    let mut labels = Vec::new();
    for cell in cells {
        if !labels.contains(&cell.variant.label()) {
            labels.push(cell.variant.label());
        }
    }
    labels
}

fn duel_table(duels: &[Duel]) -> Section {
    let row = |duel: &Duel| {
        vec![
            Entry::text(&duel.set),
            Entry::text(duel.coordinates),
            Entry::text(duel.knowledge),
            Entry::text(&duel.method),
            Entry::text(&duel.against),
            Entry::count(duel.wins),
            Entry::count(duel.trials),
            Entry::number(Some(100.0 * duel.wins as f64 / duel.trials as f64), 0),
            Entry::number(duel.median_ratio, 2),
        ]
    };
    Section::new(
        "wins",
        "Win rates",
        "Wins: trials on which the first method has the smaller mse. Ratio: median over trials of the \
         other's mse by the first's.",
        &[
            "trials",
            "coordinates",
            "told",
            "method",
            "against",
            "wins",
            "of",
            "share %",
            "median ratio",
        ],
        duels.iter().map(row),
    )
}

fn motion_table(set: &str, cells: &[Finished<'_>]) -> Section {
    let (motions, means) = trial_figures::motion_means(cells);
    let mut columns = vec!["coordinates", "told", "method"];
    columns.extend(&motions);
    let class = cells.first().map_or("", |cell| &cell.trial.class);
    let rows = means.into_iter().map(|((coordinates, knowledge, method), means)| {
        let mut row = vec![Entry::text(coordinates), Entry::text(knowledge), Entry::text(method)];
        row.extend(means.into_iter().map(Entry::scientific));
        row
    });
    Section::new(
        &format!("motions-{set}"),
        &format!("Mean mse by motion, {class}"),
        "Mean over the trials of each motion, in m² per coordinate: Fig. 4(a) for every method.",
        &columns,
        rows,
    )
}

fn failure_table(cells: &[Finished<'_>]) -> Section {
    let failed = cells.iter().filter(|cell| cell.outcome.error.is_some());
    let row = |cell: &Finished<'_>| {
        vec![
            Entry::text(&cell.trial.set),
            Entry::text(&cell.trial.name),
            Entry::text(cell.variant.label()),
            Entry::text(cell.coordinates),
            Entry::text(cell.knowledge),
            Entry::text(cell.outcome.error.as_deref().unwrap_or_default()),
        ]
    };
    Section::new(
        "failures",
        "Cells that could not be computed",
        "Empty: every method ran on every trial.",
        &["set", "trial", "method", "coordinates", "told", "reason"],
        failed.map(row),
    )
}
