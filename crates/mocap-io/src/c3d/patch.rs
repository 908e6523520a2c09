//! Writing single samples into a copy of the file.

use super::C3d;
use super::error::C3dError;
use super::layout::Storage;
use super::number::Processor;

/// A new value for one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleEdit {
    /// Frame, counted from 0.
    pub frame: usize,
    /// Point, counted from 0.
    pub point: usize,
    /// What to write.
    pub value: EditValue,
}

/// What an edit writes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EditValue {
    /// A filled position in file units. The residual word becomes 0, the standard's mark of a point that was not
    /// measured.
    Fill([f64; 3]),
    /// No position: coordinates 0 and residual word -1.
    Missing,
}

/// The file with the edits applied. Implements [C3D] "The 3D point residual" for both marks.
pub(crate) fn patch(file: &C3d, edits: &[SampleEdit]) -> Result<Vec<u8>, C3dError> {
    let mut bytes = file.bytes().to_vec();
    let writer = SampleWriter { processor: file.processor(), storage: file.storage() };
    let layout = file.layout();
    for edit in edits {
        let SampleEdit { frame, point, value } = *edit;
        let range = file.sample_bytes(frame, point);
        let Some(cell) = range.and_then(|range| bytes.get_mut(range)) else {
            return Err(C3dError::EditOutside {
                frame,
                point,
                frames: layout.frames,
                points: layout.points,
            });
        };
        match value {
            EditValue::Missing => writer.write(cell, None, -1, frame, point)?,
            EditValue::Fill(position) => {
                let zero = writer.write(cell, Some(position), 0, frame, point)?;
                if zero && file.zero_is_missing().get(point) == Some(&true) {
                    return Err(C3dError::FillReadsAsMissing { frame, point });
                }
                zero
            }
        };
    }
    Ok(bytes)
}

/// Writes samples in one storage.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SampleWriter {
    pub processor: Processor,
    pub storage: Storage,
}

impl SampleWriter {
    /// Writes one sample into its 8 or 16 bytes and says whether its stored coordinates are all zero.
    pub fn write(
        &self,
        cell: &mut [u8],
        position: Option<[f64; 3]>,
        word: i16,
        frame: usize,
        point: usize,
    ) -> Result<bool, C3dError> {
        let value = position.unwrap_or_default();
        if !value.iter().all(|coordinate| coordinate.is_finite()) {
            return Err(C3dError::FillNotFinite { frame, point, value });
        }
        let limit = self.limit();
        if let Some(&value) = value.iter().find(|coordinate| !self.fits(**coordinate)) {
            return Err(C3dError::FillOutOfRange { frame, point, value, limit });
        }
        Ok(match self.storage {
            Storage::Integer { scale } => self.write_integers(cell, value, f64::from(scale), word),
            Storage::Real { .. } => self.write_reals(cell, value, word),
        })
    }

    fn limit(&self) -> f64 {
        match self.storage {
            Storage::Integer { scale } => f64::from(i16::MAX) * f64::from(scale),
            Storage::Real { .. } => self.processor.largest_real(),
        }
    }

    fn fits(&self, coordinate: f64) -> bool {
        match self.storage {
            Storage::Integer { scale } => {
                (coordinate / f64::from(scale)).round().abs() <= f64::from(i16::MAX)
            }
            Storage::Real { .. } => coordinate.abs() <= self.processor.largest_real(),
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "the range is checked before")]
    fn write_integers(&self, cell: &mut [u8], position: [f64; 3], scale: f64, word: i16) -> bool {
        let steps = position.map(|coordinate| (coordinate / scale).round() as i16);
        let words = steps.into_iter().chain([word]);
        for (slot, word) in cell.chunks_exact_mut(2).zip(words) {
            slot.copy_from_slice(&self.processor.i16_bytes(word));
        }
        steps == [0; 3]
    }

    #[expect(clippy::cast_possible_truncation, reason = "the range is checked before")]
    fn write_reals(&self, cell: &mut [u8], position: [f64; 3], word: i16) -> bool {
        let stored = position.map(|coordinate| coordinate as f32);
        let values = stored.into_iter().chain([f32::from(word)]);
        for (slot, value) in cell.chunks_exact_mut(4).zip(values) {
            slot.copy_from_slice(&self.processor.f32_bytes(value));
        }
        stored.iter().all(|&value| value == 0.0)
    }
}
