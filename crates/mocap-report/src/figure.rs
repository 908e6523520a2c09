use std::path::Path;

use mocap_core::{BoneSet, Filled, Mask, Take};

use crate::{
    ReportError,
    draw::{to_png, to_svg},
};

mod animation;
mod axes;
mod cell;
mod curve;
mod page;
mod spots;
mod stills;
mod timeline;

pub use animation::animate_motion;
use page::Page;
pub use spots::{MAX_SPOTS, Spot, plot_spots};
pub use stills::MotionPlot;
use stills::View;

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
    to_svg(&Page::plan(input))
}

/// Draws a figure as PNG, two pixels to each unit of the SVG.
///
/// # Errors
/// As [`render_svg`], and [`ReportError::Png`].
pub fn render_png(input: &PlotInput<'_>) -> Result<Vec<u8>, ReportError> {
    input.check()?;
    to_png(&Page::plan(input))
}

/// Draws a solved motion in the format that the path's extension names, and returns the bytes of the file: the skeleton
/// with the markers at six moments, and how far the markers miss over time.
///
/// # Errors
/// [`ReportError::Format`], and [`ReportError::Shape`] for markers of another length than the motion.
pub fn plot_motion(plot: &MotionPlot<'_>, path: &Path) -> Result<Vec<u8>, ReportError> {
    let format = FigureFormat::from_path(path)?;
    let view = View::new(plot)?;
    match format {
        FigureFormat::Svg => to_svg(&view),
        FigureFormat::Png => to_png(&view),
    }
}
