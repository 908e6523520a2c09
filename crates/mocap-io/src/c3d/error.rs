//! What can go wrong while a C3D file is read, patched or written.

/// A refused C3D file, edit or recording.
///
/// Byte positions count from the start of the file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum C3dError {
    /// The file ends before its header does.
    #[error(
        "the file holds {len} bytes and a C3D header alone takes 512; restore the file from its source"
    )]
    TooShort {
        /// Bytes in the file.
        len: usize,
    },
    /// The second byte is not the C3D key.
    #[error(
        "byte 1 is {found:#04x} and a C3D file has 0x50 there; this is not a C3D file or its header is damaged"
    )]
    NotC3d {
        /// The byte found.
        found: u8,
    },
    /// The header points to a parameter section that is not in the file.
    #[error(
        "byte 0 puts the parameter section at block {block} (byte {byte}) and the file ends at byte {len}; \
         the header is damaged or the file is cut off"
    )]
    ParametersOutside {
        /// Block of 512 bytes named by the header, counted from 1.
        block: u8,
        /// Where that block would start.
        byte: usize,
        /// Bytes in the file.
        len: usize,
    },
    /// The processor byte is none of the three known ones.
    #[error(
        "byte {byte} names processor {found} and only 84 (Intel), 85 (DEC) and 86 (SGI) exist; the file is damaged"
    )]
    UnknownProcessor {
        /// Position of the processor byte.
        byte: usize,
        /// The byte found.
        found: u8,
    },
    /// The file ends inside the parameter section.
    #[error(
        "the parameter entry at byte {byte} needs the file to reach byte {needed} and it ends at byte {len}; \
         the file is cut off"
    )]
    ParametersTruncated {
        /// Start of the entry.
        byte: usize,
        /// First byte after what the entry needs.
        needed: usize,
        /// Bytes in the file.
        len: usize,
    },
    /// A parameter entry reaches past the end of the parameter section.
    #[error(
        "the parameter entry at byte {byte} reaches to byte {needed} and its section ends at byte {end}; \
         the section is damaged (reading with salvage stops before this entry)"
    )]
    ParameterOverrun {
        /// Start of the entry.
        byte: usize,
        /// First byte after what the entry claims.
        needed: usize,
        /// End of the parameter section.
        end: usize,
    },
    /// The parameter section holds more entries than any recording has.
    #[error(
        "the parameter section holds more than {limit} entries at byte {byte}; the section is damaged"
    )]
    TooManyParameters {
        /// The limit.
        limit: usize,
        /// Where the limit was passed.
        byte: usize,
    },
    /// Neither the header nor `POINT:DATA_START` names a usable data block.
    #[error(
        "the data start at block {header_block} in the header and {parameter_block:?} in POINT:DATA_START, and neither \
         lies outside the header and the parameter section (bytes {section_start} to {section_end}); the file is damaged"
    )]
    DataStartInvalid {
        /// Header word 9.
        header_block: u16,
        /// `POINT:DATA_START`, where present.
        parameter_block: Option<u16>,
        /// First byte of the parameter section.
        section_start: usize,
        /// First byte after the parameter section.
        section_end: usize,
    },
    /// The header counts its frames backwards and no parameter gives a count.
    #[error(
        "header words 4 and 5 name frames {first} to {last} and no parameter gives a frame count; the header is damaged"
    )]
    FrameCountInvalid {
        /// First frame.
        first: u16,
        /// Last frame.
        last: u16,
    },
    /// The scale can neither say the storage nor scale integers.
    #[error(
        "POINT:SCALE is {parameter:?} and header words 7-8 hold {header}; a C3D file needs a finite scale other than \
         zero, negative for real storage"
    )]
    ScaleInvalid {
        /// Scale of the header.
        header: f32,
        /// `POINT:SCALE`, where present.
        parameter: Option<f32>,
    },
    /// The data section is shorter than the declared frames.
    #[error(
        "{declared_frames} frames of {frame_bytes} bytes are declared from byte {data_start} on and the data end at byte {data_end} \
         after {available_frames} whole frames; the file is cut off (reading with salvage keeps the whole frames)"
    )]
    Truncated {
        /// Frames the file declares.
        declared_frames: usize,
        /// Whole frames that are there.
        available_frames: usize,
        /// Bytes of one frame of points and analog samples.
        frame_bytes: usize,
        /// First byte of the data section.
        data_start: usize,
        /// First byte after the data section.
        data_end: usize,
    },
    /// The rotation data section is shorter than declared.
    #[error(
        "rotation data need bytes {start} to {end} and the file ends at byte {len}; the file is cut off (reading with \
         salvage goes on without them)"
    )]
    RotationsTruncated {
        /// First byte of the rotation data.
        start: usize,
        /// First byte after the declared rotation data.
        end: usize,
        /// Bytes in the file.
        len: usize,
    },
    /// Header and parameters describe different data sections and no choice accounts for the file.
    #[error(
        "header and parameters disagree about the data section (the header means {header_bytes} bytes from byte \
         {data_start} on) and no combination of them accounts for the {available_bytes} bytes there; the file is cut \
         off or damaged (reading with salvage takes the header's word)"
    )]
    LayoutConflict {
        /// First byte of the data section by the header.
        data_start: usize,
        /// Size of the data section by the header.
        header_bytes: usize,
        /// Bytes of the file that can be data.
        available_bytes: usize,
    },
    /// An edit names a sample the file does not have.
    #[error(
        "there is no sample at frame {frame}, point {point}: the file has {frames} frames and {points} points, both counted from 0"
    )]
    EditOutside {
        /// Frame of the edit.
        frame: usize,
        /// Point of the edit.
        point: usize,
        /// Frames in the file.
        frames: usize,
        /// Points in the file.
        points: usize,
    },
    /// A fill is NaN or infinite.
    #[error(
        "the fill at frame {frame}, point {point} is {value:?} and only finite coordinates can be written; mark the \
         sample as missing instead"
    )]
    FillNotFinite {
        /// Frame of the edit or sample.
        frame: usize,
        /// Point of the edit or sample.
        point: usize,
        /// The coordinates given.
        value: [f64; 3],
    },
    /// A coordinate does not fit the file's storage.
    #[error(
        "the coordinate {value} at frame {frame}, point {point} is beyond ±{limit}, the limit of the file's storage and \
         scale; write a file with real storage or a larger scale"
    )]
    FillOutOfRange {
        /// Frame of the edit or sample.
        frame: usize,
        /// Point of the edit or sample.
        point: usize,
        /// The coordinate, in file units.
        value: f64,
        /// The largest magnitude that can be stored, in file units.
        limit: f64,
    },
    /// A fill would be stored as (0, 0, 0), which every reader takes for a missing sample.
    #[error(
        "the fill at frame {frame}, point {point} is stored as (0, 0, 0), which reads as missing; move it by more than \
         half a storage step or read with zeros as data"
    )]
    FillReadsAsMissing {
        /// Frame of the edit.
        frame: usize,
        /// Point of the edit.
        point: usize,
    },
    /// An analog value of a new recording does not fit its storage.
    #[error(
        "the analog value {value} at frame {frame}, channel {channel} does not fit the storage and its scale; write real \
         storage or a larger scale"
    )]
    AnalogOutOfRange {
        /// Frame of the value.
        frame: usize,
        /// Channel of the value.
        channel: usize,
        /// The value.
        value: f32,
    },
    /// The arrays of a new recording do not fit each other.
    #[error(
        "{what} has {found} elements and {expected} are needed by the labels and frame count given"
    )]
    ShapeMismatch {
        /// Which array.
        what: &'static str,
        /// Elements it has.
        found: usize,
        /// Elements it must have.
        expected: usize,
    },
    /// A count or a text of a new recording is beyond what the format can hold.
    #[error(
        "{what} is {found} and a C3D file holds at most {limit}; split the recording or shorten its texts"
    )]
    BeyondFormat {
        /// What is too large.
        what: &'static str,
        /// The size given.
        found: usize,
        /// The largest size the format can hold.
        limit: usize,
    },
    /// A number of a new recording is outside its range.
    #[error("{what} is {value} and must be finite and greater than zero")]
    NotPositive {
        /// Which number.
        what: &'static str,
        /// The value given.
        value: f64,
    },
}
