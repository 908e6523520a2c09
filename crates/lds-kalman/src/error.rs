//! What can be wrong with a model, with observations or with parameters.

use thiserror::Error;

/// Why a model, a set of observations or a fit was refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LdsError {
    /// An array does not have the shape its neighbours ask for.
    #[error(
        "{what} has shape {found_rows}×{found_columns}, but {rows}×{columns} is needed; \
         give matrices that agree on the hidden and observed dimensions"
    )]
    Shape {
        /// The array.
        what: &'static str,
        /// Rows needed.
        rows: usize,
        /// Columns needed.
        columns: usize,
        /// Rows found.
        found_rows: usize,
        /// Columns found.
        found_columns: usize,
    },
    /// A model without a hidden state or without an observed dimension.
    #[error("{what} must be at least 1; give a model with a hidden state and an observation")]
    ZeroDimension {
        /// The dimension that is zero.
        what: &'static str,
    },
    /// A model entry is NaN or infinite.
    #[error("{what} is not finite at row {row}, column {column}; give finite entries")]
    NotFinite {
        /// The array.
        what: &'static str,
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// A covariance is not symmetric positive definite.
    #[error("{what} is not symmetric positive definite; give one whose variances are all positive")]
    NotPositiveDefinite {
        /// The covariance.
        what: &'static str,
    },
    /// Correlated observation noise.
    #[error(
        "a full observation noise is not supported, because rows that are missing are dropped \
         one by one; choose an isotropic or diagonal observation noise"
    )]
    FullObservationNoise,
    /// An entry that the mask calls observed is NaN or infinite.
    #[error(
        "frame {frame}, dimension {dimension} is marked as observed but is not finite; \
         mark it as missing in the mask"
    )]
    ObservedNotFinite {
        /// Frame, counted from 0.
        frame: usize,
        /// Dimension, counted from 0.
        dimension: usize,
    },
    /// Too few frames for what was asked.
    #[error("{frames} frame(s) given, at least {needed} needed to learn a transition")]
    TooFewFrames {
        /// Frames given.
        frames: usize,
        /// Frames needed.
        needed: usize,
    },
    /// More hidden dimensions than observed ones.
    #[error(
        "{hidden} hidden dimensions asked for, but there are only {dimensions} observed ones; \
         ask for at most {dimensions}"
    )]
    HiddenTooLarge {
        /// Hidden dimensions asked for.
        hidden: usize,
        /// Observed dimensions.
        dimensions: usize,
    },
    /// Not one entry is observed.
    #[error(
        "nothing is observed in any frame; at least one observed entry is needed to learn from"
    )]
    NothingObserved,
    /// A parameter outside its range.
    #[error("{field} is {value}, allowed is {allowed}")]
    Parameter {
        /// Name of the field.
        field: &'static str,
        /// The value given.
        value: f64,
        /// The allowed range in words.
        allowed: &'static str,
    },
    /// The arithmetic failed before there was anything to return.
    #[error(
        "the recursion broke down in iteration {iteration}; rescale the data to values near one \
         or choose another start"
    )]
    Breakdown {
        /// Iteration, counted from 1.
        iteration: usize,
    },
}
