use std::sync::OnceLock;

use plotters::{
    prelude::{FontStyle, RGBColor},
    style::{
        FontDesc, FontFamily, ShapeStyle, TextStyle, register_font as register,
        text_anchor::{HPos, Pos, VPos},
    },
};

use super::Backend;
use crate::{FONT, ReportError};

/// Backend units to one unit of the page: backends know whole numbers only.
pub(crate) const SUBPIXELS: u32 = 4;

/// What the backends do differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Medium {
    Svg,
    Bitmap,
}

impl Medium {
    /// Distance from the top of a text to its baseline, in font sizes.
    fn baseline(self) -> f64 {
        match self {
            Self::Svg => 0.76 / 1.24,
            Self::Bitmap => 0.5,
        }
    }
}

/// Names the built-in font first and, for viewers of SVG that lack it, fonts of like widths.
const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

/// Colours that people with any colour vision tell apart, after Okabe and Ito.
pub mod colour {
    pub use plotters::style::RGBColor;

    /// Letters, and whatever frames something.
    pub const INK: RGBColor = RGBColor(34, 34, 34);
    /// Letters of lesser weight.
    pub const FAINT: RGBColor = RGBColor(110, 110, 110);
    /// Grid lines.
    pub const GRID: RGBColor = RGBColor(226, 226, 226);
    /// Ground of a gap.
    pub const SHADE: RGBColor = RGBColor(238, 242, 247);
    /// Ground of a gap that is still open.
    pub const OPEN_SHADE: RGBColor = RGBColor(252, 236, 224);
    /// Measured samples.
    pub const MEASURED: RGBColor = RGBColor(120, 120, 120);
    /// Filled samples.
    pub const FILLED: RGBColor = RGBColor(0, 114, 178);
    /// Missing samples.
    pub const MISSING: RGBColor = RGBColor(213, 94, 0);
    /// The true motion.
    pub const TRUTH: RGBColor = RGBColor(0, 0, 0);
    /// What a length ought to be.
    pub const NOMINAL: RGBColor = RGBColor(0, 158, 115);
}

/// Makes the built-in font known to the drawing library, once in the life of the process.
pub(crate) fn register_font() -> Result<(), ReportError> {
    static DONE: OnceLock<bool> = OnceLock::new();
    let done = DONE.get_or_init(|| register(FAMILY, FontStyle::Normal, FONT).is_ok());
    if *done { Ok(()) } else { Err(ReportError::Font) }
}

/// A point of the page, in page units from its top left corner.
pub type Point = (f64, f64);

/// Colour and width of a line.
#[derive(Debug, Clone, Copy)]
pub struct Pen {
    /// Its colour.
    pub colour: RGBColor,
    /// Its width in page units.
    pub width: f64,
    /// Whether it leaves gaps.
    pub dashed: bool,
}

impl Pen {
    /// An unbroken line.
    #[must_use]
    pub const fn solid(colour: RGBColor, width: f64) -> Self {
        Self { colour, width, dashed: false }
    }

    /// A broken line.
    #[must_use]
    pub const fn dashed(colour: RGBColor, width: f64) -> Self {
        Self { colour, width, dashed: true }
    }
}

/// Where a text lies relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// To its right.
    Left,
    /// Centred on it.
    Centre,
    /// To its left.
    Right,
}

/// Draws in page units on either backend.
pub struct Canvas<'a, DB> {
    backend: &'a mut DB,
    medium: Medium,
}

impl<'a, DB: Backend> Canvas<'a, DB> {
    pub(super) fn new(backend: &'a mut DB, medium: Medium) -> Self {
        Self { backend, medium }
    }

    pub(super) fn finish(self) -> Result<(), ReportError> {
        self.backend.present().map_err(draw_error)
    }

    /// A filled rectangle.
    ///
    /// # Errors
    /// [`ReportError::Draw`].
    pub fn bar(&mut self, from: Point, to: Point, colour: RGBColor) -> Result<(), ReportError> {
        let style = ShapeStyle::from(colour).filled();
        self.backend.draw_rect(units(from), units(to), &style, true).map_err(draw_error)
    }

    /// A filled circle.
    ///
    /// # Errors
    /// [`ReportError::Draw`].
    pub fn dot(&mut self, at: Point, radius: f64, colour: RGBColor) -> Result<(), ReportError> {
        let style = ShapeStyle::from(colour).filled();
        let radius = unit(radius).unsigned_abs();
        self.backend.draw_circle(units(at), radius, &style, true).map_err(draw_error)
    }

    /// A filled convex polygon.
    ///
    /// # Errors
    /// [`ReportError::Draw`].
    pub fn polygon(&mut self, corners: &[Point], colour: RGBColor) -> Result<(), ReportError> {
        let corners: Vec<(i32, i32)> = corners.iter().copied().map(units).collect();
        let style = ShapeStyle::from(colour).filled();
        self.backend.fill_polygon(corners, &style).map_err(draw_error)
    }

    /// A line through points, as broken as its pen says.
    ///
    /// # Errors
    /// [`ReportError::Draw`].
    pub fn polyline(&mut self, points: &[Point], pen: Pen) -> Result<(), ReportError> {
        if pen.dashed {
            return dashes(points).iter().try_for_each(|dash| self.stroke(dash, pen));
        }
        self.stroke(points, pen)
    }

    fn stroke(&mut self, points: &[Point], pen: Pen) -> Result<(), ReportError> {
        let mut path: Vec<(i32, i32)> = points.iter().copied().map(units).collect();
        path.dedup();
        if path.len() < 2 {
            return Ok(());
        }
        let width = unit(pen.width).unsigned_abs().max(1);
        let style = ShapeStyle::from(pen.colour).stroke_width(width);
        match self.medium {
            Medium::Svg => self.backend.draw_path(path, &style).map_err(draw_error),
            Medium::Bitmap => self.stroke_pixels(&path, style),
        }
    }

    /// Segment by segment with round joints: the bitmap backend makes one polygon of a path, which
    /// grows spikes where the path turns sharply.
    fn stroke_pixels(&mut self, path: &[(i32, i32)], style: ShapeStyle) -> Result<(), ReportError> {
        for pair in path.windows(2) {
            self.backend.draw_line(pair[0], pair[1], &style).map_err(draw_error)?;
        }
        let radius = style.stroke_width / 2;
        let joints = path.get(1..path.len() - 1).unwrap_or_default();
        joints.iter().try_for_each(|&joint| {
            self.backend.draw_circle(joint, radius, &style.filled(), true).map_err(draw_error)
        })
    }

    /// One line of text with its baseline at `at`, and its size in page units.
    ///
    /// # Errors
    /// [`ReportError::Draw`].
    pub fn text(
        &mut self,
        text: &str,
        at: Point,
        size: f64,
        align: Align,
        colour: RGBColor,
    ) -> Result<(), ReportError> {
        let h_pos = match align {
            Align::Left => HPos::Left,
            Align::Centre => HPos::Center,
            Align::Right => HPos::Right,
        };
        let font =
            FontDesc::new(FontFamily::Name(FAMILY), size * f64::from(SUBPIXELS), FontStyle::Normal);
        let style = TextStyle::from(font).color(&colour).pos(Pos::new(h_pos, VPos::Top));
        let top = (at.0, at.1 - self.medium.baseline() * size);
        self.backend.draw_text(&printable(text), &style, units(top)).map_err(draw_error)
    }
}

/// Text without the characters that XML forbids and those that would break a line.
pub(crate) fn printable(text: &str) -> String {
    let forbidden = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.chars().map(|c| if forbidden(c) { '\u{fffd}' } else { c }).collect()
}

/// Cuts a path into dashes of fixed length.
fn dashes(points: &[Point]) -> Vec<Vec<Point>> {
    const PERIOD: f64 = 7.0;
    const DASH: f64 = 4.5;
    let mut dashes = Vec::new();
    let mut current: Vec<Point> = points.first().copied().into_iter().collect();
    let (mut phase, mut drawing) = (0.0, true);
    for pair in points.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let length = (x1 - x0).hypot(y1 - y0);
        let mut done = 0.0;
        while done < length {
            let left = if drawing { DASH - phase } else { PERIOD - phase };
            let step = left.min(length - done);
            done += step;
            phase += step;
            let share = done / length;
            let at = (x0 + share * (x1 - x0), y0 + share * (y1 - y0));
            if drawing {
                current.push(at);
            }
            if step < left {
                break;
            }
            if drawing {
                dashes.push(std::mem::take(&mut current));
            } else {
                phase = 0.0;
                current.push(at);
            }
            drawing = !drawing;
        }
    }
    dashes.push(current);
    dashes
}

fn units((x, y): Point) -> (i32, i32) {
    (unit(x), unit(y))
}

#[allow(clippy::cast_possible_truncation)] // a page is a few thousand units wide and high
fn unit(length: f64) -> i32 {
    (length * f64::from(SUBPIXELS)).round() as i32
}

fn draw_error<E: std::error::Error + Send + Sync + 'static>(error: E) -> ReportError {
    ReportError::Draw(Box::new(error))
}
