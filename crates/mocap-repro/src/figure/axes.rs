use mocap_report::{
    ReportError,
    draw::{Align, Backend, Canvas, Pen, Point, colour},
};

/// A range of values and how it is laid out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Axis {
    low: f64,
    high: f64,
    log: bool,
}

impl Axis {
    /// From one value to another; `0…1` for what is no range.
    pub(crate) fn linear(low: f64, high: f64) -> Self {
        if high > low && (high - low).is_finite() {
            Self { low, high, log: false }
        } else {
            Self { low: 0.0, high: 1.0, log: false }
        }
    }

    /// The values and a margin.
    pub(crate) fn around(values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = span(values.into_iter().filter(|value| value.is_finite()));
        let margin = 0.06 * (high - low);
        Self::linear(low - margin, high + margin)
    }

    /// The round numbers around the positive values.
    pub(crate) fn logarithmic(values: impl IntoIterator<Item = f64>) -> Self {
        let positive = values.into_iter().filter(|value| value.is_finite() && *value > 0.0);
        let (low, high) = span(positive);
        if low > high {
            return Self { low: 1e-6, high: 1.0, log: true };
        }
        let steps = &[1.0, 2.0, 5.0];
        let (low, high) = (round_down(0.93 * low, steps), round_up(1.07 * high, steps));
        Self { low, high, log: true }
    }

    pub(crate) fn ends(self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Place of a value on the axis, from 0 to 1; what lies beyond an end stands at it.
    pub(crate) fn share(self, value: f64) -> f64 {
        let share = if self.log {
            (value.max(f64::MIN_POSITIVE) / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        share.clamp(0.0, 1.0)
    }

    /// Round values and what is written beside them.
    fn ticks(self, wanted: usize) -> Vec<(f64, String)> {
        if self.log { self.log_ticks(wanted) } else { self.linear_ticks(wanted) }
    }

    fn linear_ticks(self, wanted: usize) -> Vec<(f64, String)> {
        let raw = (self.high - self.low) / wanted.max(1) as f64;
        let magnitude = 10_f64.powf(raw.log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * magnitude);
        let step = steps.into_iter().find(|step| *step >= 0.999 * raw).unwrap_or(raw);
        let digits = (0..9).find(|d| 10_f64.powi(*d) * step >= 0.999).unwrap_or(9);
        let digits = usize::try_from(digits).unwrap_or(0);
        let first = (self.low / step - 1e-9).ceil();
        (0..40)
            .map(|i| (first + f64::from(i)) * step)
            .take_while(|value| *value <= self.high + 1e-9 * step)
            // Adding zero turns a negative zero into none.
            .map(|value| (value, minus(format!("{:.digits$}", value + 0.0))))
            .collect()
    }

    #[allow(clippy::cast_possible_truncation)] // exponents
    fn log_ticks(self, wanted: usize) -> Vec<(f64, String)> {
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let steps = if self.high / self.low < 300.0 { &[1.0, 2.0, 5.0][..] } else { &[1.0] };
        let every = (usize::try_from(last - first).unwrap_or(0) / wanted.max(1)).max(1);
        (first..=last)
            .step_by(every)
            .flat_map(|power| steps.iter().map(move |step| step * 10_f64.powi(power)))
            .filter(|value| *value >= 0.999 * self.low && *value <= 1.001 * self.high)
            .map(|value| (value, log_label(value)))
            .collect()
    }
}

fn log_label(value: f64) -> String {
    if (0.09..9_999.0).contains(&value) {
        let digits = usize::from(value < 0.9);
        format!("{value:.digits$}")
    } else {
        minus(format!("{value:.0e}"))
    }
}

fn minus(text: String) -> String {
    text.replace('-', "\u{2212}")
}

fn span(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

fn round_down(value: f64, steps: &[f64]) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let candidates = steps.iter().map(|step| step * power);
    candidates.filter(|c| *c <= value * (1.0 + 1e-12)).fold(power, f64::max)
}

fn round_up(value: f64, steps: &[f64]) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let candidates = steps.iter().map(|step| step * power).chain([10.0 * power]);
    candidates.filter(|c| *c >= value * (1.0 - 1e-12)).fold(10.0 * power, f64::min)
}

/// Two axes and the rectangle between them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
    pub x: Axis,
    pub y: Axis,
}

const FRAME: Pen = Pen::solid(colour::INK, 0.8);
const GRID: Pen = Pen::solid(colour::GRID, 0.8);
const TICK_LETTERS: f64 = 10.5;

impl Axes {
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        (
            self.left + self.x.share(x) * (self.right - self.left),
            self.bottom - self.y.share(y) * (self.bottom - self.top),
        )
    }

    /// Grid lines and numbers below.
    pub(super) fn draw_x<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        wanted: usize,
    ) -> Result<(), ReportError> {
        self.x.ticks(wanted).into_iter().try_for_each(|(value, label)| {
            let x = self.left + self.x.share(value) * (self.right - self.left);
            canvas.polyline(&[(x, self.top), (x, self.bottom)], GRID)?;
            let at = (x, self.bottom + 14.0);
            canvas.text(&label, at, TICK_LETTERS, Align::Centre, colour::INK)
        })
    }

    /// Grid lines and numbers to the left.
    pub(super) fn draw_y<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        wanted: usize,
    ) -> Result<(), ReportError> {
        self.y.ticks(wanted).into_iter().try_for_each(|(value, label)| {
            let y = self.bottom - self.y.share(value) * (self.bottom - self.top);
            canvas.polyline(&[(self.left, y), (self.right, y)], GRID)?;
            let at = (self.left - 6.0, y + 4.0);
            canvas.text(&label, at, TICK_LETTERS, Align::Right, colour::INK)
        })
    }

    pub(super) fn draw_frame<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
    ) -> Result<(), ReportError> {
        let Self { left, right, top, bottom, .. } = *self;
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        canvas.polyline(&corners, FRAME)
    }
}
