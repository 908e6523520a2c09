use mocap_report::Entry;

use crate::{
    Finished, Reference, Report, Row, Section, Stats, calibration, compare,
    figure::{Content, Dots, Figure, Legend, Value},
    reference,
    report::{STATS_NOTE, stats_table},
    summarise,
    sureness::{LENGTH_EDGES_S, length_class},
};

/// The set of trials whose gaps are of many lengths, so that its rows are told apart by length.
const MIXED: &str = "realistic";
/// The method that chooses among the others.
const AUTO: &str = "auto";

/// The leader board from finished cells.
#[must_use]
pub fn leaderboard_report(cells: &[Finished<'_>]) -> Report {
    let mut rows = summarise(cells);
    rows.extend(by_length(cells));
    let legend = Legend::of(cells.iter().map(|cell| cell.variant.label()));
    let compared = compare(&rows, &Reference::built_in());
    let statistics = [
        (
            "overview",
            "Mean error by protocol and gap",
            "Mean over trials of a trial's mean",
            mm_mean as Pick,
        ),
        (
            "median",
            "Median error by protocol and gap",
            "Median over trials of a trial's mean",
            |s| s.mm_median,
        ),
        (
            "p95",
            "95 % quantile by protocol and gap",
            "Mean over trials of a trial's 95 % quantile",
            |s| s.mm_p95,
        ),
        (
            "seconds",
            "Seconds a trial by protocol and gap",
            "Mean over trials, on one thread",
            |s| s.seconds,
        ),
    ];
    let mut sections: Vec<Section> = statistics
        .into_iter()
        .map(|(id, title, note, pick)| overview(&rows, id, title, note, pick))
        .collect();
    sections.insert(0, ranking(&rows));
    let sure = calibration::by_method(cells);
    sections.push(calibration::table(&sure));
    sections.push(reference::table(&compared));
    sections.retain(|section| !section.table.is_empty());
    let all: Vec<&Row> = rows.iter().collect();
    sections.push(stats_table("leaderboard", "Every figure", STATS_NOTE, &all));
    let mut figures: Vec<Figure> =
        sets(&rows).into_iter().map(|set| dots(&rows, set, &legend)).collect();
    figures.extend(calibration::figure(&sure, &legend));
    Report {
        title: "Leader board of the gap-filling methods".to_owned(),
        intro: vec![
            "Every method sees the visible samples and nothing else, and chooses its own coordinates."
                .to_owned(),
        ],
        findings: Vec::new(),
        sections,
        figures,
        rows,
        duels: Vec::new(),
        compared,
    }
}

/// The cells of mixed gaps by class of length, each trial counting once in each of its classes.
fn by_length(cells: &[Finished<'_>]) -> Vec<Row> {
    let mixed = cells.iter().filter(|cell| cell.trial.set == MIXED);
    let parts: Vec<(&Finished<'_>, usize, crate::Outcome)> = mixed
        .flat_map(|cell| {
            let classes = cell.outcome.by_length.iter();
            classes.map(move |class| (cell, class.class, class.alone(&cell.outcome)))
        })
        .collect();
    let mut rows = Vec::new();
    for class in 0..=LENGTH_EDGES_S.len() {
        let own: Vec<_> = parts.iter().filter(|part| part.1 == class).collect();
        let mut methods: Vec<&str> = Vec::new();
        for (cell, _, _) in &own {
            if !methods.contains(&cell.variant.label()) {
                methods.push(cell.variant.label());
            }
        }
        rows.extend(methods.into_iter().map(|method| {
            let of_method = own.iter().filter(|part| part.0.variant.label() == method);
            Row {
                set: MIXED.to_owned(),
                class: length_class(class),
                coordinates: own[0].0.coordinates,
                knowledge: own[0].0.knowledge,
                method: method.to_owned(),
                stats: Stats::of(of_method.map(|part| &part.2)),
            }
        }));
    }
    rows
}

fn distinct<'a>(rows: &'a [Row], of: impl Fn(&'a Row) -> &'a str) -> Vec<&'a str> {
    let mut names = Vec::new();
    for row in rows {
        if !names.contains(&of(row)) {
            names.push(of(row));
        }
    }
    names
}

fn sets(rows: &[Row]) -> Vec<&str> {
    distinct(rows, |row| &row.set)
}

type Pick = fn(&Stats) -> Option<f64>;

fn mm_mean(stats: &Stats) -> Option<f64> {
    stats.mm_mean
}

fn stats<'a>(rows: &'a [Row], set: &str, class: &str, method: &str) -> Option<&'a Stats> {
    let is_it = |row: &&Row| row.set == set && row.class == class && row.method == method;
    rows.iter().find(is_it).map(|row| &row.stats)
}

/// Every protocol with its classes.
fn places(rows: &[Row]) -> Vec<(&str, &str)> {
    let mut places = Vec::new();
    for set in sets(rows) {
        for row in rows.iter().filter(|row| row.set == set) {
            if !places.contains(&(set, row.class.as_str())) {
                places.push((set, row.class.as_str()));
            }
        }
    }
    places
}

/// The three best of those that filled everything, and `auto` by the best.
fn ranking(rows: &[Row]) -> Section {
    let row = |(set, class): (&str, &str)| {
        let of_place = rows.iter().filter(|row| row.set == set && row.class == class);
        let mut ranked: Vec<(f64, &str)> = of_place
            .filter(|row| row.stats.unfilled == 0)
            .filter_map(|row| Some((row.stats.mm_mean?, row.method.as_str())))
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut line = vec![Entry::text(set), Entry::text(class)];
        for place in 0..3 {
            let entry = ranked.get(place);
            line.push(entry.map_or(Entry::Empty, |(_, method)| Entry::text(method)));
            line.push(Entry::number(entry.map(|(mm, _)| *mm), 1));
        }
        let auto = ranked.iter().find(|(_, method)| *method == AUTO);
        let ratio = auto.zip(ranked.first()).map(|(auto, best)| auto.0 / best.0);
        line.push(Entry::number(ratio, 2));
        line
    };
    Section::new(
        "ranking",
        "The best by protocol and gap",
        "Mean over trials of a trial's mean error in mm, of the methods that filled every sample. The \
         last column is `auto` by the best: 1 where it is the best itself.",
        &[
            "protocol",
            "gap",
            "best",
            "best mm",
            "second",
            "second mm",
            "third",
            "third mm",
            "auto by best",
        ],
        places(rows).into_iter().map(row),
    )
}

/// Methods by protocol and gap: one statistic.
fn overview(rows: &[Row], id: &str, title: &str, what: &str, pick: Pick) -> Section {
    let methods = distinct(rows, |row| &row.method);
    let mut columns = vec!["protocol", "gap"];
    columns.extend(&methods);
    let is_time = id == "seconds";
    let unit = if is_time { "" } else { ", in mm" };
    let note = format!(
        "{what}{unit}. In brackets the share of the hidden samples that was filled, where it is not all: \
         such a figure leaves out what the method found too hard, and is not to be compared. An en \
         dash: nothing was filled."
    );
    let row = |(set, class): (&str, &str)| {
        let mut line = vec![Entry::text(set), Entry::text(class)];
        let entry = |method: &&str| {
            let stats = stats(rows, set, class, method)?;
            let value = pick(stats)?;
            let share = 100.0 * (stats.hidden - stats.unfilled) as f64 / stats.hidden.max(1) as f64;
            Some(match (is_time, stats.unfilled) {
                (true, _) => Entry::number(Some(value), 3),
                (false, 0) => Entry::number(Some(value), 1),
                (false, _) => Entry::text(format!("{value:.1} ({:.0} %)", share.floor())),
            })
        };
        line.extend(methods.iter().map(|method| entry(method).unwrap_or(Entry::Empty)));
        line
    };
    Section::new(id, title, &note, &columns, places(rows).into_iter().map(row))
}

fn dots(rows: &[Row], set: &str, legend: &Legend<'_>) -> Figure {
    let own: Vec<Row> = rows.iter().filter(|row| row.set == set).cloned().collect();
    let classes = distinct(&own, |row| &row.class);
    let series = distinct(&own, |row| &row.method).into_iter().map(|method| {
        let means = classes.iter().map(|class| {
            let stats = stats(rows, set, class, method)?;
            Some(Value { value: stats.mm_mean?, is_whole: stats.unfilled == 0 })
        });
        (method.to_owned(), legend.style(method), means.collect())
    });
    Figure {
        id: format!("leaderboard-{set}"),
        title: format!("Mean 3-D error, protocol {set}"),
        caption:
            "Mean over trials, on a logarithmic axis: further left is better. A method without a \
                  mark left all samples open."
                .to_owned(),
        content: Content::Dots(Dots {
            x_label: "mean 3-D error [mm]".to_owned(),
            series: series.collect(),
            rows: classes.into_iter().map(str::to_owned).collect(),
        }),
    }
}
