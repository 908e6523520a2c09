use crate::{
    ReportError,
    draw::{Align, Backend, Canvas, Pen, Point, colour},
};

/// A closed interval of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    /// Spans the values with a margin, and at least `min_span`; `0…min_span` without values.
    pub(super) fn around(values: impl Iterator<Item = f64>, min_span: f64) -> Self {
        let (low, high) = values
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return Self { low: 0.0, high: min_span };
        }
        let half = (0.54 * (high - low)).max(0.5 * min_span);
        let middle = f64::midpoint(low, high);
        let interval = Self { low: middle - half, high: middle + half };
        // Values so large that the span is lost in rounding, or overflows, have no scale to show.
        if interval.high > interval.low && (interval.high - interval.low).is_finite() {
            interval
        } else {
            Self { low: 0.0, high: min_span }
        }
    }

    fn share(self, value: f64) -> f64 {
        ((value - self.low) / (self.high - self.low)).clamp(-1.0, 2.0)
    }

    /// Round numbers inside of the interval, about `wanted` of them.
    pub(super) fn ticks(self, wanted: usize) -> Vec<Tick> {
        let raw = (self.high - self.low) / wanted.max(1) as f64;
        if !(raw.is_finite() && raw > 0.0) {
            return Vec::new();
        }
        let magnitude = 10_f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|s| s * magnitude)
            .find(|s| *s >= 0.999 * raw)
            .unwrap_or(10.0 * magnitude);
        let digits = (0..9).find(|d| 10_f64.powi(*d) * step >= 0.999).unwrap_or(9);
        let first = (self.low / step).ceil();
        let count = ((self.high / step).floor() - first).clamp(-1.0, 50.0);
        (0..50_u8)
            .map(f64::from)
            .take_while(|i| *i <= count)
            .map(|i| Tick::new((first + i) * step, digits))
            .collect()
    }
}

/// A labelled place on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub value: f64,
    pub label: String,
}

impl Tick {
    fn new(value: f64, digits: i32) -> Self {
        let digits = usize::try_from(digits).unwrap_or(0);
        let plain = value.abs() < 1e7;
        let label = if plain { format!("{value:.digits$}") } else { format!("{value:.2e}") };
        let is_zero = label.chars().all(|c| matches!(c, '-' | '0' | '.'));
        let label = if is_zero { "0".to_owned() } else { label.replace('-', "\u{2212}") };
        Self { value, label }
    }
}

/// The data rectangle of one small chart.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
    pub x: Interval,
    pub y: Interval,
}

/// Size of tick labels in page units.
const TICK_SIZE: f64 = 11.0;

impl Axes {
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        let down = self.bottom - self.y.share(y) * (self.bottom - self.top);
        (self.at_x(x), down.clamp(self.top, self.bottom))
    }

    pub(super) fn at_x(&self, x: f64) -> f64 {
        let across = self.left + self.x.share(x) * (self.right - self.left);
        across.clamp(self.left, self.right)
    }

    /// Vertical grid lines with their labels below the chart.
    pub(super) fn draw_x<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        wanted: usize,
    ) -> Result<(), ReportError> {
        for tick in self.x.ticks(wanted) {
            let x = self.at_x(tick.value);
            canvas.polyline(&[(x, self.top), (x, self.bottom)], GRID_PEN)?;
            canvas.polyline(&[(x, self.bottom), (x, self.bottom + 4.0)], FRAME_PEN)?;
            let at = (x, self.bottom + 16.0);
            canvas.text(&tick.label, at, TICK_SIZE, Align::Centre, colour::INK)?;
        }
        Ok(())
    }

    /// Horizontal grid lines with their labels left of the chart.
    pub(super) fn draw_y<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        wanted: usize,
    ) -> Result<(), ReportError> {
        for tick in self.y.ticks(wanted) {
            let (_, y) = self.at(self.x.low, tick.value);
            canvas.polyline(&[(self.left, y), (self.right, y)], GRID_PEN)?;
            canvas.polyline(&[(self.left - 4.0, y), (self.left, y)], FRAME_PEN)?;
            let at = (self.left - 7.0, y + 3.5);
            canvas.text(&tick.label, at, TICK_SIZE, Align::Right, colour::INK)?;
        }
        Ok(())
    }

    /// The two axis lines.
    pub(super) fn draw_frame<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
    ) -> Result<(), ReportError> {
        let corner = (self.left, self.bottom);
        canvas.polyline(&[(self.left, self.top), corner, (self.right, self.bottom)], FRAME_PEN)
    }
}

const GRID_PEN: Pen = Pen::solid(colour::GRID, 0.75);
const FRAME_PEN: Pen = Pen::solid(colour::INK, 1.0);
