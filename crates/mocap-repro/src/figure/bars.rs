use mocap_report::{
    ReportError,
    draw::{Align, Backend, Canvas, colour},
};

use super::{Axis, Key, MARGIN, Mark, Style, WIDTH, axes::Axes};

/// Groups of bars on a logarithmic axis.
#[derive(Debug)]
pub(crate) struct Bars {
    pub y_label: String,
    pub groups: Vec<String>,
    /// Name, style, and one value a group.
    pub series: Vec<(String, Style, Vec<Option<f64>>)>,
}

impl Bars {
    pub(super) fn legend(&self) -> Vec<Key> {
        let key = |(name, style, _): &(String, Style, _)| {
            let style = Style { shape: super::Shape::Square, ..*style };
            Key { name: name.clone(), mark: Mark::Shape(style) }
        };
        self.series.iter().map(key).collect()
    }

    pub(super) fn draw<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        top: f64,
        height: f64,
    ) -> Result<(), ReportError> {
        let values = self.series.iter().flat_map(|(_, _, values)| values.iter().copied().flatten());
        let axes = Axes {
            left: MARGIN + 56.0,
            right: WIDTH - MARGIN,
            top: top + 24.0,
            bottom: top + height - 26.0,
            x: Axis::linear(0.0, self.groups.len() as f64),
            y: Axis::logarithmic(values),
        };
        canvas.text(&self.y_label, (MARGIN, top + 12.0), 12.0, Align::Left, colour::INK)?;
        axes.draw_y(canvas, 8)?;
        let [low, _] = axes.y.ends();
        let slot = 0.84 / self.series.len().max(1) as f64;
        for (k, (_, style, values)) in self.series.iter().enumerate() {
            for (g, value) in values.iter().enumerate() {
                let Some(value) = value else { continue };
                let left = g as f64 + 0.08 + k as f64 * slot;
                let from = axes.at(left, *value);
                canvas.bar(from, axes.at(left + 0.92 * slot, low), style.colour)?;
            }
        }
        for (g, group) in self.groups.iter().enumerate() {
            let (x, y) = axes.at(g as f64 + 0.5, low);
            canvas.text(group, (x, y + 17.0), 12.0, Align::Centre, colour::INK)?;
        }
        axes.draw_frame(canvas)
    }
}
