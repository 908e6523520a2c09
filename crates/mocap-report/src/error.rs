use std::path::PathBuf;

use mocap_core::CoreError;
use thiserror::Error;

/// Why a report or a figure cannot be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A figure file of unknown kind.
    #[error("`{}` ends in neither .svg nor .png; name the figure one of the two", .path.display())]
    Format {
        /// The path as given.
        path: PathBuf,
    },
    /// Things of different size are drawn together.
    #[error(
        "{what} has {found_frames} frames × {found_markers} markers, but the take has {frames} × \
         {markers}"
    )]
    Shape {
        /// What does not fit.
        what: &'static str,
        /// Frames of the take.
        frames: usize,
        /// Markers of the take.
        markers: usize,
        /// Frames that came.
        found_frames: usize,
        /// Markers that came.
        found_markers: usize,
    },
    /// More curves than a page can hold.
    #[error("{asked} markers are to be drawn, but a figure holds at most {limit}; choose fewer")]
    TooManyMarkers {
        /// Markers asked for.
        asked: usize,
        /// Markers that fit.
        limit: usize,
    },
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
    /// The font that is part of this crate was refused.
    #[error("the built-in font cannot be used for figures")]
    Font,
    /// The drawing backend gave up.
    #[error("the figure cannot be drawn")]
    Draw(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// The image cannot be compressed.
    #[error("the figure cannot be written as PNG")]
    Png(#[from] png::EncodingError),
}
