//! Analog channels: force plates, EMG and whatever else was sampled with the points.

use super::C3d;
use super::layout::{Layout, Storage};
use super::parameters::Parameters;

/// The analog channels of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AnalogInfo {
    /// Number of channels, C.
    pub channels: usize,
    /// Samples of one channel per frame of points.
    pub samples_per_frame: usize,
    /// Labels, one per channel, empty where the file has none.
    pub labels: Vec<String>,
    /// Units, one per channel, empty where the file has none.
    pub units: Vec<String>,
}

/// Samples of all analog channels.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalogData {
    /// Samples per channel, S.
    pub samples: usize,
    /// Channels, C.
    pub channels: usize,
    /// Scaled values `(S, C)`, sample after sample: `(raw - offset) * scale * general scale`.
    ///
    /// # Units
    ///
    /// Those of [`AnalogInfo::units`].
    pub values: Vec<f32>,
}

/// Splits the analog values of a frame into channels and samples.
pub(crate) fn info(layout: &Layout, header_samples: usize, parameters: &Parameters) -> AnalogInfo {
    let total = layout.analog_per_frame;
    if total == 0 {
        return AnalogInfo::default();
    }
    let used =
        parameters.count("ANALOG", "USED").filter(|&used| used > 0 && total.is_multiple_of(used));
    let by_header = (header_samples > 0 && total.is_multiple_of(header_samples))
        .then(|| total / header_samples);
    let channels = used.or(by_header).unwrap_or(total);
    let texts = |name| {
        let mut texts = parameters.long_texts("ANALOG", name);
        texts.resize(channels, String::new());
        texts
    };
    AnalogInfo {
        channels,
        samples_per_frame: total / channels,
        labels: texts("LABELS"),
        units: texts("UNITS"),
    }
}

/// Implements [C3D] "Analog data": scale, offset and general scale of each channel.
pub(crate) fn decode(file: &C3d) -> AnalogData {
    let layout = file.layout();
    let channels = file.analog().channels;
    if channels == 0 || layout.frames == 0 {
        return AnalogData { samples: 0, channels, values: Vec::new() };
    }
    let unsigned = is_unsigned(file.parameters());
    let real = matches!(layout.storage, Storage::Real { .. });
    let calibration = calibration(file.parameters(), channels, unsigned, real);
    let frame_bytes = layout.frame_bytes();
    let value_bytes = layout.storage.value_bytes();
    let skipped = layout.points * 4 * value_bytes;
    let processor = file.processor();
    let raw = |bytes: &[u8]| -> f64 {
        if real {
            f64::from(processor.f32_at(bytes, 0))
        } else {
            word(processor.u16_at(bytes, 0), unsigned)
        }
    };
    let mut values = Vec::with_capacity(layout.frames * layout.analog_per_frame);
    for frame in file.frame_bytes(0..layout.frames).chunks_exact(frame_bytes) {
        let samples = frame[skipped..].chunks_exact(value_bytes).zip(calibration.iter().cycle());
        values
            .extend(samples.map(|(bytes, &(offset, scale))| narrow((raw(bytes) - offset) * scale)));
    }
    AnalogData { samples: layout.frames * file.analog().samples_per_frame, channels, values }
}

fn is_unsigned(parameters: &Parameters) -> bool {
    let format = parameters.get("ANALOG", "FORMAT").and_then(|format| format.text());
    format.is_some_and(|format| format.eq_ignore_ascii_case("UNSIGNED"))
}

/// Offset and whole scale of each channel.
///
/// Floats hold the words of an offset-binary converter as 0 to 65,535, whose middle of 32,768 overflows the signed
/// offset; there is no other reading of an offset of -32,768 that keeps a 16-bit converter within its range.
fn calibration(
    parameters: &Parameters,
    channels: usize,
    unsigned: bool,
    real: bool,
) -> Vec<(f64, f64)> {
    let general = parameters.number("ANALOG", "GEN_SCALE").unwrap_or(1.0);
    let scales = parameters.long_numbers("ANALOG", "SCALE");
    let offsets = parameters.long_numbers("ANALOG", "OFFSET");
    let overflows = |value: f64| value < 0.0 && (unsigned || (real && value <= -32_768.0));
    let offset = |value: f64| if overflows(value) { value + 65_536.0 } else { value };
    (0..channels)
        .map(|channel| {
            let scale = scales.get(channel).copied().unwrap_or(1.0);
            (offset(offsets.get(channel).copied().unwrap_or(0.0)), scale * general)
        })
        .collect()
}

fn word(word: u16, unsigned: bool) -> f64 {
    if unsigned { f64::from(word) } else { f64::from(word.cast_signed()) }
}

#[expect(clippy::cast_possible_truncation, reason = "24 bits hold any sample of a converter")]
fn narrow(value: f64) -> f32 {
    value as f32
}
