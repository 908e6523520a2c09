use mocap_report::{Entry, draw::Pen};

use crate::{
    Finished, Reference, Report, Row, Section, Stats, Sureness,
    bolero::Legend,
    compare,
    figure::{Axis, Chart, Content, Dots, Figure, Key, Line, Mark, Panel, Panels, Points},
    reference,
    report::{STATS_NOTE, stats_table},
    summarise,
    summary::group,
    sureness::{LENGTH_EDGES_S, MULTIPLES, length_class},
};

/// The set of trials whose gaps are of many lengths, so that its rows are told apart by length.
const MIXED: &str = "realistic";
/// Class of a calibration over gaps of all lengths, and set of one over all protocols.
const ALL: &str = "all";

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
    let sure = calibration(cells);
    sections.push(calibration_table(&sure));
    sections.push(reference::table(&compared));
    sections.retain(|section| !section.table.is_empty());
    let all: Vec<&Row> = rows.iter().collect();
    sections.push(stats_table("leaderboard", "Every figure", STATS_NOTE, &all));
    let mut figures: Vec<Figure> =
        sets(&rows).into_iter().map(|set| dots(&rows, set, &legend)).collect();
    figures.extend(reliability(&sure, &legend));
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

fn value(rows: &[Row], set: &str, class: &str, method: &str, pick: Pick) -> Option<f64> {
    let is_it = |row: &&Row| row.set == set && row.class == class && row.method == method;
    pick(&rows.iter().find(is_it)?.stats)
}

/// Methods by protocol and gap: one statistic.
fn overview(rows: &[Row], id: &str, title: &str, what: &str, pick: Pick) -> Section {
    let methods = distinct(rows, |row| &row.method);
    let mut columns = vec!["protocol", "gap"];
    columns.extend(&methods);
    let unit = if id == "seconds" { "" } else { ", in mm" };
    let decimals = if id == "seconds" { 3 } else { 1 };
    let note = format!(
        "{what}{unit}. An en dash: nothing was filled; the full table says how many samples each method \
         left open, and on how many trials the row rests."
    );
    let mut lines = Vec::new();
    for set in sets(rows) {
        let own: Vec<Row> = rows.iter().filter(|row| row.set == set).cloned().collect();
        for class in distinct(&own, |row| &row.class) {
            let mut row = vec![Entry::text(set), Entry::text(class)];
            let of = |method: &&str| Entry::number(value(rows, set, class, method, pick), decimals);
            row.extend(methods.iter().map(of));
            lines.push(row);
        }
    }
    Section::new(id, title, &note, &columns, lines)
}

fn dots(rows: &[Row], set: &str, legend: &Legend<'_>) -> Figure {
    let own: Vec<Row> = rows.iter().filter(|row| row.set == set).cloned().collect();
    let classes = distinct(&own, |row| &row.class);
    let series = distinct(&own, |row| &row.method).into_iter().map(|method| {
        let means = classes.iter().map(|class| value(rows, set, class, method, mm_mean));
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

/// What became of a method's sigmas in one protocol, or in all, and in one class of lengths, or in all.
struct Sure<'a> {
    set: &'a str,
    class: String,
    method: &'a str,
    counts: Sureness,
}

fn calibration<'a>(cells: &'a [Finished<'_>]) -> Vec<Sure<'a>> {
    let mut sure = Vec::new();
    let mut add = |set, class, method, parts: Vec<&Sureness>| {
        let counts = Sureness::sum(parts);
        if counts.samples > 0 {
            sure.push(Sure { set, class, method, counts });
        }
    };
    for (method, own) in group(cells, |cell| cell.variant.label()) {
        let of_class = |own: &[&'a Finished<'_>], class: Option<usize>| -> Vec<&'a Sureness> {
            own.iter()
                .flat_map(|cell| &cell.outcome.by_length)
                .filter(|length| class.is_none_or(|class| length.class == class))
                .map(|length| &length.sureness)
                .collect()
        };
        add(ALL, ALL.to_owned(), method, of_class(&own, None));
        for class in 0..=LENGTH_EDGES_S.len() {
            add(ALL, length_class(class), method, of_class(&own, Some(class)));
        }
        let cells: Vec<Finished<'_>> = own.iter().map(|cell| (*cell).clone()).collect();
        for set in group(&cells, |cell| cell.trial.set.clone()).into_iter().map(|(set, _)| set) {
            let of_set: Vec<&Finished<'_>> =
                own.iter().copied().filter(|cell| cell.trial.set == set).collect();
            let set = of_set[0].trial.set.as_str();
            add(set, ALL.to_owned(), method, of_class(&of_set, None));
        }
    }
    sure
}

fn calibration_table(sure: &[Sure<'_>]) -> Section {
    let percent = |share: Option<f64>| Entry::number(share.map(|share| 100.0 * share), 1);
    let row = |sure: &Sure<'_>| {
        vec![
            Entry::text(sure.method),
            Entry::text(sure.set),
            Entry::text(&sure.class),
            Entry::count(sure.counts.samples),
            percent(sure.counts.share_within(1.0)),
            percent(sure.counts.share_within(2.0)),
            Entry::number(sure.counts.rms_ratio(), 2),
        ]
    };
    Section::new(
        "calibration",
        "Calibration: errors beside the sigma that a method states",
        "Share of the filled samples whose 3-D error is at most 1 and 2 sigma; 68 and 95 % is honest. `rms \
         error by sigma`: 1 is honest, above 1 sigma is too small. Methods without sigma are left out.",
        &[
            "method",
            "protocol",
            "gaps",
            "samples",
            "within 1 sigma %",
            "within 2 sigma %",
            "rms error by sigma",
        ],
        sure.iter().map(row),
    )
}

/// Share of samples within multiples of sigma, over that of a normal law.
fn reliability(sure: &[Sure<'_>], legend: &Legend<'_>) -> Option<Figure> {
    let overall: Vec<&Sure<'_>> = sure.iter().filter(|sure| sure.set == ALL).collect();
    let mut classes: Vec<&str> = Vec::new();
    let order = std::iter::once(ALL.to_owned()).chain((0..=LENGTH_EDGES_S.len()).map(length_class));
    for class in order {
        classes.extend(overall.iter().find(|s| s.class == class).map(|s| s.class.as_str()));
    }
    let nominal = metrics::Calibration::nominal_share;
    let curve = |sure: &Sure<'_>| -> Vec<(f64, f64)> {
        let points =
            MULTIPLES.map(|m| sure.counts.share_within(m).map(|share| (nominal(m), share)));
        std::iter::once((0.0, 0.0)).chain(points.into_iter().flatten()).collect()
    };
    let chart = |class: &&str| {
        let own: Vec<&&Sure<'_>> = overall.iter().filter(|sure| sure.class == **class).collect();
        let line = |sure: &&&Sure<'_>| Line {
            points: curve(sure),
            pen: Pen::solid(legend.style(sure.method).colour, 1.8),
        };
        let points = |sure: &&&Sure<'_>| Points {
            at: [1.0, 2.0]
                .into_iter()
                .filter_map(|m| Some((nominal(m), sure.counts.share_within(m)?)))
                .collect(),
            style: legend.style(sure.method),
            radius: 4.5,
        };
        let samples = own.iter().map(|sure| sure.counts.samples).max().unwrap_or(0);
        let heading = if **class == *ALL { "gaps of all lengths" } else { *class };
        Panel::Chart(Box::new(Chart {
            heading: format!("{heading} (up to {samples} samples)"),
            x: Axis::linear(0.0, 1.0),
            y: Axis::linear(0.0, 1.0),
            names: Vec::new(),
            x_label: "share that a normal law has within k sigma".to_owned(),
            y_label: "share of samples within k sigma".to_owned(),
            shade: None,
            diagonal: true,
            lines: own.iter().map(line).collect(),
            points: own.iter().map(points).collect(),
        }))
    };
    let methods = overall.iter().filter(|sure| sure.class == ALL);
    let keys = methods.map(|sure| Key {
        name: sure.method.to_owned(),
        mark: Mark::Shape(legend.style(sure.method)),
    });
    (!classes.is_empty()).then(|| Figure {
        id: "reliability".to_owned(),
        title: "Reliability of the stated sigma".to_owned(),
        caption: "On the diagonal a method is as sure as it may be; below, its sigma is too small, above, \
                  too large. The marks are 1 and 2 sigma."
            .to_owned(),
        content: Content::Panels(Panels {
            columns: 3,
            row_height: 350.0,
            cells: classes.iter().map(chart).collect(),
            legend: keys.collect(),
        }),
    })
}
