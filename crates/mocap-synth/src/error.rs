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
    #[error(
        "`{word}` is no activity; choose one of walk, run, jump, throw, turn, reach, kick, leap, corner"
    )]
    UnknownActivity {
        /// The word as given.
        word: String,
    },
    /// A word that names no layout.
    #[error("`{word}` is no marker layout; choose one of cmu-41, front_waist-53, production-57")]
    UnknownLayout {
        /// The word as given.
        word: String,
    },
    /// A word that is no number of finger markers.
    #[error("`{word}` is no number of finger markers a hand; choose 0, 5 or 10")]
    UnknownHands {
        /// The word as given.
        word: String,
    },
    /// A motion whose joints do not say where a part of the body is.
    #[error(
        "the motion to retarget has no joint for the {part}: it needs one of {names}; rename the joint in the \
         skeleton file, or take a skeleton of the CMU database's kind"
    )]
    NoSuchPart {
        /// The part of the body.
        part: &'static str,
        /// Names it may have, with commas between.
        names: String,
    },
    /// A motion whose skeleton cannot be stood beside the body.
    #[error(
        "the {part} of the motion to retarget has no length in the rest pose; give its bones their offsets"
    )]
    NoLength {
        /// The part of the body.
        part: &'static str,
    },
    /// A motion without frames.
    #[error("the motion to retarget has no frame")]
    NoFrames,
    /// A motion with NaN or infinity in it.
    #[error("frame {frame} of the motion to retarget holds a number that is not finite")]
    NotFinite {
        /// Zero-based frame.
        frame: usize,
    },
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
}
