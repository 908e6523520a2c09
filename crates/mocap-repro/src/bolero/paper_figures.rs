//! Figures 1 to 3 of [Li10]: coordinates, bone lengths and stills of single fills.

use std::sync::Arc;

use mocap_core::{MarkerKnowledge, Take};
use mocap_report::draw::{
    Pen, Point,
    colour::{self, RGBColor},
};

use super::Evaluation;
use crate::{
    Coordinates, Knowledge, Motion, ReproError, Trial, Variant,
    cell::Job,
    figure::{Axis, Chart, Content, Figure, Key, Line, Mark, Panel, Panels, Still, colours},
};

/// What the paper calls the methods of its figures.
const NAMES: [(&str, &str); 6] = [
    ("spline", "spline"),
    ("msvd", "MSVD"),
    ("dynammo+published", "LDS/DynaMMo"),
    ("bolero-hc+published", "BoLeRO-HC"),
    ("bolero-sc+published", "BoLeRO-SC"),
    ("auto", "auto (ours)"),
];
const CM_PER_M: f64 = 100.0;

/// A fill under a name; the original motion first.
struct Version {
    name: String,
    take: Take,
}

/// One case with the fills of some methods.
struct Case<'a> {
    trial: &'a Trial,
    /// Hidden markers.
    markers: Vec<usize>,
    /// Bones that touch one of them.
    bones: Vec<(usize, usize)>,
    all_bones: Vec<(usize, usize)>,
    versions: Vec<Version>,
}

/// The three figures, with fills in body coordinates and the knowledge of an oracle, as in the paper.
/// Methods that are not among the variants are left out.
///
/// # Errors
/// As [`run`](crate::run).
pub(super) fn figures(
    evaluation: &Evaluation,
    variants: &[Variant],
    iterations: Option<usize>,
) -> Result<Vec<Figure>, ReproError> {
    let with_bones = ["dynammo+published", "bolero-hc+published", "bolero-sc+published", "auto"];
    let mut figures = Vec::new();
    let case = |name: &str, methods: &[&str]| {
        let trial = evaluation.case(name);
        let found = trial.and_then(|trial| Some((trial, evaluation.motion(trial)?)));
        found
            .map(|(trial, motion)| Case::fill(trial, motion, variants, methods, iterations))
            .transpose()
    };
    if let Some(walking) = case(&evaluation.walking, &with_bones)? {
        let title = format!("Fig. 1: bone lengths and stills, {}", walking.trial.name);
        figures.push(walking.bodies("fig-1", title, evaluation.stills[0]));
    }
    let coordinates = ["spline", "msvd", "dynammo+published", "bolero-sc+published", "auto"];
    if let Some(running) = case(&evaluation.running, &coordinates)? {
        figures.push(running.coordinates());
    }
    if let Some(running) = case(&evaluation.running, &with_bones)? {
        let title = format!("Fig. 3: stills and bone lengths, {}", running.trial.name);
        figures.push(running.bodies("fig-3", title, evaluation.stills[1]));
    }
    Ok(figures)
}

impl<'a> Case<'a> {
    fn fill(
        trial: &'a Trial,
        motion: &Arc<Motion>,
        variants: &[Variant],
        methods: &[&str],
        iterations: Option<usize>,
    ) -> Result<Self, ReproError> {
        let (mut versions, mut truth) = (Vec::new(), None);
        for method in methods {
            let Some(variant) = variants.iter().find(|v| v.label() == *method) else { continue };
            let job = Job {
                trial,
                motion,
                variant,
                coordinates: Coordinates::Body,
                knowledge: Knowledge::Oracle,
                iterations,
            };
            let (holdout, filled) = job.fill()?;
            truth.get_or_insert_with(|| holdout.truth().clone());
            if let Ok(filling) = filled {
                let name =
                    NAMES.iter().find(|name| name.0 == *method).map_or(*method, |name| name.1);
                versions
                    .push(Version { name: name.to_owned(), take: filling.filled.take().clone() });
            }
        }
        let truth = truth.unwrap_or_else(|| motion.take().clone());
        let known = MarkerKnowledge::cmu_41();
        let all_bones = known.bone_pairs(truth.markers());
        let find = |hide: &crate::Hide| truth.markers().find(&hide.marker).ok();
        let markers: Vec<usize> = trial.hidden.iter().filter_map(find).collect();
        let touches =
            |bone: &&(usize, usize)| markers.contains(&bone.0) || markers.contains(&bone.1);
        let bones = all_bones.iter().filter(touches).copied().collect();
        versions.insert(0, Version { name: "original".to_owned(), take: truth });
        Ok(Self { trial, markers, bones, all_bones, versions })
    }

    fn truth(&self) -> &Take {
        &self.versions[0].take
    }

    /// First and last hidden frame, from 1.
    fn gap(&self) -> (f64, f64) {
        let hide = &self.trial.hidden[0];
        (hide.start as f64 + 1.0, hide.end as f64)
    }

    fn marker(&self, marker: usize) -> &str {
        self.truth().markers().split(marker).1
    }

    /// Fig. 2: the coordinates of the first hidden marker.
    fn coordinates(&self) -> Figure {
        let marker = self.markers.first().copied().unwrap_or(0);
        let pens = [colours::BLUE, colours::GREEN, colours::VERMILION];
        let curve = |take: &Take, axis: usize| -> Vec<(f64, f64)> {
            frames(take, |t| take.position(t, marker).map(|p| p[axis]))
        };
        let all = (0..3).flat_map(|axis| {
            self.versions.iter().flat_map(move |version| curve(&version.take, axis))
        });
        let y = Axis::around(all.map(|point| point.1));
        let x = Axis::linear(1.0, self.truth().frames() as f64);
        let chart = |version: &Version| {
            let line = |axis: usize, take, pen| Line { points: curve(take, axis), pen };
            let truth =
                (0..3).map(|axis| line(axis, self.truth(), Pen::dashed(colour::MEASURED, 1.1)));
            let own = (0..3).map(|axis| line(axis, &version.take, Pen::solid(pens[axis], 1.8)));
            Panel::Chart(Box::new(Chart {
                heading: version.name.clone(),
                x,
                y,
                names: Vec::new(),
                x_label: "frame".to_owned(),
                y_label: "coordinate [m]".to_owned(),
                shade: Some(self.gap()),
                diagonal: false,
                lines: truth.chain(own).collect(),
                points: Vec::new(),
            }))
        };
        let key = |name: &str, pen| Key { name: name.to_owned(), mark: Mark::Line(pen) };
        Figure {
            id: "fig-2".to_owned(),
            title: format!("Fig. 2: coordinates of {}, {}", self.marker(marker), self.trial.name),
            caption:
                "Body coordinates: x to the front, y to the left, z up. The hidden frames are \
                      shaded; the original is dashed in every chart."
                    .to_owned(),
            content: Content::Panels(Panels {
                columns: 2,
                row_height: 235.0,
                cells: self.versions.iter().map(chart).collect(),
                legend: vec![
                    key("x", Pen::solid(pens[0], 1.8)),
                    key("y", Pen::solid(pens[1], 1.8)),
                    key("z", Pen::solid(pens[2], 1.8)),
                    key("original", Pen::dashed(colour::MEASURED, 1.1)),
                ],
            }),
        }
    }

    /// Figs. 1 and 3: a still of each version above the lengths of the bones of interest.
    fn bodies(&self, id: &str, title: String, still: usize) -> Figure {
        let frame = (still - 1).min(self.truth().frames() - 1);
        let columns = self.versions.len();
        let mut panels: Vec<Panel> =
            self.versions.iter().map(|version| self.still(version, frame)).collect();
        let lengths = |take: &Take, (a, b): (usize, usize)| {
            frames(take, |t| take.distance(t, a, b).map(|d| CM_PER_M * d))
        };
        let all = self.versions.iter().flat_map(|version| {
            self.bones.iter().flat_map(move |&bone| lengths(&version.take, bone))
        });
        let y = Axis::around(all.map(|point| point.1));
        let x = Axis::linear(1.0, self.truth().frames() as f64);
        panels.extend(self.versions.iter().map(|version| {
            let line = |(bone, pen): (&(usize, usize), RGBColor)| Line {
                points: lengths(&version.take, *bone),
                pen: Pen::solid(pen, 1.7),
            };
            Panel::Chart(Box::new(Chart {
                heading: version.name.clone(),
                x,
                y,
                names: Vec::new(),
                x_label: "frame".to_owned(),
                y_label: "bone length [cm]".to_owned(),
                shade: Some(self.gap()),
                diagonal: false,
                lines: self.bones.iter().zip(palette()).map(line).collect(),
                points: Vec::new(),
            }))
        }));
        let legend = self.bones.iter().zip(palette()).map(|(&(a, b), pen)| Key {
            name: format!("{}\u{2013}{}", self.marker(a), self.marker(b)),
            mark: Mark::Line(Pen::solid(pen, 3.2)),
        });
        Figure {
            id: id.to_owned(),
            title,
            caption: format!(
                "Above: frame {still}, seen from the right, with the hidden markers as black dots. Below: \
                 the lengths of the bones that end at a hidden marker, which ought to be constant; the \
                 hidden frames are shaded."
            ),
            content: Content::Panels(Panels {
                columns,
                row_height: 270.0,
                cells: panels,
                legend: legend.collect(),
            }),
        }
    }

    fn still(&self, version: &Version, frame: usize) -> Panel {
        let at = |marker: usize| version.take.position(frame, marker).map(seen);
        let ends = |&(a, b): &(usize, usize)| Some([at(a)?, at(b)?]);
        let bold = self.bones.iter().zip(palette());
        // The original's extent for all, so that bodies can be compared.
        let truth: Vec<Point> = (0..self.truth().marker_count())
            .filter_map(|m| self.truth().position(frame, m).map(seen))
            .collect();
        let low = |axis: fn(&Point) -> f64| truth.iter().map(axis).fold(f64::INFINITY, f64::min);
        let high =
            |axis: fn(&Point) -> f64| truth.iter().map(axis).fold(f64::NEG_INFINITY, f64::max);
        Panel::Still(Still {
            heading: format!("{}, frame {}", version.name, frame + 1),
            bones: self.all_bones.iter().filter_map(ends).collect(),
            bold: bold.filter_map(|(bone, pen)| Some((ends(bone)?, pen))).collect(),
            markers: (0..version.take.marker_count()).filter_map(at).collect(),
            hidden: self.markers.iter().filter_map(|&marker| at(marker)).collect(),
            window: [low(|p| p.0), high(|p| p.0), low(|p| p.1), high(|p| p.1)],
        })
    }
}

/// Body coordinates as seen from the right and a little from the front, in metres.
fn seen([x, y, z]: [f64; 3]) -> Point {
    const TURN: f64 = 0.45;
    (x * TURN.cos() + y * TURN.sin(), z)
}

/// A value over frames from 1; not finite where it is missing.
fn frames(take: &Take, value: impl Fn(usize) -> Option<f64>) -> Vec<(f64, f64)> {
    (0..take.frames()).map(|t| (t as f64 + 1.0, value(t).unwrap_or(f64::NAN))).collect()
}

fn palette() -> impl Iterator<Item = RGBColor> {
    [
        colours::BLUE,
        colours::VERMILION,
        colours::GREEN,
        colours::ORANGE,
        colours::PURPLE,
        colours::SKY,
    ]
    .into_iter()
    .cycle()
}
