use std::{error::Error, path::Path, sync::OnceLock};

use mocap_report::FONT;
use plotters::{
    chart::ChartBuilder,
    coord::Shift,
    prelude::{
        BitMapBackend, Circle, Color, DrawingArea, DrawingBackend, FontDesc, FontFamily, FontStyle,
        IntoDrawingArea, IntoLogRange, LineSeries, PathElement, RGBColor, Rectangle, SVGBackend,
        TextStyle, WHITE,
    },
    style::{
        register_font,
        text_anchor::{HPos, Pos, VPos},
    },
};

use crate::ReproError;

/// A figure, drawn as SVG and as PNG.
#[derive(Debug)]
pub(crate) enum Figure {
    Bars(Bars),
    Scatter(Scatter),
}

/// Groups of bars on a logarithmic axis.
#[derive(Debug)]
pub(crate) struct Bars {
    pub id: String,
    pub title: String,
    pub y_label: String,
    pub groups: Vec<String>,
    /// Name and one value a group.
    pub series: Vec<(String, Vec<Option<f64>>)>,
}

/// Charts of one quantity against another on logarithmic axes, with the diagonal.
#[derive(Debug)]
pub(crate) struct Scatter {
    pub id: String,
    pub title: String,
    pub panels: Vec<Panel>,
}

#[derive(Debug)]
pub(crate) struct Panel {
    pub x_label: String,
    pub y_label: String,
    pub points: Vec<(f64, f64)>,
}

type Failed = Box<dyn Error + Send + Sync>;

/// Names the built-in font first and, for viewers of SVG that lack it, fonts of like widths.
const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

/// Colours that people with any colour vision tell apart, after Okabe and Ito; the last ones for
/// matrices with more methods than that palette has colours.
const COLOURS: [RGBColor; 10] = [
    RGBColor(160, 160, 160),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(204, 121, 167),
    RGBColor(240, 228, 66),
    RGBColor(34, 34, 34),
    RGBColor(136, 34, 85),
];
const INK: RGBColor = RGBColor(34, 34, 34);
const GRID: RGBColor = RGBColor(226, 226, 226);
/// Pixels of a PNG to each unit of the SVG.
const PNG_SCALE: u32 = 2;

impl Figure {
    pub(crate) fn id(&self) -> &str {
        match self {
            Self::Bars(bars) => &bars.id,
            Self::Scatter(scatter) => &scatter.id,
        }
    }

    pub(crate) fn title(&self) -> &str {
        match self {
            Self::Bars(bars) => &bars.title,
            Self::Scatter(scatter) => &scatter.title,
        }
    }

    fn size(&self) -> (u32, u32) {
        match self {
            Self::Bars(_) => (1160, 520),
            Self::Scatter(scatter) => {
                let columns = u32::try_from(scatter.panels.len().min(2)).unwrap_or(2);
                let rows = u32::try_from(scatter.panels.len().div_ceil(2)).unwrap_or(1);
                (560 * columns, 40 + 500 * rows)
            }
        }
    }

    pub(crate) fn svg(&self) -> Result<String, ReproError> {
        let mut svg = String::new();
        let area = SVGBackend::with_string(&mut svg, self.size()).into_drawing_area();
        self.draw(area, 1.0).map_err(ReproError::Figure)?;
        Ok(svg)
    }

    pub(crate) fn png(&self, path: &Path) -> Result<(), ReproError> {
        let (width, height) = self.size();
        let size = (width * PNG_SCALE, height * PNG_SCALE);
        let area = BitMapBackend::new(path, size).into_drawing_area();
        self.draw(area, f64::from(PNG_SCALE)).map_err(ReproError::Figure)
    }

    fn draw<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        area: DrawingArea<DB, Shift>,
        scale: f64,
    ) -> Result<(), Failed> {
        static REGISTERED: OnceLock<bool> = OnceLock::new();
        let known = || register_font(FAMILY, FontStyle::Normal, FONT).is_ok();
        if !REGISTERED.get_or_init(known) {
            return Err("the built-in font cannot be used".into());
        }
        let pen = Pen { scale };
        area.fill(&WHITE)?;
        let (head, body) = area.split_vertically(pen.units(40.0));
        let title = pen.text(17.0, HPos::Left);
        head.draw_text(self.title(), &title, (pen.units(14.0), pen.units(22.0)))?;
        match self {
            Self::Bars(bars) => bars.draw(&body, pen)?,
            Self::Scatter(scatter) => scatter.draw(&body, pen)?,
        }
        area.present()?;
        Ok(())
    }
}

/// Sizes in units of the page.
#[derive(Clone, Copy)]
struct Pen {
    scale: f64,
}

impl Pen {
    #[allow(clippy::cast_possible_truncation)] // a page is a few thousand units wide
    fn units(self, length: f64) -> i32 {
        (length * self.scale).round() as i32
    }

    fn text(self, size: f64, h_pos: HPos) -> TextStyle<'static> {
        let font = FontDesc::new(FontFamily::Name(FAMILY), size * self.scale, FontStyle::Normal);
        TextStyle::from(font).color(&INK).pos(Pos::new(h_pos, VPos::Center))
    }

    fn width(self, width: f64) -> u32 {
        self.units(width).unsigned_abs().max(1)
    }
}

/// The powers of ten around the values.
fn decades(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|value| value.is_finite() && *value > 0.0)
        .fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return (1e-6, 1.0);
    }
    let (down, up) = (10_f64.powf(low.log10().floor()), 10_f64.powf(high.log10().ceil()));
    if up > down { (down, up) } else { (down, 10.0 * down) }
}

#[allow(clippy::trivially_copy_pass_by_ref)] // the signature that the drawing library asks for
fn power(value: &f64) -> String {
    format!("{value:.0e}").replace('-', "\u{2212}")
}

impl Bars {
    fn draw<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        area: &DrawingArea<DB, Shift>,
        pen: Pen,
    ) -> Result<(), Failed> {
        let width = i32::try_from(area.dim_in_pixel().0)?;
        let (plot, legend) = area.split_horizontally(width - pen.units(210.0));
        let (low, high) =
            decades(self.series.iter().flat_map(|(_, v)| v.iter().copied().flatten()));
        let groups = self.groups.len() as f64;
        let mut chart = ChartBuilder::on(&plot)
            .margin(pen.units(12.0))
            .x_label_area_size(pen.units(36.0))
            .y_label_area_size(pen.units(74.0))
            .build_cartesian_2d(0.0..groups, (low..high).log_scale())?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .x_labels(0)
            .y_desc(self.y_label.as_str())
            .axis_desc_style(pen.text(13.0, HPos::Center))
            .y_label_formatter(&power)
            .y_label_style(pen.text(12.0, HPos::Right))
            .bold_line_style(GRID)
            .light_line_style(WHITE.mix(0.0))
            .draw()?;
        let slot = 0.84 / self.series.len().max(1) as f64;
        for (k, (_, values)) in self.series.iter().enumerate() {
            let bars = values.iter().enumerate().filter_map(|(g, value)| {
                let left = g as f64 + 0.08 + k as f64 * slot;
                let corners = [(left, low), (left + 0.9 * slot, (*value)?)];
                Some(Rectangle::new(corners, COLOURS[k % COLOURS.len()].filled()))
            });
            chart.draw_series(bars)?;
        }
        for (g, group) in self.groups.iter().enumerate() {
            let (x, y) = chart.backend_coord(&(g as f64 + 0.5, low));
            let (left, top) = plot.get_base_pixel();
            // Many names find room on two lines only.
            let (upper, lower) =
                group.split_once(", ").filter(|_| self.groups.len() > 8).unwrap_or((group, ""));
            let style = pen.text(if lower.is_empty() { 12.0 } else { 10.0 }, HPos::Center);
            plot.draw_text(upper, &style, (x - left, y - top + pen.units(14.0)))?;
            if !lower.is_empty() {
                plot.draw_text(lower, &style, (x - left, y - top + pen.units(28.0)))?;
            }
        }
        for (k, (name, _)) in self.series.iter().enumerate() {
            let y = pen.units(28.0 + 22.0 * k as f64);
            let (half, side) = (pen.units(6.0), pen.units(12.0));
            let square = [(0, y - half), (side, y + half)];
            legend.draw(&Rectangle::new(square, COLOURS[k % COLOURS.len()].filled()))?;
            legend.draw_text(name, &pen.text(12.0, HPos::Left), (pen.units(20.0), y))?;
        }
        Ok(())
    }
}

impl Scatter {
    fn draw<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        area: &DrawingArea<DB, Shift>,
        pen: Pen,
    ) -> Result<(), Failed> {
        let columns = self.panels.len().clamp(1, 2);
        let areas = area.split_evenly((self.panels.len().div_ceil(2).max(1), columns));
        // One scale for all, so that the charts can be compared.
        let values = self.panels.iter().flat_map(|panel| &panel.points).flat_map(|(x, y)| [*x, *y]);
        let scale = decades(values);
        let mut charts = self.panels.iter().zip(&areas);
        charts.try_for_each(|(panel, area)| panel.draw(area, pen, scale))
    }
}

impl Panel {
    fn draw<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        area: &DrawingArea<DB, Shift>,
        pen: Pen,
        (low, high): (f64, f64),
    ) -> Result<(), Failed> {
        let below = self.points.iter().filter(|(x, y)| y < x).count();
        let count = format!("{below} of {} trials below the diagonal", self.points.len());
        let mut chart = ChartBuilder::on(area)
            .margin(pen.units(14.0))
            .caption(count, pen.text(13.0, HPos::Center))
            .x_label_area_size(pen.units(54.0))
            .y_label_area_size(pen.units(78.0))
            .build_cartesian_2d((low..high).log_scale(), (low..high).log_scale())?;
        chart
            .configure_mesh()
            .x_desc(self.x_label.as_str())
            .y_desc(self.y_label.as_str())
            .axis_desc_style(pen.text(13.0, HPos::Center))
            .x_label_formatter(&power)
            .y_label_formatter(&power)
            .x_label_style(pen.text(11.0, HPos::Center))
            .y_label_style(pen.text(11.0, HPos::Right))
            .bold_line_style(GRID)
            .light_line_style(WHITE.mix(0.0))
            .draw()?;
        let diagonal = INK.stroke_width(pen.width(1.0));
        chart.draw_series(LineSeries::new([(low, low), (high, high)], diagonal))?;
        chart.draw_series(
            self.points
                .iter()
                .map(|point| Circle::new(*point, pen.units(4.0), COLOURS[4].mix(0.6).filled())),
        )?;
        let frame = [(low, low), (low, high), (high, high), (high, low), (low, low)];
        chart.draw_series([PathElement::new(frame, INK.stroke_width(pen.width(0.8)))])?;
        Ok(())
    }
}
