use mocap_core::Bone;

use super::{
    PlotInput,
    cell::{Cell, FILLED_PEN, Frame, MEASURED_PEN, NOMINAL_PEN, TRUTH_PEN},
    curve::Curve,
    timeline::Timeline,
};
use crate::{
    ReportError,
    draw::{Align, Backend, Canvas, Drawing, Pen, colour},
    summary::counted,
};

pub(super) const WIDTH: f64 = 1200.0;
pub(super) const MARGIN: f64 = 28.0;
pub(super) const COLUMNS: usize = 3;
pub(super) const CELL_HEIGHT: f64 = 172.0;
/// Title, subtitle and legend.
pub(super) const HEADER_HEIGHT: f64 = 98.0;
const HEADING_HEIGHT: f64 = 30.0;
/// Room below the last row of charts, for the name of their time axis.
pub(super) const FOOT_HEIGHT: f64 = 26.0;
/// Markers drawn when none are asked for.
const DEFAULT_MARKERS: usize = 3;
/// Bones that fit on a page.
const MAX_BONES: usize = 9;

/// A figure laid out: header, gap timeline, trajectories, bone lengths.
pub(super) struct Page<'a> {
    input: &'a PlotInput<'a>,
    timeline: Timeline,
    trajectories: Grid,
    bones: Grid,
}

/// Small charts under one heading, row by row.
struct Grid {
    heading: String,
    curves: Vec<Curve>,
}

impl Grid {
    fn height(&self) -> f64 {
        if self.curves.is_empty() {
            return 0.0;
        }
        self.curves.len().div_ceil(COLUMNS) as f64 * CELL_HEIGHT + FOOT_HEIGHT
    }
}

impl<'a> Page<'a> {
    pub(super) fn plan(input: &'a PlotInput<'a>) -> Self {
        let markers = input.markers.clone().unwrap_or_else(|| most_affected(input));
        let coordinates = |m: usize| (0..3).map(move |axis| Curve::coordinate(input, m, axis));
        let trajectories = Grid {
            heading: "Trajectories".to_owned(),
            curves: markers.iter().copied().flat_map(coordinates).collect(),
        };
        let timeline = Timeline::of(input);
        Self { input, timeline, trajectories, bones: bone_grid(input, &markers) }
    }

    fn draw_header<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError> {
        let title = super::cell::shorten(self.input.title, 96);
        canvas.text(&title, (MARGIN, 38.0), 21.0, Align::Left, colour::INK)?;
        canvas.text(&self.subtitle(), (MARGIN, 60.0), 13.0, Align::Left, colour::FAINT)?;
        let mut left = MARGIN;
        for (name, key) in self.legend() {
            let pen = key.pen();
            let line = [(left, 80.0), (left + 30.0, 80.0)];
            canvas.polyline(&line, pen)?;
            canvas.text(name, (left + 37.0, 84.5), 12.5, Align::Left, colour::INK)?;
            // Letters are about 0.55 of their size wide on average; the rest is space between entries.
            left += 37.0 + 0.55 * 12.5 * name.chars().count() as f64 + 26.0;
        }
        Ok(())
    }

    fn subtitle(&self) -> String {
        let take = self.input.take;
        let frames = take.frames();
        let (all, measured, present) = self.counts();
        let percent = |count: usize| 100.0 * count as f64 / all.max(1) as f64;
        format!(
            "{}, {} at {} Hz ({:.2} s): {:.1} % measured, {:.1} % filled, {:.1} % missing",
            counted(take.marker_count(), "marker"),
            counted(frames, "frame"),
            take.rate_hz(),
            frames as f64 / take.rate_hz(),
            percent(measured),
            percent(present - measured),
            percent(all - present),
        )
    }

    /// Cells in all, cells that were measured, and cells that were measured or filled.
    fn counts(&self) -> (usize, usize, usize) {
        let (take, measured) = (self.input.take, self.input.measured);
        let present = take.observed().count();
        let measured = take.observed().iter().filter(|&(t, m)| measured.contains(t, m)).count();
        (take.frames() * take.marker_count(), measured, present)
    }

    fn legend(&self) -> Vec<(&'static str, Key)> {
        let truth = self.input.truth.map(|_| ("true, in gaps", Key::Truth));
        let nominal = (!self.bones.curves.is_empty()).then_some(("bone length", Key::Nominal));
        let (all, measured, present) = self.counts();
        let filled = (present > measured).then_some(("filled", Key::Filled));
        let missing = (all > present).then_some(("missing", Key::Missing));
        let states = [("measured", Key::Measured)].into_iter().chain(filled).chain(missing);
        states.chain(truth).chain(nominal).collect()
    }
}

impl Drawing for Page<'_> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few thousand
    fn size(&self) -> (u32, u32) {
        let sections = [self.timeline.height(), self.trajectories.height(), self.bones.height()];
        let headings = HEADING_HEIGHT * sections.len() as f64;
        let height = HEADER_HEIGHT + headings + sections.iter().sum::<f64>() + MARGIN;
        (WIDTH as u32, height.ceil() as u32)
    }

    fn draw<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError> {
        self.draw_header(canvas)?;
        let mut top = HEADER_HEIGHT;
        heading(canvas, "A", &self.timeline.heading(), top)?;
        top += HEADING_HEIGHT;
        self.timeline.draw(canvas, MARGIN, WIDTH - MARGIN, top)?;
        top += self.timeline.height();
        for (letter, grid) in [("B", &self.trajectories), ("C", &self.bones)] {
            heading(canvas, letter, &grid.heading, top)?;
            top += HEADING_HEIGHT;
            draw_grid(canvas, &grid.curves, top, self.input.take.rate_hz())?;
            top += grid.height();
        }
        Ok(())
    }
}

#[derive(Debug, Clone, Copy)]
enum Key {
    Measured,
    Filled,
    Missing,
    Truth,
    Nominal,
}

impl Key {
    fn pen(self) -> Pen {
        match self {
            Self::Measured => MEASURED_PEN,
            Self::Filled => FILLED_PEN,
            Self::Missing => Pen::solid(colour::MISSING, 8.0),
            Self::Truth => TRUTH_PEN,
            Self::Nominal => NOMINAL_PEN,
        }
    }
}

fn heading<DB: Backend>(
    canvas: &mut Canvas<'_, DB>,
    letter: &str,
    text: &str,
    top: f64,
) -> Result<(), ReportError> {
    canvas.text(letter, (MARGIN, top + 20.0), 16.0, Align::Left, colour::INK)?;
    canvas.text(text, (MARGIN + 22.0, top + 20.0), 14.0, Align::Left, colour::INK)
}

/// Small charts row by row, the lowest ones with a name for their time axis.
pub(super) fn draw_grid<DB: Backend>(
    canvas: &mut Canvas<'_, DB>,
    curves: &[Curve],
    top: f64,
    rate_hz: f64,
) -> Result<(), ReportError> {
    let width = (WIDTH - 2.0 * MARGIN) / COLUMNS as f64;
    for (i, curve) in curves.iter().enumerate() {
        let (row, column) = (i / COLUMNS, i % COLUMNS);
        let left = MARGIN + column as f64 * width;
        let frame = Frame { left, top: top + row as f64 * CELL_HEIGHT, width, height: CELL_HEIGHT };
        Cell::new(curve, frame, rate_hz).draw(canvas)?;
        let is_lowest = i + COLUMNS >= curves.len();
        if is_lowest {
            let at = (left + 52.0 + 0.5 * (width - 64.0), frame.top + CELL_HEIGHT + 10.0);
            canvas.text("time (s)", at, 11.5, Align::Centre, colour::INK)?;
        }
    }
    Ok(())
}

/// The markers that lack the most measured samples; of a take without gaps, the first.
///
/// Markers without any sample come last: there is nothing to draw.
fn most_affected(input: &PlotInput<'_>) -> Vec<usize> {
    let frames = input.take.frames();
    let lacking = |m: usize| (0..frames).filter(|&t| !input.measured.contains(t, m)).count();
    let unseen = |m: usize| (0..frames).all(|t| !input.take.is_observed(t, m));
    let mut ranked: Vec<(bool, usize, usize)> =
        (0..input.take.marker_count()).map(|m| (unseen(m), lacking(m), m)).collect();
    ranked.sort_by_key(|&(unseen, lacking, m)| (unseen, std::cmp::Reverse(lacking), m));
    let some_lack = ranked.iter().any(|&(unseen, lacking, _)| !unseen && lacking > 0);
    ranked.retain(|&(_, lacking, _)| lacking > 0 || !some_lack);
    ranked.into_iter().map(|(_, _, m)| m).take(DEFAULT_MARKERS).collect()
}

/// The bones that end at the drawn markers, those that lack the most measured frames first.
fn bone_grid(input: &PlotInput<'_>, markers: &[usize]) -> Grid {
    let ends_at = |bone: &&Bone| markers.iter().any(|&m| bone.other(m).is_some());
    let mut curves: Vec<Curve> =
        input.bones.bones().iter().filter(ends_at).map(|bone| Curve::bone(input, bone)).collect();
    let all = curves.len();
    let lacking = |curve: &Curve| curve.measured.iter().filter(|&&m| !m).count();
    curves.sort_by_key(|curve| std::cmp::Reverse(lacking(curve)));
    curves.truncate(MAX_BONES);
    let heading = match (all, curves.len()) {
        (0, _) => "Bone lengths: no bone ends at these markers".to_owned(),
        (all, shown) if shown < all => {
            format!("Bone lengths: {shown} of the {all} bones that end at these markers")
        }
        _ => "Bone lengths".to_owned(),
    };
    Grid { heading, curves }
}
