//! The sweeps, drawn beside the published figures.

use mocap_report::draw::{Pen, colour};

use super::set;
use crate::{
    Finished, Reference,
    figure::{
        Axis, Chart, Content, Figure, Key, Legend, Line, Mark, Panel, Panels, Points, Shape, Style,
    },
    summary::group,
};

/// The figures of the sweeps.
pub(super) fn figures(cells: &[Finished<'_>], legend: &Legend<'_>) -> Vec<Figure> {
    let references = Reference::built_in();
    [lambda(cells, &references), seeds(cells, &references), caps(cells, legend)]
        .into_iter()
        .flatten()
        .collect()
}

const OURS: Style = Style { colour: colour::FILLED, shape: Shape::Circle };
const THEIRS: Style = Style { colour: colour::RGBColor(230, 159, 0), shape: Shape::Diamond };

fn key(name: &str, style: Style) -> Key {
    Key { name: name.to_owned(), mark: Mark::Shape(style) }
}

fn of_set<'b>(cells: &[Finished<'b>], set: &str) -> Vec<Finished<'b>> {
    cells.iter().filter(|cell| cell.trial.set == set).cloned().collect()
}

fn lambda(cells: &[Finished<'_>], references: &[Reference]) -> Option<Figure> {
    let own = of_set(cells, set::LAMBDA);
    let value = |label: &str| label.rsplit_once("lambda=")?.1.parse::<f64>().ok();
    let ours: Vec<(f64, f64)> = own
        .iter()
        .filter_map(|cell| Some((value(cell.variant.label())?, cell.outcome.mse_m2?)))
        .collect();
    let class = &own.first()?.trial.class;
    let theirs: Vec<(f64, f64)> = references
        .iter()
        .filter(|reference| reference.set == set::LAMBDA && reference.class == *class)
        .filter_map(|reference| Some((value(&reference.method)?, reference.value)))
        .collect();
    let all = || ours.iter().chain(&theirs);
    let chart = Chart {
        heading: class.clone(),
        x: Axis::logarithmic(all().map(|point| point.0)),
        y: Axis::logarithmic(all().map(|point| point.1)),
        names: Vec::new(),
        x_label: "weight of the bones, lambda".to_owned(),
        y_label: "mse [m²]".to_owned(),
        shade: None,
        diagonal: false,
        lines: vec![
            Line { points: theirs.clone(), pen: Pen::solid(THEIRS.colour, 1.25) },
            Line { points: ours.clone(), pen: Pen::solid(OURS.colour, 2.0) },
        ],
        points: vec![
            Points { at: theirs.clone(), style: THEIRS, radius: 4.5 },
            Points { at: ours, style: OURS, radius: 5.0 },
        ],
    };
    let mut keys = vec![key("bolero-sc+published", OURS)];
    if !theirs.is_empty() {
        keys.push(key("published code", THEIRS));
    }
    Some(Figure {
        id: "lambda".to_owned(),
        title: "Weight of the soft bone lengths".to_owned(),
        caption:
            "Small weights are the plain system; from about 1e4 on the bones are as good as hard, \
                  and more weight changes nothing."
                .to_owned(),
        content: Content::Panels(Panels {
            columns: 1,
            row_height: 320.0,
            cells: vec![Panel::Chart(Box::new(chart))],
            legend: keys,
        }),
    })
}

/// One column of points a method, ours beside the published range.
fn seeds(cells: &[Finished<'_>], references: &[Reference]) -> Option<Figure> {
    let own = of_set(cells, set::SEEDS);
    let mut panels = Vec::new();
    for (class, of_class) in group(&own, |cell| cell.trial.class.as_str()) {
        let methods = Legend::of(of_class.iter().map(|cell| cell.variant.label()));
        let place = |label: &str| methods.place(label) as f64 + 1.0;
        let ours: Vec<(f64, f64)> = of_class
            .iter()
            .filter_map(|cell| Some((place(cell.variant.label()) - 0.12, cell.outcome.mse_m2?)))
            .collect();
        let theirs: Vec<(&str, &str, f64)> = references
            .iter()
            .filter(|r| r.set == set::SEEDS && r.class == class)
            .map(|r| (r.method.as_str(), r.figure.as_str(), r.value))
            .collect();
        let range = |label: &str| {
            let of = |figure| theirs.iter().find(|r| (r.0, r.1) == (label, figure)).map(|r| r.2);
            let x = place(label) + 0.12;
            Some(vec![(x, of("mse_min")?), (x, of("mse_max")?)])
        };
        let labels = methods.labels();
        let ranges: Vec<Vec<(f64, f64)>> = labels.iter().filter_map(|m| range(m)).collect();
        let values = ours.iter().chain(ranges.iter().flatten()).map(|point| point.1);
        let names: Vec<String> =
            labels.iter().map(|label| label.replace("+start=random", "")).collect();
        let ends = ranges.concat();
        let chart = Chart {
            heading: class.to_owned(),
            x: Axis::linear(0.4, labels.len() as f64 + 0.6),
            y: Axis::logarithmic(values),
            names,
            x_label: "method, from random starts".to_owned(),
            y_label: "mse [m²]".to_owned(),
            shade: None,
            diagonal: false,
            lines: ranges
                .into_iter()
                .map(|points| Line { points, pen: Pen::solid(THEIRS.colour, 3.0) })
                .collect(),
            points: vec![
                Points { at: ends, style: THEIRS, radius: 4.0 },
                Points { at: ours, style: OURS, radius: 4.5 },
            ],
        };
        panels.push(Panel::Chart(Box::new(chart)));
    }
    let mut keys = vec![key("ours", OURS)];
    if references
        .iter()
        .any(|r| r.set == set::SEEDS && own.iter().any(|c| c.trial.class == r.class))
    {
        keys.push(key("published code, least and largest", THEIRS));
    }
    (!panels.is_empty()).then(|| Figure {
        id: "seeds".to_owned(),
        title: "Random starts: one point a seed".to_owned(),
        caption: "Every method from random starts, as published. The published range is that of five \
                  seeds of the authors' code. By default the methods here start from the data's own \
                  subspace and have no spread."
            .to_owned(),
        content: Content::Panels(Panels {
            columns: 1,
            row_height: 250.0,
            cells: panels,
            legend: keys,
        }),
    })
}

fn caps(cells: &[Finished<'_>], legend: &Legend<'_>) -> Option<Figure> {
    let own = of_set(cells, set::CAPS);
    let case = |cell: &Finished<'_>| {
        let name = cell.trial.name.as_str();
        name.rsplit_once(", ").map_or(name, |parts| parts.0).to_owned()
    };
    let mut panels = Vec::new();
    for (case, of_case) in group(&own, case) {
        let mut curves: Vec<(&str, Vec<(f64, f64)>)> = Vec::new();
        for cell in &of_case {
            let point = cell.trial.iterations.zip(cell.outcome.mse_m2);
            let Some((cap, mse)) = point else { continue };
            let label = cell.variant.label();
            match curves.iter_mut().find(|(name, _)| *name == label) {
                Some((_, points)) => points.push((cap as f64, mse)),
                None => curves.push((label, vec![(cap as f64, mse)])),
            }
        }
        let all = || curves.iter().flat_map(|(_, points)| points);
        let chart = Chart {
            heading: case,
            x: Axis::logarithmic(all().map(|point| point.0)),
            y: Axis::logarithmic(all().map(|point| point.1)),
            names: Vec::new(),
            x_label: "EM iterations".to_owned(),
            y_label: "mse [m²]".to_owned(),
            shade: None,
            diagonal: false,
            lines: curves
                .iter()
                .map(|(label, points)| Line {
                    points: points.clone(),
                    pen: Pen::solid(legend.style(label).colour, 1.6),
                })
                .collect(),
            points: curves
                .iter()
                .map(|(label, points)| Points {
                    at: points.clone(),
                    style: legend.style(label),
                    radius: 4.5,
                })
                .collect(),
        };
        panels.push(Panel::Chart(Box::new(chart)));
    }
    let labels = group(&own, |cell| cell.variant.label());
    let keys = labels.iter().map(|(label, _)| key(label, legend.style(label))).collect();
    (!panels.is_empty()).then(|| Figure {
        id: "iterations".to_owned(),
        title: "Error by EM iteration".to_owned(),
        caption: "Each point is a run that was stopped after so many iterations; a method that converges \
                  earlier stays where it is."
            .to_owned(),
        content: Content::Panels(Panels { columns: 2, row_height: 340.0, cells: panels, legend: keys }),
    })
}
