//! Synthetic people beside captured ones: how they bend, how fast they are, how long their bones are.

use std::path::Path;

use mocap_report::{
    Entry,
    draw::{Pen, colour::RGBColor},
};
use mocap_synth::Activity;

use crate::{
    Report, ReproError, Section,
    figure::{
        Axis, Chart, Content, Figure, Key, Line, Mark, Panel, Panels, Points, Shape, Style, colours,
    },
};

mod angles;
mod bones;
mod takes;

use angles::{ANGLES, Angles};
use takes::{Group, Rates};

/// What is compared, as axes and tables name it.
const RATES: [&str; 3] =
    ["speed, m/s", "acceleration over 67 ms, m/s²", "acceleration over 167 ms, m/s²"];
/// Quantiles of which tables and figures are made.
const SHARES: [f64; 5] = [0.05, 0.25, 0.5, 0.9, 0.99];
const CAPTURED: RGBColor = colours::BLACK;
const SYNTHETIC: RGBColor = colours::VERMILION;

/// Distributions of `mocap-synth` beside those of recordings in the folder of all data: joint angles and joints' speeds of
/// AMC takes by activity, markers' speeds and accelerations, and bones. Files that are not there are left out.
///
/// # Errors
/// [`ReproError::NoTakes`] if the folder holds none of the recordings, [`ReproError::Read`] for one that cannot be
/// read, [`ReproError::Synth`] for one that cannot be put on a body.
pub fn synth_report(data: &Path, progress: &mut dyn FnMut(&str)) -> Result<Report, ReproError> {
    let groups = takes::read(data, progress)?;
    let bones = bones::measure(data)?;
    let mut sections = vec![rates_table(&groups), angles_table(&groups)];
    sections.push(bones::table(&bones));
    let figures = vec![rates_figure(&groups), angles_figure(&groups), bones::figure(&bones)];
    Ok(Report {
        title: "Synthetic people beside captured ones".into(),
        intro: vec![
            "Captured motions are put on the template of `mocap-synth` first, so that angles mean the same on both sides. \
             Speeds are central differences over 17 ms, accelerations over 67 ms and over 167 ms: captured joints are fits \
             frame by frame, whose jitter is no motion and fades over the longer span. Captured markers were smoothed, which \
             synthetic ones are not."
                .into(),
        ],
        findings: Vec::new(),
        sections,
        figures,
        rows: Vec::new(),
        duels: Vec::new(),
        compared: Vec::new(),
    })
}

/// The value that a share of the sorted values lies below.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    Some(sorted[(share * last as f64).round() as usize])
}

fn rates_table(groups: &[Group]) -> Section {
    let columns =
        ["activity", "of", "takes", "captured", "rate", "5 %", "25 %", "50 %", "90 %", "99 %"];
    let mut rows = Vec::new();
    for group in groups {
        let kinds = [
            ("joints", &group.joints, group.captured_motions.as_str()),
            ("markers", &group.markers, group.captured_markers.as_str()),
        ];
        for (of, [captured, synthetic], takes) in kinds {
            if captured.takes == 0 {
                continue;
            }
            for (pick, rate) in RATES.into_iter().enumerate() {
                let [own, other] = [captured, synthetic].map(|rates| rates.sorted(pick));
                let mut row = vec![
                    Entry::text(group.activity),
                    Entry::text(of),
                    Entry::count(captured.takes),
                    Entry::text(takes),
                    Entry::text(rate),
                ];
                row.extend(SHARES.map(|share| {
                    let pair = quantile(own, share).zip(quantile(other, share));
                    let text = pair.map(|(a, b)| format!("{a:.2} / {b:.2} ({:.2})", b / a));
                    Entry::text(text.unwrap_or_default())
                }));
                rows.push(row);
            }
        }
    }
    let note =
        "Captured / synthetic (ratio) at five quantiles over all frames and joints or markers.";
    Section::new("synth-rates", "Speeds and accelerations", note, &columns, rows)
}

fn angles_table(groups: &[Group]) -> Section {
    let columns =
        ["activity", "angle", "captured 5 %", "50 %", "95 %", "synthetic 5 %", "50 %", "95 %"];
    let mut rows = Vec::new();
    for group in groups.iter().filter(|group| group.joints[0].takes > 0) {
        for (n, name) in ANGLES.iter().enumerate() {
            let mut row = vec![Entry::text(group.activity), Entry::text(name)];
            for angles in &group.angles {
                row.extend(
                    [0.05, 0.5, 0.95]
                        .map(|share| Entry::number(quantile(angles.sorted(n), share), 0)),
                );
            }
            rows.push(row);
        }
    }
    let note = "Degrees, both sides of the body together.";
    Section::new("synth-angles", "Joint angles", note, &columns, rows)
}

fn key(name: &str, colour: RGBColor) -> Key {
    Key { name: name.into(), mark: Mark::Line(Pen::solid(colour, 2.0)) }
}

fn legend() -> Vec<Key> {
    vec![key("captured", CAPTURED), key("synthetic", SYNTHETIC)]
}

/// Shares below a speed or an acceleration, activity by activity.
fn rates_figure(groups: &[Group]) -> Figure {
    let mut cells = Vec::new();
    for group in groups {
        for (of, pair) in [("joints", &group.joints), ("markers", &group.markers)] {
            if pair[0].takes == 0 {
                continue;
            }
            for (pick, x_label) in RATES.into_iter().enumerate() {
                let lines: Vec<Line> = pair
                    .iter()
                    .zip([CAPTURED, SYNTHETIC])
                    .map(|(rates, colour)| Line {
                        points: curve(rates.sorted(pick), [0.01, 0.1, 0.1][pick]),
                        pen: Pen::solid(colour, 1.6),
                    })
                    .collect();
                let values = lines.iter().flat_map(|line| line.points.iter().map(|p| p.0));
                cells.push(Panel::Chart(Box::new(Chart {
                    heading: format!("{}, {of}", group.activity),
                    x: Axis::logarithmic(values),
                    y: Axis::linear(0.0, 1.0),
                    names: Vec::new(),
                    x_label: x_label.into(),
                    y_label: "share below".into(),
                    shade: None,
                    diagonal: false,
                    lines,
                    points: Vec::new(),
                })));
            }
        }
    }
    Figure {
        id: "synth-rates".into(),
        title: "Speeds and accelerations".into(),
        caption: "Share of frames and joints, or markers, that are slower than a speed or below an acceleration.".into(),
        content: Content::Panels(Panels { columns: 3, row_height: 220.0, cells, legend: legend() }),
    }
}

/// From the least value that matters to the 99.8 % quantile.
fn curve(sorted: &[f64], least: f64) -> Vec<(f64, f64)> {
    let shares = (1..=499).map(|k| f64::from(k) / 500.0);
    shares
        .filter_map(|share| Some((quantile(sorted, share)?, share)))
        .filter(|point| point.0 >= least)
        .collect()
}

/// Ranges of angles side by side.
fn angles_figure(groups: &[Group]) -> Figure {
    let shown = groups.iter().filter(|group| group.joints[0].takes > 0);
    let cells = shown.map(|group| {
        let ranges: [Vec<[f64; 3]>; 2] = [0, 1].map(|side| {
            let of = |n: usize, share: f64| {
                quantile(group.angles[side].sorted(n), share).unwrap_or(f64::NAN)
            };
            (0..ANGLES.len()).map(|n| [0.05, 0.5, 0.95].map(|share| of(n, share))).collect()
        });
        let names = ANGLES.iter().map(|name| (*name).to_owned()).collect();
        Panel::Chart(Box::new(range_chart(group.activity, "degrees, 5 to 95 %", names, &ranges)))
    });
    Figure {
        id: "synth-angles".into(),
        title: "Joint angles".into(),
        caption:
            "From the 5 % to the 95 % quantile, with the median, both sides of the body together."
                .into(),
        content: Content::Panels(Panels {
            columns: 1,
            row_height: 210.0,
            cells: cells.collect(),
            legend: legend(),
        }),
    }
}

/// A chart of ranges with their medians, captured and synthetic side by side.
fn range_chart(
    heading: &str,
    y_label: &str,
    names: Vec<String>,
    ranges: &[Vec<[f64; 3]>; 2],
) -> Chart {
    let mut chart = Chart {
        heading: heading.into(),
        x: Axis::linear(0.4, names.len() as f64 + 0.6),
        y: Axis::around(ranges.iter().flatten().flatten().copied()),
        names,
        x_label: String::new(),
        y_label: y_label.into(),
        shade: None,
        diagonal: false,
        lines: Vec::new(),
        points: Vec::new(),
    };
    for ((side, colour), shift) in ranges.iter().zip([CAPTURED, SYNTHETIC]).zip([-0.12, 0.12]) {
        let at = |n: usize| n as f64 + 1.0 + shift;
        chart.lines.extend(side.iter().enumerate().map(|(n, [low, _, high])| Line {
            points: vec![(at(n), *low), (at(n), *high)],
            pen: Pen::solid(colour, 3.0),
        }));
        chart.points.push(Points {
            at: side.iter().enumerate().map(|(n, [_, middle, _])| (at(n), *middle)).collect(),
            style: Style { colour, shape: Shape::Circle },
            radius: 4.0,
        });
    }
    chart
}

/// Name of a generator.
fn name(activity: Activity) -> &'static str {
    activity.name()
}

impl Rates {
    /// Speeds or accelerations, sorted.
    fn sorted(&self, pick: usize) -> &[f64] {
        &self.values[pick]
    }
}

impl Angles {
    /// One angle over all frames, sorted.
    fn sorted(&self, n: usize) -> &[f64] {
        &self.degrees[n]
    }
}
