//! Figures, on the drawing layer of `mocap-report`.

use mocap_report::{
    ReportError,
    draw::{Align, Backend, Canvas, Drawing, Pen, Point, colour, to_png, to_svg},
};

mod axes;
mod bars;
mod chart;
mod dots;
mod legend;
mod panels;
mod still;
mod style;

pub(crate) use axes::Axis;
pub(crate) use bars::Bars;
pub(crate) use chart::{Chart, Line, Points};
pub(crate) use dots::{Dots, Value};
pub(crate) use legend::Legend;
pub(crate) use panels::{Panel, Panels};
pub(crate) use still::Still;
pub(crate) use style::{Shape, Style, colours};

use crate::ReproError;

/// A figure with its heading and what the reader has to know of it.
#[derive(Debug)]
pub(crate) struct Figure {
    /// File name without its ending.
    pub id: String,
    pub title: String,
    pub caption: String,
    pub content: Content,
}

#[derive(Debug)]
pub(crate) enum Content {
    Bars(Bars),
    Dots(Dots),
    Panels(Panels),
}

/// Width of every figure, in page units.
const WIDTH: f64 = 1160.0;
const MARGIN: f64 = 18.0;
/// Room for the title.
const TITLE_HEIGHT: f64 = 40.0;
const LEGEND_LINE: f64 = 22.0;
const LETTERS: f64 = 12.0;

/// An entry of a legend.
#[derive(Debug, Clone)]
pub(crate) struct Key {
    pub name: String,
    pub mark: Mark,
}

/// What stands in a figure for the entry of a legend.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Mark {
    Line(Pen),
    Shape(Style),
}

impl Figure {
    pub(crate) fn svg(&self) -> Result<String, ReproError> {
        // The backend writes text, so that nothing is lost.
        Ok(String::from_utf8_lossy(&to_svg(self)?).into_owned())
    }

    pub(crate) fn png(&self) -> Result<Vec<u8>, ReproError> {
        Ok(to_png(self)?)
    }

    fn legend(&self) -> Vec<Key> {
        match &self.content {
            Content::Bars(bars) => bars.legend(),
            Content::Dots(dots) => dots.legend(),
            Content::Panels(panels) => panels.legend.clone(),
        }
    }

    /// Entries of the legend with their places, and the height of all.
    fn place_legend(&self) -> (Vec<(Key, Point)>, f64) {
        let (mut left, mut top, mut placed) = (MARGIN, TITLE_HEIGHT, Vec::new());
        for key in self.legend() {
            let width = 46.0 + text_width(&key.name, LETTERS);
            if left > MARGIN && left + width > WIDTH - MARGIN {
                (left, top) = (MARGIN, top + LEGEND_LINE);
            }
            placed.push((key, (left, top)));
            left += width + 10.0;
        }
        let lines = if placed.is_empty() { 0.0 } else { top - TITLE_HEIGHT + LEGEND_LINE + 6.0 };
        (placed, lines)
    }

    fn body_height(&self) -> f64 {
        match &self.content {
            Content::Bars(_) => 430.0,
            Content::Dots(dots) => dots.height(),
            Content::Panels(panels) => panels.height(),
        }
    }
}

impl Drawing for Figure {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few thousand
    fn size(&self) -> (u32, u32) {
        let height = TITLE_HEIGHT + self.place_legend().1 + self.body_height() + MARGIN;
        (WIDTH as u32, height.ceil() as u32)
    }

    fn draw<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError> {
        canvas.text(&self.title, (MARGIN, 27.0), 17.0, Align::Left, colour::INK)?;
        let (keys, height) = self.place_legend();
        for (key, (left, top)) in keys {
            let middle = top + 8.0;
            match key.mark {
                Mark::Line(pen) => {
                    canvas.polyline(&[(left, middle), (left + 28.0, middle)], pen)?;
                }
                Mark::Shape(style) => style.draw(canvas, (left + 14.0, middle), 5.0)?,
            }
            let at = (left + 36.0, middle + 4.0);
            canvas.text(&key.name, at, LETTERS, Align::Left, colour::INK)?;
        }
        let top = TITLE_HEIGHT + height;
        match &self.content {
            Content::Bars(bars) => bars.draw(canvas, top, self.body_height()),
            Content::Dots(dots) => dots.draw(canvas, top),
            Content::Panels(panels) => panels.draw(canvas, top),
        }
    }
}

/// About the width of a text: letters are 0.58 of their size wide on average.
fn text_width(text: &str, size: f64) -> f64 {
    0.58 * size * text.chars().count() as f64
}
