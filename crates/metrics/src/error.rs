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
    /// Edges of length classes that make no classes.
    #[error("the edges of length classes must be finite seconds that increase from above 0")]
    Edges,
    /// Calibrations that do not add up.
    #[error(
        "calibrations counted for different multiples of sigma do not add up; count both for the same"
    )]
    Multiples,
    /// Arrays of joints of different size.
    #[error("{what} must be {expected:?} long, but is {found:?}")]
    JointShape {
        /// What does not fit.
        what: &'static str,
        /// The size that fits.
        expected: Vec<usize>,
        /// The size that came.
        found: Vec<usize>,
    },
    /// A matrix that is no rotation.
    #[error(
        "joint {joint} has no rotation in frame {frame}: its matrix is off by {deviation:.1e}; rotations \
         are orthonormal and not mirrored"
    )]
    Rotation {
        /// The frame.
        frame: usize,
        /// The joint.
        joint: usize,
        /// Largest entry of the transposed times itself less the identity; infinite for a mirror.
        deviation: f64,
    },
    /// A joint that is not there.
    #[error("there is no joint {joint}: the motion has {joints}, counted from 0")]
    Joint {
        /// The joint as given.
        joint: usize,
        /// Joints of the motion.
        joints: usize,
    },
    /// A choice of no joints.
    #[error("no joint is chosen; name at least one")]
    NoJoint,
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
