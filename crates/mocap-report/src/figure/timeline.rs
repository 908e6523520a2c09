use std::ops::Range;

use super::{
    PlotInput,
    axes::{Axes, Interval},
    cell::{shorten, span, time_axis},
    curve::runs,
};
use crate::{
    ReportError,
    draw::{Align, Backend, Canvas, colour},
    summary::counted,
};

/// One row a marker: where it was measured, filled and left open.
#[derive(Debug, Clone)]
pub(super) struct Timeline {
    rows: Vec<Row>,
    with_gaps: usize,
    markers: usize,
    frames: usize,
    rate_hz: f64,
}

#[derive(Debug, Clone)]
struct Row {
    marker: usize,
    name: String,
    measured: Vec<Range<usize>>,
    filled: Vec<Range<usize>>,
    missing: Vec<Range<usize>>,
    /// Frames that were not measured.
    lacking: usize,
    gaps: usize,
}

/// Rows that fit on a page.
const MAX_ROWS: usize = 48;
const ROW_HEIGHT: f64 = 17.0;
/// Room for the time axis below the rows.
const AXIS_HEIGHT: f64 = 42.0;

impl Timeline {
    pub(super) fn of(input: &PlotInput<'_>) -> Self {
        let (take, frames) = (input.take, input.take.frames());
        let mut rows: Vec<Row> = (0..take.marker_count())
            .map(|m| {
                let measured = |t: usize| input.measured.contains(t, m);
                let present = |t: usize| take.is_observed(t, m);
                Row {
                    marker: m,
                    name: input.name(m).to_owned(),
                    measured: runs(frames, measured),
                    filled: runs(frames, |t| !measured(t) && present(t)),
                    missing: runs(frames, |t| !measured(t) && !present(t)),
                    lacking: (0..frames).filter(|&t| !measured(t)).count(),
                    gaps: runs(frames, |t| !measured(t)).len(),
                }
            })
            .filter(|row| row.lacking > 0)
            .collect();
        let with_gaps = rows.len();
        rows.sort_by_key(|row| std::cmp::Reverse(row.lacking));
        rows.truncate(MAX_ROWS);
        rows.sort_by_key(|row| row.marker);
        Self { rows, with_gaps, markers: take.marker_count(), frames, rate_hz: take.rate_hz() }
    }

    pub(super) fn heading(&self) -> String {
        match (self.with_gaps, self.rows.len()) {
            (0, _) => format!("Gaps: none in {} markers", self.markers),
            (all, shown) if shown < all => {
                format!("Gaps: the {shown} markers that lack most, of {all} with gaps")
            }
            (all, _) => format!("Gaps: {all} of {} markers", self.markers),
        }
    }

    /// Height below the heading, in page units.
    pub(super) fn height(&self) -> f64 {
        if self.rows.is_empty() { 0.0 } else { self.rows.len() as f64 * ROW_HEIGHT + AXIS_HEIGHT }
    }

    pub(super) fn draw<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        left: f64,
        right: f64,
        top: f64,
    ) -> Result<(), ReportError> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let axes = Axes {
            left: left + 150.0,
            right: right - 130.0,
            top,
            bottom: top + self.rows.len() as f64 * ROW_HEIGHT + 2.0,
            x: time_axis(self.frames, self.rate_hz),
            y: Interval { low: 0.0, high: 1.0 },
        };
        axes.draw_x(canvas, 10)?;
        for (row, place) in self.rows.iter().zip(0_u32..) {
            self.draw_row(canvas, row, &axes, top + (f64::from(place) + 0.5) * ROW_HEIGHT)?;
        }
        axes.draw_frame(canvas)?;
        let below = (f64::midpoint(axes.left, axes.right), axes.bottom + 32.0);
        canvas.text("time (s)", below, 11.5, Align::Centre, colour::INK)
    }

    fn draw_row<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        row: &Row,
        axes: &Axes,
        middle: f64,
    ) -> Result<(), ReportError> {
        let name = shorten(&row.name, 20);
        canvas.text(&name, (axes.left - 10.0, middle + 4.0), 11.5, Align::Right, colour::INK)?;
        let states = [
            (&row.measured, colour::MEASURED, 0.75),
            (&row.filled, colour::FILLED, 5.0),
            (&row.missing, colour::MISSING, 5.0),
        ];
        for (runs, fill, half) in states {
            for run in runs {
                let (start, end) = span(run, axes, self.rate_hz);
                canvas.bar((start, middle - half), (end, middle + half), fill)?;
            }
        }
        let percent = 100.0 * row.lacking as f64 / self.frames.max(1) as f64;
        let note = format!("{percent:.1} %, {}", counted(row.gaps, "gap"));
        canvas.text(&note, (axes.right + 12.0, middle + 4.0), 11.5, Align::Left, colour::FAINT)
    }
}
