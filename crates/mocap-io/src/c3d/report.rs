//! What was noticed while a file was read.

use std::fmt;

/// What a reader should know about a file that was read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadReport {
    /// In the order they were noticed.
    pub notes: Vec<ReadNote>,
}

/// A declaration that header and parameters both make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Declaration {
    /// Number of points.
    PointCount,
    /// Number of frames.
    FrameCount,
    /// Analog values per frame.
    AnalogPerFrame,
    /// Block where the data start.
    DataStart,
    /// Scale of integer coordinates, whose sign says the storage.
    Scale,
    /// Frames per second.
    PointRate,
}

/// One thing noticed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ReadNote {
    /// Header and parameters disagree.
    Disagreement {
        /// About what.
        declaration: Declaration,
        /// The header's value.
        header: f64,
        /// The parameters' value.
        parameter: f64,
        /// The value taken.
        used: f64,
    },
    /// The file goes on after the declared data.
    TrailingBytes {
        /// How many bytes.
        bytes: usize,
        /// Whole frames that would fit there.
        frames: usize,
        /// Whether all of them are zero.
        all_zero: bool,
    },
    /// More than 65,535 frames with no parameter that says how many: counted from the file's length.
    FrameCountFromLength {
        /// Frames counted.
        frames: usize,
    },
    /// The parameter section is longer than it declares.
    ParametersBeyondDeclared {
        /// Bytes declared.
        declared: usize,
        /// Bytes used.
        used: usize,
    },
    /// Parameters were read up to a damaged entry.
    ParametersStopped {
        /// Start of the entry.
        byte: usize,
    },
    /// The file has no usable parameters and was read by its header alone.
    NoParameters,
    /// Fewer labels than points.
    MissingLabels {
        /// Points without a label.
        count: usize,
    },
    /// Labels that occur more than once were made unique.
    DuplicateLabels {
        /// Points whose name differs from their label.
        count: usize,
    },
    /// Points that no parameter lists as model outputs and whose names say that they are.
    InferredModelOutputs {
        /// How many.
        count: usize,
    },
    /// The file is cut off and its whole frames were kept.
    Salvaged {
        /// Frames the file declares.
        declared_frames: usize,
        /// Frames that were kept.
        available_frames: usize,
    },
    /// The rotation data are cut off.
    RotationsSalvaged {
        /// Bytes that are not there.
        missing_bytes: usize,
    },
}

impl fmt::Display for ReadNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disagreement { declaration, header, parameter, used } => {
                write!(
                    f,
                    "{declaration}: the header says {header}, the parameters say {parameter}; {used} was taken"
                )
            }
            Self::TrailingBytes { bytes, frames, all_zero } => write!(
                f,
                "{bytes} bytes{} follow the declared data, room for {frames} frames",
                if *all_zero { ", all zero," } else { "" }
            ),
            Self::FrameCountFromLength { frames } => {
                write!(
                    f,
                    "the 16-bit frame counts are saturated; {frames} frames counted from the file's length"
                )
            }
            Self::ParametersBeyondDeclared { declared, used } => {
                write!(f, "the parameter section declares {declared} bytes and uses {used}")
            }
            Self::ParametersStopped { byte } => {
                write!(f, "parameters end at a damaged entry at byte {byte}")
            }
            Self::NoParameters => write!(f, "no POINT parameters: read by the header alone"),
            Self::MissingLabels { count } => write!(f, "{count} points have no label"),
            Self::DuplicateLabels { count } => {
                write!(f, "{count} points have a label that an earlier point has too")
            }
            Self::InferredModelOutputs { count } => {
                write!(f, "{count} points are model outputs by their names alone")
            }
            Self::Salvaged { declared_frames, available_frames } => {
                write!(
                    f,
                    "the file is cut off: {available_frames} of {declared_frames} frames were kept"
                )
            }
            Self::RotationsSalvaged { missing_bytes } => {
                write!(f, "the rotation data are cut off by {missing_bytes} bytes")
            }
        }
    }
}

impl fmt::Display for Declaration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::PointCount => "number of points",
            Self::FrameCount => "number of frames",
            Self::AnalogPerFrame => "analog values per frame",
            Self::DataStart => "data block",
            Self::Scale => "scale",
            Self::PointRate => "frame rate",
        })
    }
}
