//! Fig. 4 of [Li10]: errors motion by motion, and trial by trial.

use mocap_report::draw::colour;

use super::set;
use crate::{
    Coordinates, Finished, Knowledge, Stats,
    figure::{Axis, Bars, Chart, Content, Figure, Legend, Panel, Panels, Points, Shape, Style},
    summary::group,
};

/// The methods of Fig. 4(a), and those beyond the paper that are the most telling beside them.
const IN_BARS: [&str; 7] = [
    "dynammo+published",
    "bolero-hc+published",
    "bolero-sc+published",
    "lds",
    "bolero-hc",
    "bolero-sc",
    "auto",
];
/// The pairs of Fig. 4(b) and 4(c), and the same against exact EM.
const PAIRS: [[&str; 2]; 4] = [
    ["dynammo+published", "bolero-hc+published"],
    ["dynammo+published", "bolero-sc+published"],
    ["bolero-sc+published", "bolero-sc"],
    ["lds", "bolero-sc"],
];

/// Mean mse of each motion, method by method.
pub(super) type Means<'a> = Vec<((Coordinates, Knowledge, &'a str), Vec<Option<f64>>)>;

pub(super) fn motion_means<'a>(cells: &'a [Finished<'_>]) -> (Vec<&'a str>, Means<'a>) {
    let motions: Vec<&str> =
        group(cells, |cell| cell.trial.motion.as_str()).into_iter().map(|(name, _)| name).collect();
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

/// Bars and scatter plots for each condition of a set of trials.
pub(super) fn figures(cells: &[Finished<'_>]) -> Vec<Figure> {
    let aside = [set::CASES, set::PART, set::MASKS, set::LAMBDA, set::SEEDS, set::CAPS];
    let own: Vec<Finished<'_>> =
        cells.iter().filter(|cell| !aside.contains(&cell.trial.set.as_str())).cloned().collect();
    let conditions =
        group(&own, |cell| (cell.trial.set.as_str(), cell.coordinates, cell.knowledge));
    let mut figures = Vec::new();
    for ((set, coordinates, knowledge), members) in conditions {
        let members: Vec<Finished<'_>> = members.into_iter().cloned().collect();
        let class = &members[0].trial.class;
        let what = format!("{class}; {coordinates} coordinates, told {knowledge}");
        let id = format!("{set}-{coordinates}-{knowledge}");
        figures.push(bars(&members, &id, &what));
        figures.extend(scatter(&members, &id, &what));
    }
    figures
}

fn bars(cells: &[Finished<'_>], id: &str, what: &str) -> Figure {
    let (motions, mut means) = motion_means(cells);
    if means.iter().any(|(key, _)| IN_BARS.contains(&key.2)) {
        means.retain(|(key, _)| IN_BARS.contains(&key.2));
        means.sort_by_key(|(key, _)| IN_BARS.iter().position(|method| *method == key.2));
    }
    // A report has more methods than there are colours; these few get one each.
    let legend = Legend::of(means.iter().map(|(key, _)| key.2));
    Figure {
        id: format!("fig-4a-{id}"),
        title: format!("Fig. 4(a): mean mse by motion ({what})"),
        caption: "Mean over the trials of each motion, on a logarithmic axis; the paper's methods first. \
                  The table of means by motion has all methods."
            .to_owned(),
        content: Content::Bars(Bars {
            y_label: "mean mse [m²]".to_owned(),
            groups: motions.into_iter().map(str::to_owned).collect(),
            series: means
                .iter()
                .map(|(key, means)| (key.2.to_owned(), legend.style(key.2), means.clone()))
                .collect(),
        }),
    }
}

/// Two methods, and the errors of both on each trial.
type Pair<'a> = ([&'a str; 2], Vec<(f64, f64)>);

fn scatter(cells: &[Finished<'_>], id: &str, what: &str) -> Option<Figure> {
    let pairs: Vec<Pair<'_>> = PAIRS
        .into_iter()
        .map(|pair| (pair, points(cells, pair)))
        .filter(|(_, points)| !points.is_empty())
        .collect();
    // One scale for all, so that the charts can be compared.
    let values = || pairs.iter().flat_map(|(_, points)| points).flat_map(|(x, y)| [*x, *y]);
    let scale = Axis::logarithmic(values());
    let chart = |([x, y], points): &Pair<'_>| {
        let below = points.iter().filter(|(x, y)| y < x).count();
        let chart = Chart {
            heading: format!("{y} below the diagonal in {below} of {} trials", points.len()),
            x: scale,
            y: scale,
            names: Vec::new(),
            x_label: format!("{x}: mse [m²]"),
            y_label: format!("{y}: mse [m²]"),
            shade: None,
            diagonal: true,
            lines: Vec::new(),
            points: vec![Points {
                at: points.clone(),
                style: Style { colour: colour::FILLED, shape: Shape::Circle },
                radius: 3.6,
            }],
        };
        Panel::Chart(Box::new(chart))
    };
    (!pairs.is_empty()).then(|| Figure {
        id: format!("fig-4bc-{id}"),
        title: format!("Fig. 4(b), (c): trial by trial ({what})"),
        caption:
            "Below the diagonal the method with bones is the better one. The upper row is the \
                  paper's, against the published baseline; the lower one is against exact EM."
                .to_owned(),
        content: Content::Panels(Panels {
            columns: 2,
            row_height: 470.0,
            cells: pairs.iter().map(chart).collect(),
            legend: Vec::new(),
        }),
    })
}

/// One method against another, trial by trial.
fn points(cells: &[Finished<'_>], [x, y]: [&str; 2]) -> Vec<(f64, f64)> {
    let of = |method: &str| -> Vec<(&str, f64)> {
        let own = cells.iter().filter(|cell| cell.variant.label() == method);
        own.filter_map(|cell| Some((cell.trial.name.as_str(), cell.outcome.mse_m2?))).collect()
    };
    let (across, up) = (of(x), of(y));
    let partner =
        |(name, a): &(&str, f64)| up.iter().find(|(other, _)| other == name).map(|(_, b)| (*a, *b));
    across.iter().filter_map(partner).collect()
}
