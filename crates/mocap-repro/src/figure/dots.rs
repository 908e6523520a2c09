use mocap_report::{
    ReportError,
    draw::{Align, Backend, Canvas, Pen, colour},
};

use super::{Axis, Key, MARGIN, Mark, Style, WIDTH, axes::Axes};

/// One row for each kind of gap, one shape in it for each method, on a logarithmic axis.
#[derive(Debug)]
pub(crate) struct Dots {
    pub x_label: String,
    pub rows: Vec<String>,
    /// Name, style, and one value a row.
    pub series: Vec<(String, Style, Vec<Option<Value>>)>,
}

/// A value, and whether it is of the whole; if not, its shape is hollow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Value {
    pub value: f64,
    pub is_whole: bool,
}

const ROW_HEIGHT: f64 = 27.0;
/// Room for the names of the rows.
const NAMES: f64 = 190.0;

impl Dots {
    pub(super) fn legend(&self) -> Vec<Key> {
        let key = |(name, style, _): &(String, Style, _)| Key {
            name: name.clone(),
            mark: Mark::Shape(*style),
        };
        self.series.iter().map(key).collect()
    }

    pub(super) fn height(&self) -> f64 {
        ROW_HEIGHT * self.rows.len().max(1) as f64 + 52.0
    }

    pub(super) fn draw<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        top: f64,
    ) -> Result<(), ReportError> {
        let values = self.series.iter().flat_map(|(_, _, values)| values.iter().flatten());
        let rows = self.rows.len().max(1) as f64;
        let axes = Axes {
            left: MARGIN + NAMES,
            right: WIDTH - MARGIN - 10.0,
            top: top + 4.0,
            bottom: top + 4.0 + ROW_HEIGHT * rows,
            x: Axis::logarithmic(values.map(|value| value.value)),
            y: Axis::linear(0.0, rows),
        };
        axes.draw_x(canvas, 10)?;
        let [low, high] = axes.x.ends();
        for (r, name) in self.rows.iter().enumerate() {
            let middle = rows - r as f64 - 0.5;
            let (left, y) = axes.at(low, middle);
            let line = [(left, y), axes.at(high, middle)];
            canvas.polyline(&line, Pen::solid(colour::GRID, 0.8))?;
            canvas.text(name, (left - 10.0, y + 4.0), 12.0, Align::Right, colour::INK)?;
        }
        // Those that come first stand on top.
        for (_, style, values) in self.series.iter().rev() {
            for (r, value) in values.iter().enumerate() {
                let Some(Value { value, is_whole }) = value else { continue };
                let at = axes.at(*value, rows - r as f64 - 0.5);
                style.draw(canvas, at, 5.0)?;
                if !is_whole {
                    style.hollow(canvas, at, 5.0)?;
                }
            }
        }
        axes.draw_frame(canvas)?;
        let below = (f64::midpoint(axes.left, axes.right), axes.bottom + 34.0);
        canvas.text(&self.x_label, below, 12.0, Align::Centre, colour::INK)
    }
}
