//! How honest the sigmas are that methods state.

use mocap_report::{Entry, draw::Pen};

use crate::{
    Finished, Section, Sureness,
    figure::{Axis, Chart, Content, Figure, Key, Legend, Line, Mark, Panel, Panels, Points},
    summary::group,
    sureness::{LENGTH_EDGES_S, MULTIPLES, length_class},
};

/// Class of a calibration over gaps of all lengths, and set of one over all protocols.
const ALL: &str = "all";

/// What became of a method's sigmas in one protocol, or in all, and in one class of lengths, or in all.
pub(crate) struct Sure<'a> {
    set: &'a str,
    class: String,
    method: &'a str,
    counts: Sureness,
}

/// The counts of every method that states a sigma.
pub(crate) fn by_method<'a>(cells: &'a [Finished<'_>]) -> Vec<Sure<'a>> {
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

/// Shares within 1 and 2 sigma.
pub(crate) fn table(sure: &[Sure<'_>]) -> Section {
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
pub(crate) fn figure(sure: &[Sure<'_>], legend: &Legend<'_>) -> Option<Figure> {
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
