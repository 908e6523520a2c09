use mocap_core::CoreError;
use thiserror::Error;

/// Why a text file cannot be read or patched.
///
/// Lines and fields are counted from 1; quoted text is shortened.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum TextError {
    /// No content at all.
    #[error("the file is empty")]
    Empty,
    /// Text in another encoding.
    #[error("the file is UTF-16 text, by the mark at its start; save it as UTF-8")]
    Utf16,
    /// The file ends too early.
    #[error("the file ends at line {line}, before {what}")]
    Ended {
        /// Last line of the file.
        line: usize,
        /// What should have come.
        what: &'static str,
    },
    /// A line that breaks a rule of its format.
    #[error("line {line}: `{text}`: {rule}")]
    Line {
        /// The line.
        line: usize,
        /// Its text.
        text: String,
        /// What would be right.
        rule: &'static str,
    },
    /// A field that breaks a rule of its format.
    #[error("line {line}, field {field}: `{text}` {rule}")]
    Field {
        /// The line.
        line: usize,
        /// The field.
        field: usize,
        /// Its text.
        text: String,
        /// What would be right.
        rule: &'static str,
    },
    /// A line with too few or too many fields.
    #[error(
        "line {line} has {found} fields, {expected} are needed; the line is damaged (reading with \
         salvage drops a damaged end)"
    )]
    Width {
        /// The line.
        line: usize,
        /// Fields that belong there.
        expected: usize,
        /// Fields that stand there.
        found: usize,
    },
    /// A header that promises another number of things than the file holds.
    #[error(
        "line {line} declares {declared} {what}, the file holds {found}; it is cut off or was \
         edited (reading with salvage takes what is there)"
    )]
    Count {
        /// Line of the declaration.
        line: usize,
        /// What is counted.
        what: &'static str,
        /// The number in the header.
        declared: usize,
        /// The number in the file.
        found: usize,
    },
    /// A header without any frame after it.
    #[error("no frame follows the header, which ends at line {line}")]
    NoFrames {
        /// Last line of the header.
        line: usize,
    },
    /// Column names without a single marker.
    #[error(
        "line {line}: no column is a marker coordinate; name them `NAME-x`, `NAME-y`, `NAME-z`"
    )]
    NoMarkers {
        /// Line of the column names.
        line: usize,
    },
    /// A marker without one of its three columns.
    #[error("line {line}: marker `{marker}` has no {axis} column; a marker needs x, y and z")]
    IncompleteMarker {
        /// Line of the column names.
        line: usize,
        /// The marker.
        marker: String,
        /// The first coordinate it lacks.
        axis: char,
    },
    /// Frames of a skeleton's motion that are not numbered one by one.
    #[error("line {line}: frame {found} comes where frame {expected} should; frames are lost")]
    FrameNumber {
        /// The line.
        line: usize,
        /// The number that should come.
        expected: i64,
        /// The number that comes.
        found: i64,
    },
    /// A frame of a skeleton's motion that leaves out a bone.
    #[error(
        "frame {frame}, which ends at line {line}, has no `{bone}`; it is cut off (reading with \
         salvage drops it)"
    )]
    MissingBone {
        /// Last line of the frame.
        line: usize,
        /// Number of the frame, as the file counts.
        frame: i64,
        /// The bone.
        bone: String,
    },
    /// A bone that is not in the skeleton, or comes twice.
    #[error("line {line}: bone `{bone}` {rule}")]
    Bone {
        /// The line.
        line: usize,
        /// The bone.
        bone: String,
        /// What would be right.
        rule: &'static str,
    },
    /// A motion that would be far larger than its file.
    #[error(
        "{frames} frames of {joints} joints in {bytes} bytes: nearly all joints lack motion \
         channels, which no recording does"
    )]
    Unbalanced {
        /// Frames read so far.
        frames: usize,
        /// Joints of the skeleton.
        joints: usize,
        /// Size of the file.
        bytes: usize,
    },
    /// An edit outside the take.
    #[error(
        "edit of (frame {frame}, marker {marker}) lies outside of {frames} frames × {markers} \
         markers"
    )]
    OutOfRange {
        /// Zero-based frame of the edit.
        frame: usize,
        /// Marker index of the edit.
        marker: usize,
        /// Frames of the file.
        frames: usize,
        /// Markers of the file.
        markers: usize,
    },
    /// An edit with a coordinate that no file can hold.
    #[error(
        "edit of (frame {frame}, marker {marker}) has a coordinate that is not finite; make the \
         sample missing instead"
    )]
    NotFinite {
        /// Zero-based frame of the edit.
        frame: usize,
        /// Marker index of the edit.
        marker: usize,
    },
    /// The content breaks a rule of the core types.
    #[error(transparent)]
    Core(#[from] CoreError),
}
