//! Bytes to coordinates, in one pass.

use std::ops::Range;

use super::C3d;
use super::layout::Storage;
use super::number::{Processor, vax_f32};

/// Whether a sample holds a position, and if not, how the file says so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum SampleState {
    /// The sample holds a position.
    Present = 0,
    /// The residual is negative: the mark of the standard.
    NegativeResidual = 1,
    /// A coordinate is NaN or infinite.
    NotFinite = 2,
    /// All coordinates are exactly zero while the residual is not negative. Not used for model outputs, where zero is
    /// a value, nor where the options take zeros as data.
    ExactZero = 3,
}

impl SampleState {
    /// Whether the sample holds no position.
    #[must_use]
    pub fn is_missing(self) -> bool {
        self != Self::Present
    }
}

/// How many samples are in each state: which dialects of "missing" the file uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SampleCounts {
    /// Samples that hold a position.
    pub present: usize,
    /// Samples with a negative residual.
    pub negative_residual: usize,
    /// Samples with a NaN or infinite coordinate and a residual that is not negative.
    pub not_finite: usize,
    /// Samples of exact zeros with a residual that is not negative.
    pub exact_zero: usize,
}

/// Samples of a range of frames: T frames, M points.
///
/// # Units
///
/// Coordinates are in the file's own units and axes.
#[derive(Debug, Clone, PartialEq)]
pub struct PointData {
    /// T.
    pub frames: usize,
    /// M.
    pub points: usize,
    /// Coordinates `(T, M, 3)`, frame after frame, as the file has them even where the sample is missing.
    pub xyz: Vec<[f32; 3]>,
    /// Residual words `(T, M)`: the fourth value of each sample as a 16-bit integer.
    pub words: Vec<i16>,
    /// States `(T, M)`.
    pub states: Vec<SampleState>,
}

impl PointData {
    /// Position of a sample in the arrays.
    #[must_use]
    pub fn index(&self, frame: usize, point: usize) -> usize {
        frame * self.points + point
    }

    /// The position of a sample in file units, or `None` where it is missing.
    ///
    /// # Panics
    ///
    /// Where `frame` or `point` is outside the data, as slices do.
    #[must_use]
    pub fn position(&self, frame: usize, point: usize) -> Option<[f64; 3]> {
        let index = self.index(frame, point);
        (!self.states[index].is_missing()).then(|| self.xyz[index].map(f64::from))
    }

    /// How many samples are in each state.
    #[must_use]
    pub fn counts(&self) -> SampleCounts {
        let mut counts = [0_usize; 4];
        for &state in &self.states {
            counts[state as usize] += 1;
        }
        let [present, negative_residual, not_finite, exact_zero] = counts;
        SampleCounts { present, negative_residual, not_finite, exact_zero }
    }
}

/// Cameras that saw a sample and the quality of the reconstruction, from a residual word.
///
/// Returns the camera mask (bit 0 is camera 1) and the residual in storage steps, or `None` for a missing sample.
/// Multiply the residual by [`Storage::scale`] for file units. Implements [C3D] "The 3D point residual".
#[must_use]
pub fn residual(word: i16) -> Option<(u8, u8)> {
    let [residual, cameras] = word.to_le_bytes();
    (word >= 0).then_some((cameras, residual))
}

pub(crate) fn points(file: &C3d, frames: Range<usize>) -> PointData {
    let layout = file.layout();
    let range = frames.start.min(layout.frames)..frames.end.min(layout.frames);
    let count = if layout.points == 0 { 0 } else { range.len() * layout.points };
    let mut data = PointData {
        frames: range.len(),
        points: layout.points,
        xyz: vec![[0.0; 3]; count],
        words: vec![0; count],
        states: vec![SampleState::Present; count],
    };
    if count == 0 {
        return data;
    }
    let bytes = file.frame_bytes(range);
    let zero_is_missing = file.zero_is_missing();
    let frame_bytes = layout.frame_bytes();
    let storage = layout.storage;
    match (storage, file.processor()) {
        (Storage::Real { .. }, Processor::Intel) => {
            fill::<16>(bytes, frame_bytes, zero_is_missing, &mut data, |s| {
                real(s, f32::from_le_bytes)
            });
        }
        (Storage::Real { .. }, Processor::Dec) => {
            fill::<16>(bytes, frame_bytes, zero_is_missing, &mut data, |s| real(s, vax_f32));
        }
        (Storage::Real { .. }, Processor::Sgi) => {
            fill::<16>(bytes, frame_bytes, zero_is_missing, &mut data, |s| {
                real(s, f32::from_be_bytes)
            });
        }
        (Storage::Integer { scale }, Processor::Intel | Processor::Dec) => {
            fill::<8>(bytes, frame_bytes, zero_is_missing, &mut data, |&s| {
                integer(s, scale, i16::from_le_bytes)
            });
        }
        (Storage::Integer { scale }, Processor::Sgi) => {
            fill::<8>(bytes, frame_bytes, zero_is_missing, &mut data, |&s| {
                integer(s, scale, i16::from_be_bytes)
            });
        }
    }
    data
}

#[inline]
fn fill<const N: usize>(
    bytes: &[u8],
    frame_bytes: usize,
    zero_is_missing: &[bool],
    data: &mut PointData,
    decode: impl Fn(&[u8; N]) -> ([f32; 3], i16),
) {
    let points = data.points;
    let outputs = data.xyz.chunks_exact_mut(points).zip(data.words.chunks_exact_mut(points));
    let outputs = outputs.zip(data.states.chunks_exact_mut(points));
    for (frame, ((xyz, words), states)) in bytes.chunks_exact(frame_bytes).zip(outputs) {
        let samples = frame.as_chunks::<N>().0;
        let cells = xyz.iter_mut().zip(words).zip(states).zip(zero_is_missing);
        for (sample, (((xyz, word), state), &zero_is_missing)) in samples.iter().zip(cells) {
            (*xyz, *word) = decode(sample);
            *state = classify(*xyz, *word, zero_is_missing);
        }
    }
}

#[inline]
fn classify([x, y, z]: [f32; 3], word: i16, zero_is_missing: bool) -> SampleState {
    // Shifted sign bits and products instead of six comparisons: the loop over samples stays free of branches.
    let zero = (x.to_bits() | y.to_bits() | z.to_bits()) << 1 == 0;
    let finite = x * 0.0 + y * 0.0 + z * 0.0 == 0.0;
    if word < 0 {
        SampleState::NegativeResidual
    } else if !finite {
        SampleState::NotFinite
    } else if zero && zero_is_missing {
        SampleState::ExactZero
    } else {
        SampleState::Present
    }
}

#[inline]
fn real(sample: &[u8; 16], value: impl Fn([u8; 4]) -> f32) -> ([f32; 3], i16) {
    let words = sample.as_chunks::<4>().0;
    ([value(words[0]), value(words[1]), value(words[2])], residual_word(value(words[3])))
}

#[inline]
fn integer(sample: [u8; 8], scale: f32, value: impl Fn([u8; 2]) -> i16) -> ([f32; 3], i16) {
    let words = sample.as_chunks::<2>().0;
    let coordinate = |word| f32::from(value(word)) * scale;
    ([coordinate(words[0]), coordinate(words[1]), coordinate(words[2])], value(words[3]))
}

/// The fourth value of a real sample as the 16-bit word that integer files hold.
///
/// 65535 is how some writers convert the word of a missing sample; values that no 16 bits hold (1.7e38 occurs, and NaN)
/// are no residual, and say nothing about the sample.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "the low 16 bits are the word")]
fn residual_word(value: f32) -> i16 {
    let word = value as i32 as i16;
    if value < -32768.0 {
        -1
    } else if value <= 65535.0 {
        word
    } else {
        0
    }
}
