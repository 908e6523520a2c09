//! C3D: a total, lossless reader, a writer that changes single samples and nothing else, and an encoder.
//!
//! Reads Intel, DEC and SGI files of integers and floats, from recordings with no points to such with more than 255
//! points and 65,535 frames. Any byte string gives a [`C3d`] or a typed [`C3dError`] with a position, and a file that
//! ends before its declared data do is refused.
//!
//! ```
//! use mocap_io::c3d::{C3d, C3dOptions, EditValue, NewC3d, SampleEdit};
//!
//! let mut new = NewC3d::new(vec!["LKNE".into(), "RKNE".into()], 100.0);
//! new.xyz = vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [1.1, 2.1, 3.1], [0.0; 3]];
//! new.missing = vec![false, false, false, true];
//! let file = C3d::parse(new.encode()?, &C3dOptions::default())?;
//!
//! let data = file.decode_points();
//! assert_eq!(data.position(1, 1), None);
//!
//! let fill = SampleEdit { frame: 1, point: 1, value: EditValue::Fill([4.1, 5.1, 6.1]) };
//! let patched = C3d::parse(file.patch(&[fill])?, &C3dOptions::default())?;
//! assert!(patched.decode_points().position(1, 1).is_some());
//! # Ok::<(), mocap_io::c3d::C3dError>(())
//! ```
//!
//! # Units
//!
//! Everything here stays in the file's own units and axes; [`C3d::units`] names them.

mod analog;
mod decode;
mod encode;
mod error;
mod events;
mod frame_count;
mod header;
mod layout;
mod number;
mod parameter_reader;
mod parameter_writer;
mod parameters;
mod patch;
mod points;
mod report;

use std::fmt;
use std::ops::Range;

pub use analog::{AnalogData, AnalogInfo};
pub use decode::{PointData, SampleCounts, SampleState, residual};
pub use encode::{NewAnalog, NewC3d, NewStorage};
pub use error::C3dError;
pub use events::Event;
pub use header::{Header, HeaderEvent};
pub use layout::Storage;
pub use number::Processor;
pub use parameter_writer::{NewGroup, NewParameter, NewValues};
pub use parameters::{Group, Parameter, ParameterKind, Parameters};
pub use patch::{EditValue, SampleEdit};
pub use points::{ModelOutput, PointInfo, PointKind};
pub use report::{Declaration, ReadNote, ReadReport};

use header::BLOCK;
use layout::Layout;

/// How a file is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct C3dOptions {
    /// Read what is there of a cut or damaged file, and note it in the report. Default: refuse such a file.
    pub salvage: bool,
    /// Take a marker at exactly (0, 0, 0) with a residual that is not negative as a position. Default: it is missing,
    /// which is what the writers of such samples mean.
    pub zeros_are_data: bool,
}

/// A C3D file: its bytes, and what they mean.
#[derive(Clone)]
pub struct C3d {
    bytes: Vec<u8>,
    processor: Processor,
    header: Header,
    parameters: Parameters,
    layout: Layout,
    points: Vec<PointInfo>,
    zero_is_missing: Vec<bool>,
    analog: AnalogInfo,
    report: ReadReport,
}

impl C3d {
    /// Reads a whole file.
    ///
    /// Never panics, and holds little more than the bytes themselves; the samples are decoded on request.
    ///
    /// # Errors
    ///
    /// A [`C3dError`] that names the position and the rule broken. A file with fewer frames than it declares is
    /// [`C3dError::Truncated`] unless `options.salvage` is set.
    pub fn parse(bytes: Vec<u8>, options: &C3dOptions) -> Result<Self, C3dError> {
        let mut notes = Vec::new();
        let processor = processor(&bytes)?;
        let header = Header::read(&bytes, processor);
        let parameters =
            parameter_reader::read(&bytes, &header, processor, options.salvage, &mut notes)?;
        if parameters.get("POINT", "USED").is_none() && parameters.get("POINT", "LABELS").is_none()
        {
            notes.push(ReadNote::NoParameters);
        }
        let layout = layout::resolve(&bytes, &header, &parameters, options.salvage, &mut notes)?;
        let data_end = check_tail(&bytes, &layout, &parameters, options.salvage, &mut notes)?;
        note_trailing_bytes(&bytes, data_end, &layout, &mut notes);
        let points = points::read(layout.points, &parameters, &mut notes);
        let zero_is_missing =
            points.iter().map(|point| !options.zeros_are_data && point.is_measured()).collect();
        let analog =
            analog::info(&layout, usize::from(header.analog_samples_per_frame), &parameters);
        let report = ReadReport { notes };
        Ok(Self {
            bytes,
            processor,
            header,
            parameters,
            layout,
            points,
            zero_is_missing,
            analog,
            report,
        })
    }

    /// The bytes given, unchanged.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The header as the file has it.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// All groups and parameters.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Whose number formats the file uses.
    #[must_use]
    pub fn processor(&self) -> Processor {
        self.processor
    }

    /// How samples are stored.
    #[must_use]
    pub fn storage(&self) -> Storage {
        self.layout.storage
    }

    /// Frames in the file, T.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.layout.frames
    }

    /// Number of the first frame, by which other files of the trial may refer to it.
    #[must_use]
    pub fn first_frame(&self) -> u32 {
        frame_count::first_frame(&self.header, &self.parameters)
    }

    /// Frames per second: `POINT:RATE`, else the header; `None` where neither is a positive number.
    #[must_use]
    pub fn point_rate_hz(&self) -> Option<f64> {
        let usable = |rate: &f64| rate.is_finite() && *rate > 0.0;
        let parameter = self.parameters.number("POINT", "RATE").filter(usable);
        parameter.or(Some(f64::from(self.header.rate_hz)).filter(usable))
    }

    /// The unit of coordinates as the file names it, like `mm`.
    #[must_use]
    pub fn units(&self) -> Option<String> {
        self.parameters.get("POINT", "UNITS")?.text()
    }

    /// The analog channels.
    #[must_use]
    pub fn analog(&self) -> &AnalogInfo {
        &self.analog
    }

    /// Events of the `EVENT` group, else of the header.
    #[must_use]
    pub fn events(&self) -> Vec<Event> {
        events::read(&self.header, &self.parameters)
    }

    /// The points in file order, M of them.
    #[must_use]
    pub fn points(&self) -> &[PointInfo] {
        &self.points
    }

    /// What was noticed while reading. Which dialects of "missing" the file uses is in [`PointData::counts`].
    #[must_use]
    pub fn report(&self) -> &ReadReport {
        &self.report
    }

    /// Decodes every sample of every point.
    #[must_use]
    pub fn decode_points(&self) -> PointData {
        decode::points(self, 0..self.frames())
    }

    /// Decodes the samples of some frames, counted from 0; frames past the end are left out.
    #[must_use]
    pub fn decode_frames(&self, frames: Range<usize>) -> PointData {
        decode::points(self, frames)
    }

    /// Decodes and scales the analog samples.
    #[must_use]
    pub fn decode_analog(&self) -> AnalogData {
        analog::decode(self)
    }

    /// The file with some samples changed and every other byte as it was. Later edits of a sample win.
    ///
    /// # Errors
    ///
    /// When an edit lies outside the file, is not finite, or does not fit the file's storage. Nothing is clamped.
    pub fn patch(&self, edits: &[SampleEdit]) -> Result<Vec<u8>, C3dError> {
        patch::patch(self, edits)
    }

    /// Bytes of all frames in the file, points and analog samples together.
    #[must_use]
    pub fn data_range(&self) -> Range<usize> {
        let start = self.layout.data_start;
        start..start + self.layout.frames.saturating_mul(self.layout.frame_bytes())
    }

    /// Bytes of one sample in the file: four values, at `(frame, point)` counted from 0.
    #[must_use]
    pub fn sample_bytes(&self, frame: usize, point: usize) -> Option<Range<usize>> {
        if frame >= self.layout.frames || point >= self.layout.points {
            return None;
        }
        let size = 4 * self.layout.storage.value_bytes();
        let start = self.layout.data_start + frame * self.layout.frame_bytes() + point * size;
        Some(start..start + size)
    }

    pub(crate) fn layout(&self) -> &Layout {
        &self.layout
    }

    pub(crate) fn zero_is_missing(&self) -> &[bool] {
        &self.zero_is_missing
    }

    pub(crate) fn frame_bytes(&self, frames: Range<usize>) -> &[u8] {
        let at = |frame: usize| self.layout.data_start + frame * self.layout.frame_bytes();
        self.bytes.get(at(frames.start)..at(frames.end)).unwrap_or_default()
    }
}

impl fmt::Debug for C3d {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { processor, header, layout, report, .. } = self;
        let mut debug = f.debug_struct("C3d");
        debug.field("len", &self.bytes.len()).field("processor", processor).field("header", header);
        debug.field("layout", layout).field("report", report).finish_non_exhaustive()
    }
}

/// Finds the processor byte, which says how to read everything before it.
fn processor(bytes: &[u8]) -> Result<Processor, C3dError> {
    let len = bytes.len();
    if len < BLOCK {
        return Err(C3dError::TooShort { len });
    }
    let (block, key) = (bytes[0], bytes[1]);
    if key != 0x50 {
        return Err(C3dError::NotC3d { found: key });
    }
    let byte = usize::from(block).saturating_sub(1) * BLOCK;
    match bytes.get(byte + 3) {
        Some(&found) if byte >= BLOCK => {
            Processor::from_byte(found).ok_or(C3dError::UnknownProcessor { byte: byte + 3, found })
        }
        _ => Err(C3dError::ParametersOutside { block, byte, len }),
    }
}

/// Start of the rotation data of files that have them.
pub(crate) fn rotation_start(parameters: &Parameters) -> Option<usize> {
    parameters.count("ROTATION", "USED").filter(|&used| used > 0)?;
    parameters.count("ROTATION", "DATA_START")?.checked_sub(1).map(|block| block * BLOCK)
}

/// First byte after the last data, with the rotation data checked against the file's length.
fn check_tail(
    bytes: &[u8],
    layout: &Layout,
    parameters: &Parameters,
    salvage: bool,
    notes: &mut Vec<ReadNote>,
) -> Result<usize, C3dError> {
    let data_end = layout.data_start + layout.frames.saturating_mul(layout.frame_bytes());
    let Some(start) = rotation_start(parameters) else { return Ok(data_end) };
    let used = parameters.count("ROTATION", "USED").unwrap_or_default();
    let ratio = parameters.count("ROTATION", "RATIO").unwrap_or(1).max(1);
    // A rotation is a 4x4 matrix and its reliability, all floats.
    let size = [17 * 4, ratio, layout.frames].into_iter().fold(used, usize::saturating_mul);
    let end = start.saturating_add(size);
    if end > bytes.len() {
        if !salvage {
            return Err(C3dError::RotationsTruncated { start, end, len: bytes.len() });
        }
        notes.push(ReadNote::RotationsSalvaged { missing_bytes: end - bytes.len() });
    }
    Ok(data_end.max(end))
}

fn note_trailing_bytes(bytes: &[u8], data_end: usize, layout: &Layout, notes: &mut Vec<ReadNote>) {
    let Some(rest) = bytes.get(data_end..).filter(|rest| !rest.is_empty()) else { return };
    let frames = rest.len().checked_div(layout.frame_bytes()).unwrap_or(0);
    let all_zero = rest.iter().all(|&byte| byte == 0);
    // Padding of the last block is part of the format and not worth a note.
    if rest.len() >= BLOCK || !bytes.len().is_multiple_of(BLOCK) {
        notes.push(ReadNote::TrailingBytes { bytes: rest.len(), frames, all_zero });
    }
}
