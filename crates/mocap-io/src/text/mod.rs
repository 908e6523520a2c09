//! Text formats: marker tables (TRC, CSV, TSV) and skeletons with motion (BVH, ASF/AMC).
//!
//! # Missing samples
//! A marker is missing in a frame if any of its three fields is blank, is a spelling of "not a
//! number" (`NaN` in any case, infinities, `1.#QNAN`, `NULL`, `N/A`), or if all three are exactly
//! zero, unless [`ReadOptions::zero_is_position`](crate::ReadOptions::zero_is_position) says
//! otherwise. Zeros count as missing in every table: Qualisys and many scripts write them, and
//! no camera measures exactly the origin. [`FileInfo::missing`](crate::FileInfo::missing) says how often each was met.
//! What is written as missing is an empty field, as `OpenSim` wants it.
//!
//! # Precision
//! Positions are written with decimals that resolve 10⁻⁶ mm (six in millimetres, nine in metres). A
//! position that would read as three zeros is written 10⁻⁶ mm off the origin.
//!
//! # Damage
//! Counts in headers are checked against the file, and every row against the width of the
//! table. A last line without a line end may have lost digits and is noted.

pub mod amc;
pub mod asf;
pub mod bvh;
mod error;
mod euler;
mod grid;
mod lines;
mod names;
mod number;
mod rate;
pub mod table;
pub mod trc;
mod write;

pub use error::TextError;
use mocap_core::Take;

use crate::{Edit, FileInfo, LengthUnit};

/// A marker table: what it holds, and the file that it came from.
pub struct Parsed {
    /// The markers.
    pub take: Take,
    /// What the file says of itself.
    pub info: FileInfo,
    /// The file.
    pub document: Box<dyn Document>,
}

impl std::fmt::Debug for Parsed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let bytes = self.document.bytes().len();
        f.debug_struct("Parsed")
            .field("info", &self.info)
            .field("bytes", &bytes)
            .finish_non_exhaustive()
    }
}

/// A file of markers that can be written again with some samples changed.
pub trait Document: Send + Sync {
    /// The file as it was read.
    fn bytes(&self) -> &[u8];

    /// The file with the fields of some samples changed, and every other byte kept: header, spacing,
    /// line ends, other columns and the digits of untouched samples.
    ///
    /// Where two edits name one sample, the later one counts.
    ///
    /// # Errors
    /// [`TextError::OutOfRange`] and [`TextError::NotFinite`] for edits that do not fit.
    fn patch(&self, edits: &[Edit]) -> Result<Vec<u8>, TextError>;
}

/// How to write a take as a new table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EncodeOptions {
    /// Unit of length in the file; default millimetre.
    pub unit: LengthUnit,
    /// Number of the first frame; default 1.
    pub first_frame: i64,
}

impl Default for EncodeOptions {
    fn default() -> Self {
        Self { unit: LengthUnit::Millimetre, first_frame: 1 }
    }
}
