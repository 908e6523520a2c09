use mocap_core::{CellState, Filled, Mask, Take};

use crate::{Format, LengthUnit};

/// Sampling rate in Hz of a file that states none, unless the reader is told better; a note says so.
/// It is that of the CMU recordings.
pub(crate) const ASSUMED_RATE_HZ: f64 = 120.0;

/// How to read a file.
#[derive(Debug, Clone, Default)]
pub struct ReadOptions {
    /// Read what is there of a file that is shorter than it declares, and say so in the notes.
    pub salvage: bool,
    /// Sampling rate in Hz for files that state none; a file's own rate wins.
    pub rate_hz: Option<f64>,
    /// Unit of length for files that state none; a file's own unit wins.
    pub unit: Option<LengthUnit>,
    /// Take a marker at exactly (0, 0, 0) as measured there, rather than as missing.
    pub zero_is_position: bool,
}

/// How the missing samples of a file are marked, as counts of cells.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MissingMarks {
    /// Negative residual (C3D).
    pub negative_residual: usize,
    /// A coordinate that is NaN or infinite.
    pub not_a_number: usize,
    /// All three coordinates exactly zero.
    pub exact_zero: usize,
    /// Empty fields.
    pub blank: usize,
}

/// What a file says of itself, beside the take.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FileInfo {
    /// Its format.
    pub format: Format,
    /// How it stores numbers, in words: `Intel, integer, scale 0.1`.
    pub storage: String,
    /// Its unit of length.
    pub unit: LengthUnit,
    /// Whether the file names that unit; otherwise it was given or assumed.
    pub unit_declared: bool,
    /// Whether the file states its sampling rate.
    pub rate_declared: bool,
    /// Number of its first frame, as the file counts.
    pub first_frame: i64,
    /// How its missing samples are marked.
    pub missing: MissingMarks,
    /// Points that are no markers: modelled angles, forces, powers, …, with their kind.
    pub other_points: Vec<(String, String)>,
    /// What a careful reader would want to know: disagreements, repairs, renamed labels.
    pub notes: Vec<String>,
}

impl FileInfo {
    /// A file in millimetres without remarks.
    #[must_use]
    pub fn new(format: Format, storage: impl Into<String>) -> Self {
        Self {
            format,
            storage: storage.into(),
            unit: LengthUnit::Millimetre,
            unit_declared: false,
            rate_declared: false,
            first_frame: 1,
            missing: MissingMarks::default(),
            other_points: Vec::new(),
            notes: Vec::new(),
        }
    }
}

/// A changed sample of a take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edit {
    /// Zero-based frame.
    pub frame: usize,
    /// Marker index in the take.
    pub marker: usize,
    /// The new content.
    pub sample: Sample,
}

/// What an edit puts in place of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sample {
    /// An estimated position in metres.
    Filled([f64; 3]),
    /// Nothing: the sample becomes missing.
    Missing,
}

impl Edit {
    /// The edits that write the filled samples of a take.
    #[must_use]
    pub fn fills(filled: &Filled) -> Vec<Self> {
        let take = filled.take();
        let cells = (0..take.frames()).flat_map(|t| (0..take.marker_count()).map(move |m| (t, m)));
        cells
            .filter(|&(t, m)| filled.state(t, m) == CellState::Filled)
            .filter_map(|(frame, marker)| {
                let sample = Sample::Filled(take.position(frame, marker)?);
                Some(Self { frame, marker, sample })
            })
            .collect()
    }

    /// The edits that make cells missing.
    #[must_use]
    pub fn hides(take: &Take, hidden: &Mask) -> Vec<Self> {
        hidden
            .iter()
            .filter(|&(t, m)| take.is_observed(t, m))
            .map(|(frame, marker)| Self { frame, marker, sample: Sample::Missing })
            .collect()
    }
}
