use mocap_core::{CoreError, Mask, Take};
use thiserror::Error;

/// Why something cannot be measured.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MetricError {
    /// Two things of different size are compared.
    #[error(
        "{what} has {found_frames} frames × {found_markers} markers, but the take it is measured \
         against has {frames} × {markers}"
    )]
    Shape {
        /// What does not fit.
        what: &'static str,
        /// Frames that fit.
        frames: usize,
        /// Markers that fit.
        markers: usize,
        /// Frames that came.
        found_frames: usize,
        /// Markers that came.
        found_markers: usize,
    },
    /// The columns of two takes are not the same markers.
    #[error(
        "marker {index} is `{found}` in the filled take and `{expected}` in the truth; bring both into \
         one order with `Take::select`"
    )]
    Markers {
        /// Column of the first difference.
        index: usize,
        /// Name in the truth.
        expected: String,
        /// Name in the filled take.
        found: String,
    },
    /// There is nothing to score.
    #[error("no cell with a known truth is hidden; hide at least one observed sample")]
    NoHiddenCell,
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
}

/// Refuses a mask of another shape than the take.
pub(crate) fn check_mask(take: &Take, what: &'static str, mask: &Mask) -> Result<(), MetricError> {
    check_size(take, what, mask.frames(), mask.markers())
}

/// Refuses a filled take of another shape, or with other markers, than the truth.
pub(crate) fn check_takes(truth: &Take, filled: &Take) -> Result<(), MetricError> {
    check_size(truth, "the filled take", filled.frames(), filled.marker_count())?;
    let names = truth.markers().names().iter().zip(filled.markers().names());
    match names.enumerate().find(|(_, (expected, found))| expected != found) {
        Some((index, (expected, found))) => {
            Err(MetricError::Markers { index, expected: expected.clone(), found: found.clone() })
        }
        None => Ok(()),
    }
}

fn check_size(
    take: &Take,
    what: &'static str,
    found_frames: usize,
    found_markers: usize,
) -> Result<(), MetricError> {
    let (frames, markers) = (take.frames(), take.marker_count());
    if (frames, markers) == (found_frames, found_markers) {
        return Ok(());
    }
    Err(MetricError::Shape { what, frames, markers, found_frames, found_markers })
}
