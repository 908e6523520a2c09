//! Figures on a page of one's own: the same lines, letters and colours, as SVG and as PNG.
//!
//! ```
//! use mocap_report::{ReportError, draw::{Align, Backend, Canvas, Drawing, Pen, colour, to_svg}};
//!
//! struct Slope;
//!
//! impl Drawing for Slope {
//!     fn size(&self) -> (u32, u32) {
//!         (120, 80)
//!     }
//!
//!     fn draw<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError> {
//!         canvas.polyline(&[(10.0, 70.0), (110.0, 20.0)], Pen::solid(colour::FILLED, 2.0))?;
//!         canvas.text("a slope", (60.0, 75.0), 11.0, Align::Centre, colour::INK)
//!     }
//! }
//!
//! let svg = to_svg(&Slope)?;
//! assert!(svg.starts_with(b"<svg") && svg.ends_with(b"</svg>\n"));
//! # Ok::<(), ReportError>(())
//! ```

use plotters::{
    backend::{BitMapBackend, SVGBackend},
    prelude::DrawingBackend,
};

use crate::ReportError;

mod canvas;

pub use canvas::{Align, Canvas, Pen, Point, colour};
use canvas::{Medium, SUBPIXELS};
pub(crate) use canvas::{printable, register_font};

/// What a page is drawn on.
pub trait Backend: DrawingBackend<ErrorType: 'static> {}

impl<DB: DrawingBackend<ErrorType: 'static>> Backend for DB {}

/// A page that can be drawn.
pub trait Drawing {
    /// Width and height in page units, which are the pixels of the SVG.
    fn size(&self) -> (u32, u32);

    /// Draws the page; it is white before.
    ///
    /// # Errors
    /// [`ReportError::Draw`].
    fn draw<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError>;
}

/// A page as SVG. The same page gives the same bytes.
///
/// # Errors
/// [`ReportError::Font`] and [`ReportError::Draw`].
pub fn to_svg(page: &impl Drawing) -> Result<Vec<u8>, ReportError> {
    register_font()?;
    let (width, height) = page.size();
    let mut svg = String::new();
    {
        let backend = SVGBackend::with_string(&mut svg, (width * SUBPIXELS, height * SUBPIXELS));
        paint(page, backend, Medium::Svg)?;
    }
    // The backend knows whole units only, so it is given small ones; the first tag scales them back.
    let units = format!("width=\"{}\" height=\"{}\"", width * SUBPIXELS, height * SUBPIXELS);
    let pixels = format!("width=\"{width}\" height=\"{height}\" stroke-linejoin=\"round\"");
    Ok(svg.replacen(&units, &pixels, 1).into_bytes())
}

/// A page as PNG, two pixels to each unit of the SVG. The same page gives the same bytes.
///
/// # Errors
/// [`ReportError::Font`], [`ReportError::Draw`] and [`ReportError::Png`].
pub fn to_png(page: &impl Drawing) -> Result<Vec<u8>, ReportError> {
    register_font()?;
    let (width, height) = page.size();
    let (fine_width, fine_height) = (width * SUBPIXELS, height * SUBPIXELS);
    let mut fine = vec![255_u8; 3 * fine_width as usize * fine_height as usize];
    paint(page, BitMapBackend::with_buffer(&mut fine, (fine_width, fine_height)), Medium::Bitmap)?;
    let pixels = shrink_image(&fine, fine_width as usize, (SUBPIXELS / PNG_SCALE) as usize);
    encode_png(&pixels, width * PNG_SCALE, height * PNG_SCALE)
}

/// Pixels of a PNG to each unit of the page.
const PNG_SCALE: u32 = 2;

fn paint<DB: Backend>(
    page: &impl Drawing,
    mut backend: DB,
    medium: Medium,
) -> Result<(), ReportError> {
    let (width, height) = page.size();
    let mut canvas = Canvas::new(&mut backend, medium);
    canvas.bar((0.0, 0.0), (f64::from(width), f64::from(height)), plotters::style::WHITE)?;
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
