use std::path::Path;

use mocap_core::{BoneSet, Filled, Mask, Take};
use plotters::{
    backend::{BitMapBackend, SVGBackend},
    prelude::DrawingBackend,
};

use crate::ReportError;

mod axes;
mod canvas;
mod cell;
mod curve;
mod page;
mod timeline;

pub(crate) use canvas::printable;
use canvas::{Canvas, Medium, SUBPIXELS};
use page::Page;

/// Markers whose trajectories one figure can hold.
pub const MAX_FIGURE_MARKERS: usize = 12;

/// What a figure shows.
#[derive(Debug, Clone)]
pub struct PlotInput<'a> {
    /// Heading of the figure.
    pub title: &'a str,
    /// Measured and filled samples together.
    pub take: &'a Take,
    /// The cells of `take` that were measured, `(T, M)`; the rest of its samples were filled.
    pub measured: &'a Mask,
    /// The true motion, drawn dashed in the gaps.
    pub truth: Option<&'a Take>,
    /// Bones; those that end at a drawn marker are drawn.
    pub bones: &'a BoneSet,
    /// Markers whose trajectories are drawn, at most [`MAX_FIGURE_MARKERS`]; by default the three that
    /// lack the most samples.
    pub markers: Option<Vec<usize>>,
}

impl<'a> PlotInput<'a> {
    /// A take as it was measured.
    #[must_use]
    pub fn take(title: &'a str, take: &'a Take, bones: &'a BoneSet) -> Self {
        Self { title, take, measured: take.observed(), truth: None, bones, markers: None }
    }

    /// A fill.
    #[must_use]
    pub fn fill(title: &'a str, filled: &'a Filled, bones: &'a BoneSet) -> Self {
        let measured = filled.observed_cells();
        Self { measured, ..Self::take(title, filled.take(), bones) }
    }

    /// A measured take and the same take filled, as two files hold them.
    #[must_use]
    pub fn pair(title: &'a str, input: &'a Take, filled: &'a Take, bones: &'a BoneSet) -> Self {
        Self { measured: input.observed(), ..Self::take(title, filled, bones) }
    }

    /// What a marker is called in the figure: its bare name where all markers are of one subject.
    fn name(&self, marker: usize) -> &str {
        let markers = self.take.markers();
        let (subject, bare) = markers.split(marker);
        let one_subject = (0..markers.len()).all(|m| markers.split(m).0 == subject);
        if one_subject && !bare.trim().is_empty() { bare } else { markers.name(marker) }
    }

    fn check(&self) -> Result<(), ReportError> {
        self.check_size("the mask of measured cells", self.measured)?;
        if let Some(truth) = self.truth {
            self.check_size("the true take", truth.observed())?;
        }
        self.bones.check(self.take)?;
        let asked = self.markers.as_deref().unwrap_or_default();
        if asked.len() > MAX_FIGURE_MARKERS {
            let (asked, limit) = (asked.len(), MAX_FIGURE_MARKERS);
            return Err(ReportError::TooManyMarkers { asked, limit });
        }
        // `select` refuses indices out of range and indices that come twice.
        self.take.select(asked).map(drop).map_err(ReportError::from)
    }

    fn check_size(&self, what: &'static str, mask: &Mask) -> Result<(), ReportError> {
        let (frames, markers) = (self.take.frames(), self.take.marker_count());
        let (found_frames, found_markers) = (mask.frames(), mask.markers());
        if (frames, markers) == (found_frames, found_markers) {
            return Ok(());
        }
        Err(ReportError::Shape { what, frames, markers, found_frames, found_markers })
    }
}

/// File format of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureFormat {
    /// Scalable vector graphics, for papers and web pages.
    Svg,
    /// A bitmap, 2400 pixels wide.
    Png,
}

impl FigureFormat {
    /// The format that a file's extension names, in either case.
    ///
    /// # Errors
    /// [`ReportError::Format`] for any extension but `svg` and `png`.
    pub fn from_path(path: &Path) -> Result<Self, ReportError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(ReportError::Format { path: path.to_owned() }),
        }
    }
}

/// Draws a figure in the format that the path's extension names, and returns the bytes of the file.
///
/// Nothing is written: the caller decides how the file comes to its place.
///
/// # Errors
/// [`ReportError::Format`], and as [`render_svg`].
pub fn plot_take(input: &PlotInput<'_>, path: &Path) -> Result<Vec<u8>, ReportError> {
    match FigureFormat::from_path(path)? {
        FigureFormat::Svg => render_svg(input),
        FigureFormat::Png => render_png(input),
    }
}

/// Draws a figure as SVG.
///
/// # Errors
/// [`ReportError::Shape`], [`ReportError::TooManyMarkers`] and [`ReportError::Core`] for parts that do
/// not belong to one take.
pub fn render_svg(input: &PlotInput<'_>) -> Result<Vec<u8>, ReportError> {
    input.check()?;
    canvas::register_font()?;
    let page = Page::plan(input);
    let (width, height) = page.size();
    let mut svg = String::new();
    {
        let backend = SVGBackend::with_string(&mut svg, (width * SUBPIXELS, height * SUBPIXELS));
        draw(&page, backend, Medium::Svg)?;
    }
    // The backend knows whole units only, so it is given small ones; the first tag scales them back.
    let units = format!("width=\"{}\" height=\"{}\"", width * SUBPIXELS, height * SUBPIXELS);
    let pixels = format!("width=\"{width}\" height=\"{height}\" stroke-linejoin=\"round\"");
    Ok(svg.replacen(&units, &pixels, 1).into_bytes())
}

/// Draws a figure as PNG, two pixels to each unit of the SVG.
///
/// # Errors
/// As [`render_svg`], and [`ReportError::Png`].
pub fn render_png(input: &PlotInput<'_>) -> Result<Vec<u8>, ReportError> {
    input.check()?;
    canvas::register_font()?;
    let page = Page::plan(input);
    let (width, height) = page.size();
    let (fine_width, fine_height) = (width * SUBPIXELS, height * SUBPIXELS);
    let mut fine = vec![255_u8; 3 * fine_width as usize * fine_height as usize];
    let backend = BitMapBackend::with_buffer(&mut fine, (fine_width, fine_height));
    draw(&page, backend, Medium::Bitmap)?;
    let shrink = SUBPIXELS / PNG_SCALE;
    let pixels = shrink_image(&fine, fine_width as usize, shrink as usize);
    encode_png(&pixels, width * PNG_SCALE, height * PNG_SCALE)
}

/// Pixels of a PNG to each unit of the page.
const PNG_SCALE: u32 = 2;

fn draw<DB: DrawingBackend<ErrorType: 'static>>(
    page: &Page<'_>,
    mut backend: DB,
    medium: Medium,
) -> Result<(), ReportError> {
    let mut canvas = Canvas::new(&mut backend, medium);
    page.draw(&mut canvas)?;
    canvas.finish()
}

/// Averages squares of `by` × `by` RGB pixels.
fn shrink_image(fine: &[u8], fine_width: usize, by: usize) -> Vec<u8> {
    let (row, area) = (3 * fine_width, by * by);
    let mut pixels = Vec::with_capacity(fine.len() / area);
    for rows in fine.chunks_exact(by * row) {
        for x in 0..fine_width / by {
            for channel in 0..3 {
                let square = (0..area)
                    .map(|i| usize::from(rows[i / by * row + 3 * (x * by + i % by) + channel]));
                let mean = (square.sum::<usize>() + area / 2) / area;
                pixels.push(u8::try_from(mean).unwrap_or(u8::MAX));
            }
        }
    }
    pixels
}

fn encode_png(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, ReportError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_adaptive_filter(png::AdaptiveFilterType::Adaptive);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}
