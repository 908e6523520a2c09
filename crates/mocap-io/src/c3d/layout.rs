//! Where the samples lie: header and parameters weighed against the bytes that are there.

use super::error::C3dError;
use super::frame_count;
use super::header::{BLOCK, Header};
use super::parameters::{Parameters, rounded};
use super::report::{Declaration, ReadNote};

/// How coordinates and analog values are stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Storage {
    /// 16-bit integers; coordinates are the integers times `scale`.
    Integer {
        /// File units per integer step, greater than zero.
        scale: f32,
    },
    /// 32-bit floats in file units.
    Real {
        /// Magnitude of the declared scale, which only scales residuals here.
        scale: f32,
    },
}

impl Storage {
    fn from_scale(scale: f32) -> Self {
        if scale < 0.0 { Self::Real { scale: -scale } } else { Self::Integer { scale } }
    }

    /// Magnitude of the declared scale.
    #[must_use]
    pub fn scale(self) -> f32 {
        match self {
            Self::Integer { scale } | Self::Real { scale } => scale,
        }
    }

    pub(crate) fn value_bytes(self) -> usize {
        match self {
            Self::Integer { .. } => 2,
            Self::Real { .. } => 4,
        }
    }
}

/// One reading of the declarations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Layout {
    pub storage: Storage,
    pub data_start: usize,
    pub frames: usize,
    pub points: usize,
    pub analog_per_frame: usize,
}

impl Layout {
    pub fn frame_bytes(&self) -> usize {
        (self.points * 4 + self.analog_per_frame) * self.storage.value_bytes()
    }

    fn data_bytes(&self) -> usize {
        self.frames.saturating_mul(self.frame_bytes())
    }
}

/// What each declaration may mean, the header's word first.
struct Candidates {
    storages: Vec<Storage>,
    starts: Vec<usize>,
    frames: Vec<usize>,
    points: Vec<usize>,
    analogs: Vec<usize>,
}

/// The layout that accounts for the file.
///
/// The header's word counts unless only another combination of the declarations accounts for every byte.
pub(crate) fn resolve(
    bytes: &[u8],
    header: &Header,
    parameters: &Parameters,
    salvage: bool,
    notes: &mut Vec<ReadNote>,
) -> Result<Layout, C3dError> {
    let candidates = Candidates {
        storages: storages(header, parameters)?,
        starts: starts(header, parameters)?,
        frames: frame_count::candidates(header, parameters)?,
        points: distinct([Some(usize::from(header.points)), parameters.count("POINT", "USED")]),
        analogs: analogs(header, parameters),
    };
    let file = File { len: bytes.len(), stops: section_starts(parameters) };
    let mut layout = candidates.choose(&file, header, salvage)?;
    let available = file.available(&layout);
    if frame_count::is_saturated(header, parameters)
        && available > layout.data_bytes()
        && layout.frame_bytes() > 0
    {
        // Zeros in the last block are its padding, not frames.
        let padding = bytes.iter().rev().take(BLOCK - 1).take_while(|&&byte| byte == 0).count();
        let frames = available.saturating_sub(padding).div_ceil(layout.frame_bytes());
        if frames > layout.frames {
            layout.frames = frames;
            notes.push(ReadNote::FrameCountFromLength { frames });
        }
    }
    note_disagreements(&layout, header, parameters, notes);
    check_length(layout, available, salvage, notes)
}

fn check_length(
    mut layout: Layout,
    available: usize,
    salvage: bool,
    notes: &mut Vec<ReadNote>,
) -> Result<Layout, C3dError> {
    let frame_bytes = layout.frame_bytes();
    if layout.data_bytes() <= available {
        return Ok(layout);
    }
    let available_frames = available / frame_bytes;
    if !salvage {
        return Err(C3dError::Truncated {
            declared_frames: layout.frames,
            available_frames,
            frame_bytes,
            data_start: layout.data_start,
            data_end: layout.data_start + available,
        });
    }
    notes.push(ReadNote::Salvaged { declared_frames: layout.frames, available_frames });
    layout.frames = available_frames;
    Ok(layout)
}

struct File {
    len: usize,
    /// Starts of other sections, at which point data must end.
    stops: Vec<usize>,
}

impl File {
    fn available(&self, layout: &Layout) -> usize {
        let stop = self.stops.iter().copied().filter(|&stop| stop > layout.data_start).min();
        stop.unwrap_or(self.len).min(self.len).saturating_sub(layout.data_start)
    }

    /// Whether nothing is left over but the padding of a last block.
    fn is_accounted_for_by(&self, layout: &Layout) -> bool {
        let (available, needed) = (self.available(layout), layout.data_bytes());
        let padded =
            self.len.is_multiple_of(BLOCK) && available >= needed && available - needed < BLOCK;
        available == needed || padded
    }
}

impl Candidates {
    fn choose(&self, file: &File, header: &Header, salvage: bool) -> Result<Layout, C3dError> {
        let all = self.all();
        let (_, primary) = all[0];
        if all.len() == 1 {
            return Ok(primary);
        }
        let accounted = all.iter().filter(|(_, layout)| file.is_accounted_for_by(layout));
        if let Some((_, layout)) = accounted.min_by_key(|(deviations, _)| *deviations) {
            return Ok(*layout);
        }
        let available = file.available(&primary);
        if salvage || primary.data_bytes() > available {
            return Ok(primary);
        }
        Err(C3dError::LayoutConflict {
            data_start: usize::from(header.data_block).saturating_sub(1) * BLOCK,
            header_bytes: primary.data_bytes(),
            available_bytes: available,
        })
    }

    /// Every combination with the number of declarations in which it leaves the header; the header's own comes first.
    fn all(&self) -> Vec<(usize, Layout)> {
        let mut all = Vec::new();
        for (a, &storage) in self.storages.iter().enumerate() {
            for (b, &data_start) in self.starts.iter().enumerate() {
                for (c, &frames) in self.frames.iter().enumerate() {
                    for (d, &points) in self.points.iter().enumerate() {
                        for (e, &analog_per_frame) in self.analogs.iter().enumerate() {
                            let layout =
                                Layout { storage, data_start, frames, points, analog_per_frame };
                            all.push((a + b + c + d + e, layout));
                        }
                    }
                }
            }
        }
        all
    }
}

pub(crate) fn distinct<T: PartialEq>(values: impl IntoIterator<Item = Option<T>>) -> Vec<T> {
    let mut kept = Vec::new();
    for value in values.into_iter().flatten() {
        if !kept.contains(&value) {
            kept.push(value);
        }
    }
    kept
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the parameter is stored as f32, and a wider one is refused as infinite"
)]
fn parameter_scale(parameters: &Parameters) -> Option<f32> {
    parameters.number("POINT", "SCALE").map(|scale| scale as f32)
}

/// Storages by the sign of each usable scale. Two scales of one sign are one storage: the header's.
fn storages(header: &Header, parameters: &Parameters) -> Result<Vec<Storage>, C3dError> {
    let parameter = parameter_scale(parameters);
    let usable = |scale: &f32| scale.is_finite() && *scale != 0.0;
    let first = Some(header.scale).filter(usable).or(parameter.filter(usable));
    let Some(first) = first.map(Storage::from_scale) else {
        return Err(C3dError::ScaleInvalid { header: header.scale, parameter });
    };
    let other = parameter.filter(usable).map(Storage::from_scale);
    let other = other.filter(|other| other.value_bytes() != first.value_bytes());
    Ok(std::iter::once(first).chain(other).collect())
}

fn starts(header: &Header, parameters: &Parameters) -> Result<Vec<usize>, C3dError> {
    let section = parameters.section_start..parameters.section_start + parameters.section.len();
    let parameter_block =
        parameters.count("POINT", "DATA_START").and_then(|block| u16::try_from(block).ok());
    let usable = |block: u16| {
        let byte = usize::from(block).checked_sub(1)? * BLOCK;
        (byte >= BLOCK && !section.contains(&byte)).then_some(byte)
    };
    let starts = distinct([usable(header.data_block), parameter_block.and_then(usable)]);
    if starts.is_empty() {
        return Err(C3dError::DataStartInvalid {
            header_block: header.data_block,
            parameter_block,
            section_start: section.start,
            section_end: section.end,
        });
    }
    Ok(starts)
}

/// Analog values per frame: header word 3, or channels times samples by header word 10 or by the two rates.
fn analogs(header: &Header, parameters: &Parameters) -> Vec<usize> {
    let used = parameters.count("ANALOG", "USED");
    let by_header =
        Some(usize::from(header.analog_samples_per_frame)).filter(|&samples| samples > 0);
    let rates = parameters.number("ANALOG", "RATE").zip(parameters.number("POINT", "RATE"));
    let by_rates = rates
        .map(|(analog, point)| analog / point)
        .filter(|ratio| (1.0..65536.0).contains(ratio))
        .map(rounded);
    distinct([
        Some(usize::from(header.analog_per_frame)),
        used.zip(by_header).map(|(used, samples)| used * samples),
        used.zip(by_rates).map(|(used, samples)| used * samples),
    ])
}

fn section_starts(parameters: &Parameters) -> Vec<usize> {
    let rotations = super::rotation_start(parameters);
    std::iter::once(parameters.section_start).chain(rotations).collect()
}

fn note_disagreements(
    layout: &Layout,
    header: &Header,
    parameters: &Parameters,
    notes: &mut Vec<ReadNote>,
) {
    let mut note = |declaration, header: f64, parameter: Option<f64>, used: f64| {
        if let Some(parameter) =
            parameter.filter(|parameter| (parameter - header).abs() > f64::EPSILON * header.abs())
        {
            notes.push(ReadNote::Disagreement { declaration, header, parameter, used });
        }
    };
    let count = |name| parameters.count("POINT", name).map(|count| count as f64);
    let frames = header.frame_count().map_or(-1.0, |count| count as f64);
    let block = (layout.data_start / BLOCK + 1) as f64;
    let analog = layout.analog_per_frame as f64;
    let rate = parameters.number("POINT", "RATE").filter(|rate| *rate > 0.0);
    note(Declaration::PointCount, f64::from(header.points), count("USED"), layout.points as f64);
    note(Declaration::FrameCount, frames, count("FRAMES"), layout.frames as f64);
    note(Declaration::DataStart, f64::from(header.data_block), count("DATA_START"), block);
    note(Declaration::AnalogPerFrame, f64::from(header.analog_per_frame), Some(analog), analog);
    let sign = if matches!(layout.storage, Storage::Real { .. }) { -1.0 } else { 1.0 };
    let scale = sign * f64::from(layout.storage.scale());
    note(
        Declaration::Scale,
        f64::from(header.scale),
        parameter_scale(parameters).map(f64::from),
        scale,
    );
    note(Declaration::PointRate, f64::from(header.rate_hz), rate, rate.unwrap_or_default());
}
