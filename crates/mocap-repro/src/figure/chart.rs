use mocap_report::{
    ReportError,
    draw::{Align, Backend, Canvas, Pen, Point, colour},
};

use super::{
    Axis, Style,
    axes::Axes,
    panels::{HEADING, Place},
};

/// Lines and points over two axes.
#[derive(Debug)]
pub(crate) struct Chart {
    pub heading: String,
    pub x: Axis,
    pub y: Axis,
    /// Names of the values 1, 2, … of x, instead of numbers.
    pub names: Vec<String>,
    pub x_label: String,
    pub y_label: String,
    /// A range of x that is shaded and bordered.
    pub shade: Option<(f64, f64)>,
    /// Whether equal values are marked by a line.
    pub diagonal: bool,
    pub lines: Vec<Line>,
    pub points: Vec<Points>,
}

/// A line through points; one that is not finite leaves a gap.
#[derive(Debug)]
pub(crate) struct Line {
    pub points: Vec<(f64, f64)>,
    pub pen: Pen,
}

/// Shapes at places.
#[derive(Debug)]
pub(crate) struct Points {
    pub at: Vec<(f64, f64)>,
    pub style: Style,
    pub radius: f64,
}

impl Chart {
    pub(super) fn draw<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        place: Place,
    ) -> Result<(), ReportError> {
        let (x, y) = (self.x, self.y);
        let axes = Axes {
            left: place.left + 58.0,
            right: place.left + place.width - 8.0,
            top: place.top + HEADING + 16.0,
            bottom: place.top + place.height - 40.0,
            x,
            y,
        };
        canvas.text(
            &self.heading,
            (axes.left, place.top + 15.0),
            13.0,
            Align::Left,
            colour::INK,
        )?;
        let label = (axes.left, axes.top - 5.0);
        canvas.text(&self.y_label, label, 11.0, Align::Left, colour::FAINT)?;
        if let Some((from, to)) = self.shade {
            let [low, high] = self.y.ends();
            canvas.bar(axes.at(from, high), axes.at(to, low), colour::SHADE)?;
        }
        if self.names.is_empty() {
            axes.draw_x(canvas, if place.width > 500.0 { 10 } else { 5 })?;
        }
        for (k, name) in self.names.iter().enumerate() {
            let (x, y) = axes.at(k as f64 + 1.0, self.y.ends()[0]);
            canvas.text(name, (x, y + 15.0), 11.5, Align::Centre, colour::INK)?;
        }
        axes.draw_y(canvas, 5)?;
        for edge in self.shade.iter().flat_map(|(from, to)| [*from, *to]) {
            let line = self.y.ends().map(|end| axes.at(edge, end));
            canvas.polyline(&line, Pen::solid(colour::FAINT, 0.8))?;
        }
        if self.diagonal {
            let ends = self.x.ends().map(|end| axes.at(end, end));
            canvas.polyline(&ends, Pen::solid(colour::INK, 1.0))?;
        }
        for line in &self.lines {
            for run in runs(&line.points) {
                let path: Vec<Point> = run.iter().map(|(x, y)| axes.at(*x, *y)).collect();
                canvas.polyline(&path, line.pen)?;
            }
        }
        for points in &self.points {
            for (x, y) in points.at.iter().filter(|(x, y)| x.is_finite() && y.is_finite()) {
                points.style.draw(canvas, axes.at(*x, *y), points.radius)?;
            }
        }
        axes.draw_frame(canvas)?;
        let below = (f64::midpoint(axes.left, axes.right), axes.bottom + 31.0);
        canvas.text(&self.x_label, below, 11.5, Align::Centre, colour::INK)
    }
}

/// The stretches of points that are all finite.
fn runs(points: &[(f64, f64)]) -> impl Iterator<Item = &[(f64, f64)]> {
    points.split(|(x, y)| !(x.is_finite() && y.is_finite())).filter(|run| run.len() > 1)
}
