//! Writes a new C3D file.

use super::error::C3dError;
use super::header::BLOCK;
use super::layout::Storage;
use super::number::Processor;
use super::parameter_writer::{NewGroup, NewParameter, NewValues, limit, section};
use super::patch::SampleWriter;

/// How a new file stores its samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NewStorage {
    /// 32-bit floats.
    Real,
    /// 16-bit integers of `scale` file units each.
    Integer {
        /// File units per step, greater than zero. Coordinates must lie within 32,767 steps.
        scale: f32,
    },
}

/// Analog samples of a new file.
#[derive(Debug, Clone, PartialEq)]
pub struct NewAnalog {
    /// One label per channel, C of them.
    pub labels: Vec<String>,
    /// One unit per channel.
    pub units: Vec<String>,
    /// Samples of a channel per frame of points.
    pub samples_per_frame: u16,
    /// Units per integer step, used by integer storage.
    pub scale: f32,
    /// Values `(S, C)`, sample after sample.
    pub values: Vec<f32>,
}

/// A recording to write as a C3D file: T frames of M points.
///
/// # Units
///
/// Coordinates in `units`, as they shall stand in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct NewC3d {
    /// One label per point, M of them, each at most 127 bytes.
    pub labels: Vec<String>,
    /// One description per point, or none at all.
    pub descriptions: Vec<String>,
    /// Frames per second.
    pub point_rate_hz: f64,
    /// Unit of the coordinates. Default: `mm`.
    pub units: String,
    /// Number of the first frame. Default: 1.
    pub first_frame: u32,
    /// Number formats. Default: Intel.
    pub processor: Processor,
    /// Storage. Default: real.
    pub storage: NewStorage,
    /// Coordinates `(T, M, 3)`, frame after frame; ignored where missing.
    pub xyz: Vec<[f64; 3]>,
    /// Which samples are missing, `(T, M)`; empty for none.
    pub missing: Vec<bool>,
    /// Residual words `(T, M)` of the samples that are not missing; empty for 0 everywhere.
    pub words: Vec<i16>,
    /// Analog channels.
    pub analog: Option<NewAnalog>,
    /// Further groups. Parameters of a group that is always written (`POINT`, `ANALOG`, `TRIAL`) are added to it and
    /// replace those of the same name.
    pub groups: Vec<NewGroup>,
}

impl NewC3d {
    /// A recording without frames.
    #[must_use]
    pub fn new(labels: Vec<String>, point_rate_hz: f64) -> Self {
        Self {
            labels,
            descriptions: Vec::new(),
            point_rate_hz,
            units: "mm".to_owned(),
            first_frame: 1,
            processor: Processor::Intel,
            storage: NewStorage::Real,
            xyz: Vec::new(),
            missing: Vec::new(),
            words: Vec::new(),
            analog: None,
            groups: Vec::new(),
        }
    }

    /// The file.
    ///
    /// More than 255 labels go to `LABELS2`, …; more than 65,535 frames to `TRIAL:ACTUAL_*_FIELD` and
    /// `POINT:LONG_FRAMES`. Implements [C3D] "Header section", "Parameter section" and "3D data section".
    ///
    /// # Errors
    ///
    /// When arrays do not fit each other, a count or text is beyond the format, or a coordinate beyond the storage.
    pub fn encode(&self) -> Result<Vec<u8>, C3dError> {
        let frames = self.frames();
        self.check(frames)?;
        let blocks = section(&self.all_groups(frames, 0), self.processor)?.len() / BLOCK;
        let data_block = u16::try_from(blocks + 2).unwrap_or(u16::MAX);
        let mut bytes = self.header(frames, data_block);
        bytes.extend(section(&self.all_groups(frames, data_block), self.processor)?);
        self.data(frames, &mut bytes)?;
        bytes.resize(bytes.len().next_multiple_of(BLOCK), 0);
        Ok(bytes)
    }

    fn frames(&self) -> usize {
        match self.xyz.len().checked_div(self.labels.len()) {
            Some(frames) => frames,
            None => self.analog.as_ref().map_or(0, |analog| {
                let per_frame = analog.labels.len() * usize::from(analog.samples_per_frame);
                analog.values.len().checked_div(per_frame).unwrap_or(0)
            }),
        }
    }

    fn check(&self, frames: usize) -> Result<(), C3dError> {
        let points = self.labels.len();
        limit("number of points", points, usize::from(u16::MAX))?;
        limit(
            "number of the last frame",
            frames.saturating_add(self.first_frame as usize),
            u32::MAX as usize,
        )?;
        let cells = frames * points;
        let shape = |what, found, expected| {
            if found == expected {
                Ok(())
            } else {
                Err(C3dError::ShapeMismatch { what, found, expected })
            }
        };
        shape("xyz", self.xyz.len(), cells)?;
        shape("missing", if self.missing.is_empty() { cells } else { self.missing.len() }, cells)?;
        shape("words", if self.words.is_empty() { cells } else { self.words.len() }, cells)?;
        shape(
            "descriptions",
            if self.descriptions.is_empty() { points } else { self.descriptions.len() },
            points,
        )?;
        if let Some(analog) = &self.analog {
            limit("analog values per frame", self.analog_per_frame(), usize::from(u16::MAX))?;
            shape("analog values", analog.values.len(), frames * self.analog_per_frame())?;
            shape("analog units", analog.units.len(), analog.labels.len())?;
        }
        let positive = |what, value: f64| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(C3dError::NotPositive { what, value })
            }
        };
        positive("the point rate", self.point_rate_hz)?;
        if let NewStorage::Integer { scale } = self.storage {
            positive("the scale", f64::from(scale))?;
            positive(
                "the analog scale",
                self.analog.as_ref().map_or(1.0, |analog| f64::from(analog.scale)),
            )?;
        }
        Ok(())
    }

    fn analog_per_frame(&self) -> usize {
        let per_frame =
            |analog: &NewAnalog| analog.labels.len() * usize::from(analog.samples_per_frame);
        self.analog.as_ref().map_or(0, per_frame)
    }

    fn scale(&self) -> f32 {
        match self.storage {
            NewStorage::Real => -1.0,
            NewStorage::Integer { scale } => scale,
        }
    }

    fn last_frame(&self, frames: usize) -> u32 {
        let last = (self.first_frame as usize + frames).saturating_sub(1);
        u32::try_from(last).unwrap_or(u32::MAX)
    }

    fn header(&self, frames: usize, data_block: u16) -> Vec<u8> {
        let processor = self.processor;
        let mut bytes = vec![0; BLOCK];
        bytes[0] = 2;
        bytes[1] = 0x50;
        let mut word = |number: usize, value: u16| {
            let at = (number - 1) * 2;
            bytes[at..at + 2].copy_from_slice(&processor.u16_bytes(value));
        };
        word(2, saturated(self.labels.len()));
        word(3, saturated(self.analog_per_frame()));
        word(4, saturated(self.first_frame as usize));
        word(5, saturated(self.last_frame(frames) as usize));
        word(9, data_block);
        word(10, self.analog.as_ref().map_or(0, |analog| analog.samples_per_frame));
        // The key that says four-character event labels are supported.
        word(150, 0x3039);
        bytes[12..16].copy_from_slice(&processor.f32_bytes(self.scale()));
        bytes[20..24].copy_from_slice(&processor.f32_bytes(narrow(self.point_rate_hz)));
        bytes
    }

    fn all_groups(&self, frames: usize, data_block: u16) -> Vec<NewGroup> {
        let mut groups = vec![
            self.point_group(frames, data_block),
            self.analog_group(),
            self.trial_group(frames),
        ];
        for group in &self.groups {
            match groups.iter_mut().find(|known| known.name.eq_ignore_ascii_case(&group.name)) {
                Some(known) => {
                    let replaced = |old: &NewParameter| {
                        group.parameters.iter().any(|new| new.name == old.name)
                    };
                    known.parameters.retain(|old| !replaced(old));
                    known.parameters.extend(group.parameters.iter().cloned());
                }
                None => groups.push(group.clone()),
            }
        }
        groups
    }

    fn point_group(&self, frames: usize, data_block: u16) -> NewGroup {
        let mut parameters = vec![
            NewParameter::word("USED", saturated(self.labels.len())),
            NewParameter::real("SCALE", self.scale()),
            NewParameter::real("RATE", narrow(self.point_rate_hz)),
            NewParameter::word("DATA_START", data_block),
            NewParameter::word("FRAMES", saturated(frames)),
            NewParameter::text("UNITS", &self.units),
        ];
        if frames > usize::from(u16::MAX) {
            parameters.push(NewParameter::real("LONG_FRAMES", narrow(frames as f64)));
        }
        parameters.extend(NewParameter::long("LABELS", &self.labels, NewValues::Texts));
        let blank = vec![String::new(); self.labels.len()];
        let descriptions = if self.descriptions.is_empty() { &blank } else { &self.descriptions };
        parameters.extend(NewParameter::long("DESCRIPTIONS", descriptions, NewValues::Texts));
        NewGroup { name: "POINT".to_owned(), description: String::new(), parameters }
    }

    fn analog_group(&self) -> NewGroup {
        let mut group = NewGroup::new("ANALOG");
        let Some(analog) = &self.analog else {
            group.parameters =
                vec![NewParameter::word("USED", 0), NewParameter::real("GEN_SCALE", 1.0)];
            return group;
        };
        let channels = analog.labels.len();
        let scale = if self.storage == NewStorage::Real { 1.0 } else { analog.scale };
        group.parameters = vec![
            NewParameter::word("USED", saturated(channels)),
            NewParameter::real(
                "RATE",
                narrow(self.point_rate_hz * f64::from(analog.samples_per_frame)),
            ),
            NewParameter::real("GEN_SCALE", 1.0),
            NewParameter::text("FORMAT", "SIGNED"),
        ];
        group.parameters.extend(NewParameter::long("LABELS", &analog.labels, NewValues::Texts));
        group.parameters.extend(NewParameter::long("UNITS", &analog.units, NewValues::Texts));
        group.parameters.extend(NewParameter::long(
            "SCALE",
            &vec![scale; channels],
            NewValues::Reals,
        ));
        group.parameters.extend(NewParameter::long(
            "OFFSET",
            &vec![0; channels],
            NewValues::Integers,
        ));
        group
    }

    fn trial_group(&self, frames: usize) -> NewGroup {
        let mut group = NewGroup::new("TRIAL");
        let words = |number: u32| {
            let [a, b, c, d] = number.to_le_bytes();
            NewValues::Integers(vec![i16::from_le_bytes([a, b]), i16::from_le_bytes([c, d])])
        };
        group.parameters = vec![
            NewParameter::new("ACTUAL_START_FIELD", words(self.first_frame)),
            NewParameter::new("ACTUAL_END_FIELD", words(self.last_frame(frames))),
        ];
        group
    }

    fn data(&self, frames: usize, bytes: &mut Vec<u8>) -> Result<(), C3dError> {
        let storage = match self.storage {
            NewStorage::Real => Storage::Real { scale: 1.0 },
            NewStorage::Integer { scale } => Storage::Integer { scale },
        };
        let writer = SampleWriter { processor: self.processor, storage };
        let points = self.labels.len();
        let mut cell = [0_u8; 16];
        let cell = &mut cell[..4 * storage.value_bytes()];
        for frame in 0..frames {
            for point in 0..points {
                let index = frame * points + point;
                let missing = self.missing.get(index) == Some(&true);
                let word = if missing { -1 } else { self.words.get(index).copied().unwrap_or(0) };
                let position = if missing { None } else { self.xyz.get(index).copied() };
                writer.write(cell, position, word, frame, point)?;
                bytes.extend_from_slice(cell);
            }
            self.analog_frame(frame, bytes)?;
        }
        Ok(())
    }

    fn analog_frame(&self, frame: usize, bytes: &mut Vec<u8>) -> Result<(), C3dError> {
        let Some(analog) = &self.analog else { return Ok(()) };
        let per_frame = self.analog_per_frame();
        for (index, &value) in
            analog.values.iter().enumerate().skip(frame * per_frame).take(per_frame)
        {
            let channel = index % analog.labels.len();
            if self.storage == NewStorage::Real {
                if f64::from(value.abs()) > self.processor.largest_real() || !value.is_finite() {
                    return Err(C3dError::AnalogOutOfRange { frame, channel, value });
                }
                bytes.extend(self.processor.f32_bytes(value));
            } else {
                let steps = (value / analog.scale).round();
                if !steps.is_finite() || steps.abs() > f32::from(i16::MAX) {
                    return Err(C3dError::AnalogOutOfRange { frame, channel, value });
                }
                bytes.extend(self.processor.i16_bytes(step(steps)));
            }
        }
        Ok(())
    }
}

fn saturated(count: usize) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
}

#[expect(clippy::cast_possible_truncation, reason = "the format holds rates and counts as f32")]
fn narrow(value: f64) -> f32 {
    value as f32
}

#[expect(clippy::cast_possible_truncation, reason = "the range is checked before")]
fn step(steps: f32) -> i16 {
    steps as i16
}
