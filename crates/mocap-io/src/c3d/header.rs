//! The 512 bytes at the start of a C3D file.

use super::number::Processor;

/// Bytes of one block; positions in a header count blocks from 1.
pub(crate) const BLOCK: usize = 512;

const MAX_EVENTS: usize = 18;

/// The header as the file has it, with nothing corrected.
///
/// Implements [C3D] "Header section".
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Block of the parameter section, counted from 1.
    pub parameter_block: u8,
    /// Word 2: points per frame.
    pub points: u16,
    /// Word 3: analog values per frame, all channels and sub-samples together.
    pub analog_per_frame: u16,
    /// Word 4: number of the first frame.
    pub first_frame: u16,
    /// Word 5: number of the last frame.
    pub last_frame: u16,
    /// Word 6: longest gap, in frames, that was interpolated.
    pub max_interpolation_gap: u16,
    /// Words 7-8: scale from integers to file units; negative for real storage.
    pub scale: f32,
    /// Word 9: block of the data section, counted from 1.
    pub data_block: u16,
    /// Word 10: analog samples of one channel per frame.
    pub analog_samples_per_frame: u16,
    /// Words 11-12: frames per second.
    pub rate_hz: f32,
    /// The events of the header.
    pub events: Vec<HeaderEvent>,
}

/// One event of the header.
#[derive(Debug, Clone, PartialEq)]
pub struct HeaderEvent {
    /// Label of up to four characters.
    pub label: String,
    /// Time from the start of the recording, in seconds.
    pub time_s: f32,
    /// Whether the event is switched on.
    pub shown: bool,
}

impl Header {
    /// Decodes the header from the first block of a file.
    pub(crate) fn read(bytes: &[u8], processor: Processor) -> Self {
        let word = |number: usize| processor.u16_at(bytes, (number - 1) * 2);
        Self {
            parameter_block: bytes.first().copied().unwrap_or_default(),
            points: word(2),
            analog_per_frame: word(3),
            first_frame: word(4),
            last_frame: word(5),
            max_interpolation_gap: word(6),
            scale: processor.f32_at(bytes, 12),
            data_block: word(9),
            analog_samples_per_frame: word(10),
            rate_hz: processor.f32_at(bytes, 20),
            events: events(bytes, processor),
        }
    }

    /// Frames from the first to the last, or `None` where the last comes before the first.
    pub(crate) fn frame_count(&self) -> Option<usize> {
        (usize::from(self.last_frame) + 1).checked_sub(usize::from(self.first_frame))
    }
}

fn events(bytes: &[u8], processor: Processor) -> Vec<HeaderEvent> {
    let count = usize::from(processor.u16_at(bytes, 300)).min(MAX_EVENTS);
    (0..count)
        .map(|index| HeaderEvent {
            label: bytes.get(396 + index * 4..400 + index * 4).map(text).unwrap_or_default(),
            time_s: processor.f32_at(bytes, 304 + index * 4),
            // Zero is on: the flag of the standard counts 0x00 as displayed, 0x01 as not.
            shown: bytes.get(376 + index) == Some(&0),
        })
        .collect()
}

/// Text of a file: UTF-8 where it is, else Latin-1, without the padding at both ends.
pub(crate) fn text(bytes: &[u8]) -> String {
    let padding = |character: char| character.is_whitespace() || character == '\0';
    match std::str::from_utf8(bytes) {
        Ok(utf8) => utf8.trim_matches(padding).to_owned(),
        Err(_) => bytes
            .iter()
            .copied()
            .map(char::from)
            .collect::<String>()
            .trim_matches(padding)
            .to_owned(),
    }
}
