use std::path::Path;

use crate::{
    Coordinates, Entry, Finished, Knowledge, Reference, Report, ReproError, Row, Table, Trial,
    compare, duels,
    figure::{Bars, Figure, Panel, Scatter},
    read_trials, reference,
    report::{STATS_NOTE, stats_table},
    summarise,
    summary::{Stats, group},
    trial::hide,
};

/// Folder of the nine motions of [Li10] within the data.
pub(crate) const FOLDER: &str = "cmu/bolero-nine";
pub(crate) const LIST: &str = "trials90.csv";
pub(crate) const LIST_CLASS: &str = "10\u{2013}50 % of the motion";
const CASES: &str = "cases";
const TRIALS: &str = "trials90";
/// The part of the 90 trials that the reference figures are of: the first five of each of these motions.
const PART: &str = "trials35";
const PART_CLASS: &str = "35 of the 90, as in the reference";
const PART_MOTIONS: [&str; 7] =
    ["127_07", "141_16", "141_04", "132_32", "80_10", "132_43", "143_22"];
const PART_TRIALS: usize = 5;
/// Iterations of the running case in the reference figures; all others have 100.
const RUNNING_ITERATIONS: usize = 200;

/// The case studies of [Li10], a black-out, and the 90 trials, each of one marker over 10–50 % of a
/// motion.
///
/// # Errors
/// As [`read_trials`].
pub fn bolero_trials(data: &Path) -> Result<Vec<Trial>, ReproError> {
    let arm = ["RELB", "RFRM", "RWRA", "RWRB", "RFIN"];
    let cases: [(&str, &str, &[&str], usize, usize); 4] = [
        ("127_07", "RKNE+RSHN", &["RKNE", "RSHN"], 25, 90),
        ("132_43", "RELB+RFRM", &["RELB", "RFRM"], 100, 500),
        ("80_10", "right arm", &arm, 100, 300),
        ("132_43", "black-out", &["*"], 300, 324),
    ];
    let case = |(motion, what, markers, first, last): (&str, &str, &[&str], usize, usize)| {
        let name = format!("{motion} {what} {first}\u{2013}{last}");
        Trial {
            set: CASES.to_owned(),
            class: name.clone(),
            name,
            motion: motion.to_owned(),
            hidden: hide(markers, first, last),
            seed: 1,
            iterations: (motion == "127_07").then_some(RUNNING_ITERATIONS),
        }
    };
    let mut trials: Vec<Trial> = cases.into_iter().map(case).collect();
    let listed = read_trials(&data.join(FOLDER).join(LIST), TRIALS, LIST_CLASS)?;
    // These ask for the very computations of the list, which are done once.
    let part: Vec<Trial> = PART_MOTIONS.iter().flat_map(|motion| first(&listed, motion)).collect();
    trials.extend(listed);
    trials.extend(part);
    Ok(trials)
}

fn first(listed: &[Trial], motion: &str) -> Vec<Trial> {
    let of_motion = listed.iter().filter(|trial| trial.motion == motion).take(PART_TRIALS);
    of_motion
        .map(|trial| Trial { set: PART.to_owned(), class: PART_CLASS.to_owned(), ..trial.clone() })
        .collect()
}

/// The tables and figures of [Li10] §4 from finished cells.
#[must_use]
pub fn bolero_report(cells: &[Finished<'_>]) -> Report {
    let rows = summarise(cells);
    let labels = labels(cells);
    let bones: Vec<&str> = labels.iter().copied().filter(|l| l.starts_with("bolero")).collect();
    let plain: Vec<&str> =
        ["dynammo", "lds", "spline"].into_iter().filter(|l| labels.contains(l)).collect();
    let duels = duels(&listed(cells), &bones, &plain);
    let compared = compare(&rows, &Reference::built_in());
    let mut tables = Vec::new();
    let of_set = |wanted: bool| -> Vec<&Row> {
        rows.iter().filter(|row| (row.set == CASES) == wanted).collect()
    };
    if !compared.is_empty() {
        tables.push(reference::table(&compared));
    }
    if !of_set(true).is_empty() {
        tables.push(stats_table("cases", "Case studies", STATS_NOTE, &of_set(true)));
    }
    if !of_set(false).is_empty() {
        tables.push(stats_table("trials", "All trials", STATS_NOTE, &of_set(false)));
    }
    if !duels.is_empty() {
        tables.push(duel_table(&duels));
    }
    let motions = motion_table(cells);
    if !motions.rows.is_empty() {
        tables.push(motions);
    }
    tables.push(cell_table(cells));
    Report {
        title: "Bone-length constrained gap filling: the paper's evaluation, ours beside theirs"
            .to_owned(),
        intro: vec![
            "Told `oracle`: bone lengths and body frame come from the complete motion, hidden samples \
             included, as in the published evaluation. Told `visible`: from what is left of it, as \
             for any user. A method that reads neither gives the same figures in world coordinates."
                .to_owned(),
        ],
        figures: figures(cells),
        tables,
        rows,
        duels,
        compared,
    }
}

/// The cells of the whole list of trials.
fn listed<'a>(cells: &[Finished<'a>]) -> Vec<Finished<'a>> {
    let aside = [CASES, PART];
    cells.iter().filter(|cell| !aside.contains(&cell.trial.set.as_str())).cloned().collect()
}

/// The methods, in their order.
fn labels<'a>(cells: &[Finished<'a>]) -> Vec<&'a str> {
    let mut labels = Vec::new();
    for cell in cells {
        if !labels.contains(&cell.variant.label()) {
            labels.push(cell.variant.label());
        }
    }
    labels
}

fn duel_table(duels: &[crate::Duel]) -> Table {
    let mut table = Table::new(
        "wins",
        "Win rates",
        "Wins: trials on which the first method has the smaller mse. Ratio: median over trials of the \
         other's mse by the first's.",
        &["coordinates", "told", "method", "against", "wins", "of", "share %", "median ratio"],
    );
    table.rows = duels
        .iter()
        .map(|duel| {
            vec![
                Entry::text(duel.coordinates),
                Entry::text(duel.knowledge),
                Entry::text(&duel.method),
                Entry::text(&duel.against),
                Entry::Count(duel.wins),
                Entry::Count(duel.trials),
                Entry::Fixed(Some(100.0 * duel.wins as f64 / duel.trials as f64), 0),
                Entry::Fixed(duel.median_ratio, 2),
            ]
        })
        .collect();
    table
}

/// Mean mse of each motion, method by method.
type Means<'a> = Vec<((Coordinates, Knowledge, &'a str), Vec<Option<f64>>)>;

fn motion_means<'a>(cells: &'a [Finished<'_>]) -> (Vec<&'a str>, Means<'a>) {
    let mut motions: Vec<&str> = Vec::new();
    for cell in cells {
        if !motions.contains(&cell.trial.motion.as_str()) {
            motions.push(&cell.trial.motion);
        }
    }
    let groups = group(cells, |cell| (cell.coordinates, cell.knowledge, cell.variant.label()));
    let means = |members: &[&Finished<'_>]| {
        let of = |motion: &&str| {
            let own = members.iter().filter(|cell| cell.trial.motion == **motion);
            Stats::of(own.map(|cell| &cell.outcome)).mse_mean
        };
        motions.iter().map(of).collect()
    };
    let table = groups.iter().map(|(key, members)| (*key, means(members))).collect();
    (motions, table)
}

fn motion_table(cells: &[Finished<'_>]) -> Table {
    let listed = listed(cells);
    let (motions, means) = motion_means(&listed);
    let mut columns = vec!["coordinates", "told", "method"];
    columns.extend(&motions);
    let note = "Mean over the trials of each motion, in m² per coordinate.";
    let mut table = Table::new("motions", "Mean mse by motion", note, &columns);
    for ((coordinates, knowledge, method), means) in means {
        let mut row = vec![Entry::text(coordinates), Entry::text(knowledge), Entry::text(method)];
        row.extend(means.into_iter().map(Entry::Scientific));
        table.rows.push(row);
    }
    table
}

fn cell_table(cells: &[Finished<'_>]) -> Table {
    let failed = cells.iter().filter(|cell| cell.outcome.error.is_some());
    let mut table = Table::new(
        "failures",
        "Cells that could not be computed",
        "Empty: every method ran on every trial.",
        &["set", "trial", "method", "coordinates", "told", "reason"],
    );
    table.rows = failed
        .map(|cell| {
            vec![
                Entry::text(&cell.trial.set),
                Entry::text(&cell.trial.name),
                Entry::text(cell.variant.label()),
                Entry::text(cell.coordinates),
                Entry::text(cell.knowledge),
                Entry::text(cell.outcome.error.as_deref().unwrap_or_default()),
            ]
        })
        .collect();
    table
}

fn figures(cells: &[Finished<'_>]) -> Vec<Figure> {
    let listed = listed(cells);
    let mut figures = Vec::new();
    for ((coordinates, knowledge), _) in group(&listed, |cell| (cell.coordinates, cell.knowledge)) {
        let own: Vec<Finished<'_>> = listed
            .iter()
            .filter(|cell| (cell.coordinates, cell.knowledge) == (coordinates, knowledge))
            .cloned()
            .collect();
        let conditions = format!("{coordinates} coordinates, bones and frame: {knowledge}");
        let (motions, means) = motion_means(&own);
        figures.push(Figure::Bars(Bars {
            id: format!("mse-by-motion-{coordinates}-{knowledge}"),
            title: format!("Mean mse by motion ({conditions})"),
            y_label: "mean mse [m²]".to_owned(),
            groups: motions.into_iter().map(str::to_owned).collect(),
            series: means.into_iter().map(|(key, means)| (key.2.to_owned(), means)).collect(),
        }));
        let panels: Vec<Panel> = [
            ("dynammo", "bolero-sc"),
            ("dynammo", "bolero-hc"),
            ("lds", "bolero-sc"),
            ("lds", "bolero-hc"),
        ]
        .into_iter()
        .filter_map(|(x, y)| panel(&own, x, y))
        .collect();
        if !panels.is_empty() {
            figures.push(Figure::Scatter(Scatter {
                id: format!("scatter-{coordinates}-{knowledge}"),
                title: format!("Trial by trial ({conditions})"),
                panels,
            }));
        }
    }
    figures
}

/// One method against another, trial by trial.
fn panel(cells: &[Finished<'_>], x: &str, y: &str) -> Option<Panel> {
    let of = |method: &str| -> Vec<(&str, f64)> {
        let own = cells.iter().filter(|cell| cell.variant.label() == method);
        own.filter_map(|cell| Some((cell.trial.name.as_str(), cell.outcome.mse_m2?))).collect()
    };
    let (across, up) = (of(x), of(y));
    let points: Vec<(f64, f64)> = across
        .iter()
        .filter_map(|(name, a)| up.iter().find(|(n, _)| n == name).map(|(_, b)| (*a, *b)))
        .collect();
    (!points.is_empty()).then(|| Panel {
        x_label: format!("{x}: mse [m²]"),
        y_label: format!("{y}: mse [m²]"),
        points,
    })
}
