use mocap_core::CoreError;
use thiserror::Error;

/// Why a synthetic take cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SynthError {
    /// A number of frames outside of the allowed range.
    #[error("{frames} frames are not between {min} and {max}; choose `frames` in that range")]
    Frames {
        /// The number as given.
        frames: usize,
        /// Smallest number allowed.
        min: usize,
        /// Largest number allowed.
        max: usize,
    },
    /// A parameter outside of the allowed range, or not a number.
    #[error(
        "`{name}` = {value} is not between {min} and {max} {unit}; choose a value in that range"
    )]
    OutOfRange {
        /// Name of the field of `SynthParams`.
        name: &'static str,
        /// The value as given.
        value: f64,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
        /// Unit of value and range.
        unit: &'static str,
    },
    /// A word that names no activity.
    #[error("`{word}` is no activity; choose one of walk, run, jump, throw")]
    UnknownActivity {
        /// The word as given.
        word: String,
    },
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
}
