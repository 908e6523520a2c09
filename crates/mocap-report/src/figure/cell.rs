use std::ops::Range;

use plotters::style::RGBColor;

use super::{
    axes::{Axes, Interval},
    curve::{Curve, thin},
};
use crate::{
    ReportError,
    draw::{Align, Backend, Canvas, Pen, Point, colour},
};

pub(super) const MEASURED_PEN: Pen = Pen::solid(colour::MEASURED, 1.25);
pub(super) const FILLED_PEN: Pen = Pen::solid(colour::FILLED, 2.5);
pub(super) const TRUTH_PEN: Pen = Pen::dashed(colour::TRUTH, 1.25);
pub(super) const NOMINAL_PEN: Pen = Pen::solid(colour::NOMINAL, 1.25);

/// Place of a small chart on the page, its labels included.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

/// A small chart of one curve.
pub(super) struct Cell<'a> {
    curve: &'a Curve,
    axes: Axes,
    rate_hz: f64,
}

impl<'a> Cell<'a> {
    pub(super) fn new(curve: &'a Curve, frame: Frame, rate_hz: f64) -> Self {
        let axes = Axes {
            left: frame.left + 52.0,
            top: frame.top + 22.0,
            right: frame.left + frame.width - 12.0,
            bottom: frame.top + frame.height - 24.0,
            x: time_axis(curve.frames(), rate_hz),
            y: Interval::around(curve.all_values(), curve.min_span),
        };
        Self { curve, axes, rate_hz }
    }

    pub(super) fn draw<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError> {
        let (axes, curve) = (&self.axes, self.curve);
        let at = (axes.left, axes.top - 8.0);
        canvas.text(&curve.heading, at, 12.5, Align::Left, colour::INK)?;
        self.shade(canvas, &curve.filled_runs(), colour::SHADE)?;
        self.shade(canvas, &curve.missing_runs(), colour::OPEN_SHADE)?;
        axes.draw_x(canvas, 5)?;
        if curve.is_empty() {
            let middle =
                (f64::midpoint(axes.left, axes.right), f64::midpoint(axes.top, axes.bottom));
            canvas.text("no samples", middle, 12.5, Align::Centre, colour::FAINT)?;
            return axes.draw_frame(canvas);
        }
        axes.draw_y(canvas, 4)?;
        if let Some(nominal) = curve.nominal {
            let (start, end) = (axes.at(axes.x.low, nominal), axes.at(axes.x.high, nominal));
            canvas.polyline(&[start, end], NOMINAL_PEN)?;
        }
        for run in curve.measured_runs() {
            self.line(canvas, &curve.values, run, MEASURED_PEN)?;
        }
        for run in curve.filled_runs() {
            self.line(canvas, &curve.values, curve.widen(&run), FILLED_PEN)?;
        }
        for run in curve.truth_runs() {
            self.line(canvas, &curve.truth, run, TRUTH_PEN)?;
        }
        axes.draw_frame(canvas)
    }

    fn shade<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        runs: &[Range<usize>],
        shade: RGBColor,
    ) -> Result<(), ReportError> {
        runs.iter().try_for_each(|run| {
            let (start, end) = span(run, &self.axes, self.rate_hz);
            canvas.bar((start, self.axes.top), (end, self.axes.bottom), shade)
        })
    }

    fn line<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        values: &[Option<f64>],
        run: Range<usize>,
        pen: Pen,
    ) -> Result<(), ReportError> {
        let point = |t: usize| Some(self.axes.at(t as f64 / self.rate_hz, values[t]?));
        let points: Vec<Point> = run.filter_map(point).collect();
        match points.as_slice() {
            [single] => canvas.dot(*single, pen.width.max(MIN_DOT), pen.colour),
            many => canvas.polyline(&thin(many), pen),
        }
    }
}

/// Seconds from the first to the last frame, with half a frame on either side.
pub(super) fn time_axis(frames: usize, rate_hz: f64) -> Interval {
    Interval { low: -0.5 / rate_hz, high: (frames.max(1) as f64 - 0.5) / rate_hz }
}

/// Where a run of frames starts and ends across the page: half a frame beyond its samples, and wide
/// enough to be seen.
pub(super) fn span(run: &Range<usize>, axes: &Axes, rate_hz: f64) -> (f64, f64) {
    let start = axes.at_x((run.start as f64 - 0.5) / rate_hz);
    let end = axes.at_x((run.end as f64 - 0.5) / rate_hz);
    if end - start >= MIN_SPAN {
        return (start, end);
    }
    let start =
        (f64::midpoint(start, end) - 0.5 * MIN_SPAN).clamp(axes.left, axes.right - MIN_SPAN);
    (start, start + MIN_SPAN)
}

/// Smallest radius of a lone sample, in page units.
const MIN_DOT: f64 = 2.0;
/// Narrowest span that the eye can find, in page units.
const MIN_SPAN: f64 = 1.0;

/// The text, without its middle where it is longer than `most` characters: names differ at their ends.
pub(super) fn shorten(text: &str, most: usize) -> String {
    let characters: Vec<char> = text.chars().collect();
    if characters.len() <= most {
        return text.to_owned();
    }
    let kept = most.saturating_sub(1);
    let (head, tail) = (kept / 2, kept - kept / 2);
    let ends = (&characters[..head], &characters[characters.len() - tail..]);
    ends.0.iter().chain(&['\u{2026}']).chain(ends.1).collect()
}
