//! BVH, a skeleton and its motion.
//!
//! The file names no unit of length: [`ReadOptions::unit`](crate::ReadOptions::unit) does, centimetres otherwise. BVH files
//! of CMU's database keep the lengths of their ASF files, in units of 1/0.45 inch (56.4 mm): scale
//! them by [`Bvh::motion_in`].
//!
//! Rotation channels are applied as the format says: the first channel of a joint is the outermost, so
//! that `Zrotation Yrotation Xrotation` means Rz · Ry · Rx. An `End Site` becomes a joint called
//! `<parent>_end`. Position channels of joints below the root do not fit into a [`Motion`] and are noted.

use mocap_core::{Motion, Pose};

use super::{
    TextError,
    euler::turn,
    grid::note_line_end,
    lines::{Line, Lines},
    number,
};
use crate::{FileInfo, Format, LengthUnit, ReadOptions};

mod encode;
mod hierarchy;

pub use encode::encode;
use hierarchy::Hierarchy;

/// A channel of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// Translation along x, y or z (0, 1, 2).
    Position(usize),
    /// Rotation about x, y or z (0, 1, 2), in degrees.
    Rotation(usize),
}

/// A BVH file.
#[derive(Debug, Clone)]
pub struct Bvh {
    bytes: Vec<u8>,
    hierarchy: Hierarchy,
    rate_hz: f64,
    /// Channel values, one row a frame.
    values: Vec<f64>,
    frames: usize,
    info: FileInfo,
}

impl Bvh {
    /// Reads a BVH file.
    ///
    /// # Errors
    /// [`TextError`], with the line; a file with fewer or more frames than it declares unless
    /// [`ReadOptions::salvage`].
    ///
    /// ```
    /// use mocap_io::{ReadOptions, text::bvh::Bvh};
    /// let file = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\n\
    ///     CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n\
    ///     End Site\n{\nOFFSET 0 10 0\n}\n}\n\
    ///     MOTION\nFrames: 1\nFrame Time: 0.01\n100 0 0 90 0 0\n";
    /// let bvh = Bvh::parse(file.into(), &ReadOptions::default())?;
    /// let motion = bvh.motion()?;
    /// let at = motion.skeleton().positions(&motion.poses()[0])?;
    /// // The end of the bone, turned by 90° about z: from y to −x.
    /// assert!((at[1][0] - 0.9).abs() < 1e-12 && at[1][1].abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn parse(bytes: Vec<u8>, options: &ReadOptions) -> Result<Self, TextError> {
        let mut info = FileInfo::new(Format::Bvh, "text");
        info.rate_declared = true;
        info.unit = options.unit.unwrap_or_else(|| {
            info.notes.push("the file names no unit of length; centimetres are assumed".into());
            LengthUnit::Centimetre
        });
        let mut lines = Lines::new(&bytes)?;
        let hierarchy = Hierarchy::read(&mut lines, &mut info.notes)?;
        let (declared, line) = frame_count(lines.need("`Frames: N`")?)?;
        let rate_hz = rate(lines.need("`Frame Time: SECONDS`")?)?;
        let values = values(lines, hierarchy.channel_count(), options, &mut info.notes)?;
        let frames = values.len() / hierarchy.channel_count();
        if frames != declared {
            let error = TextError::Count { line, what: "frames", declared, found: frames };
            if !options.salvage {
                return Err(error);
            }
            info.notes.push(format!("salvaged: {error}"));
        }
        let joints = hierarchy.joints().len();
        check_balance(frames, joints, bytes.len())?;
        note_line_end(&bytes, &mut info.notes);
        Ok(Self { bytes, hierarchy, rate_hz, values, frames, info })
    }

    /// The file as it was read.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// What the file says of itself.
    #[must_use]
    pub fn info(&self) -> &FileInfo {
        &self.info
    }

    /// Number of frames.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Channels of each joint of the skeleton, in the file's order; empty for the ends of bones.
    #[must_use]
    pub fn channels(&self) -> &[Vec<Channel>] {
        self.hierarchy.channels()
    }

    /// The motion in metres, by the unit of [`info`](Self::info).
    ///
    /// # Errors
    /// [`TextError::Core`] where the core types refuse the skeleton.
    pub fn motion(&self) -> Result<Motion, TextError> {
        self.motion_in(self.info.unit.metres())
    }

    /// The motion in metres, for a file whose unit of length is `metres_per_unit`.
    ///
    /// # Errors
    /// [`TextError::Core`] where the core types refuse the skeleton.
    pub fn motion_in(&self, metres_per_unit: f64) -> Result<Motion, TextError> {
        let skeleton = self.hierarchy.skeleton(metres_per_unit)?;
        let rows = self.values.chunks_exact(self.hierarchy.channel_count());
        let poses = rows.map(|row| self.pose(row, metres_per_unit)).collect();
        Ok(Motion::new(skeleton, self.rate_hz, poses)?)
    }

    fn pose(&self, row: &[f64], metres_per_unit: f64) -> Pose {
        let mut values = row.iter();
        let mut root_m = [0.0; 3];
        let mut rotations = Vec::with_capacity(self.channels().len());
        for (joint, channels) in self.channels().iter().enumerate() {
            let mut rotation = mocap_core::Rotation::IDENTITY;
            for (channel, &value) in channels.iter().zip(values.by_ref()) {
                match *channel {
                    Channel::Position(axis) if joint == 0 => root_m[axis] = value * metres_per_unit,
                    Channel::Position(_) => {}
                    Channel::Rotation(axis) => {
                        rotation = rotation.after(turn(axis, value.to_radians()));
                    }
                }
            }
            rotations.push(rotation);
        }
        Pose { root_m, rotations }
    }
}

/// Refuses motions that would take far more memory than their file.
pub(super) fn check_balance(frames: usize, joints: usize, bytes: usize) -> Result<(), TextError> {
    // Each moving joint takes two bytes a frame at least, and brings one end of a bone at most.
    if frames.saturating_mul(joints) > bytes.saturating_mul(2) {
        return Err(TextError::Unbalanced { frames, joints, bytes });
    }
    Ok(())
}

fn frame_count(line: Line<'_>) -> Result<(usize, usize), TextError> {
    let value = value_of(line, "frames")
        .ok_or_else(|| line.error("`MOTION` is followed by `Frames: N`"))?;
    Ok((number::count(value, line.number, 2)?, line.number))
}

fn rate(line: Line<'_>) -> Result<f64, TextError> {
    let value = value_of(line, "frame time")
        .ok_or_else(|| line.error("`Frames:` is followed by `Frame Time: SECONDS`"))?;
    let seconds = number::finite(value, line.number, 3)?;
    if seconds <= 0.0 || !(1.0 / seconds).is_finite() {
        return Err(line.error("a frame takes more than 0 s"));
    }
    let error = number::half_digit(&String::from_utf8_lossy(value));
    Ok(number::roundest(1.0 / seconds, error / seconds))
}

/// The text after `key:`.
fn value_of<'a>(line: Line<'a>, key: &str) -> Option<&'a [u8]> {
    let colon = line.text.iter().position(|&b| b == b':')?;
    let found = String::from_utf8_lossy(&line.text[..colon]).to_lowercase();
    let same = found.split_whitespace().eq(key.split(' '));
    same.then(|| line.text[colon + 1..].trim_ascii())
}

fn values(
    lines: Lines<'_>,
    width: usize,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<f64>, TextError> {
    let mut values = Vec::new();
    let mut lines = lines.filter(|line| !line.text.trim_ascii().is_empty()).peekable();
    while let Some(line) = lines.next() {
        let whole = values.len();
        if let Err(error) = push_row(line, width, &mut values) {
            if !options.salvage || lines.peek().is_some() {
                return Err(error);
            }
            values.truncate(whole);
            notes.push(format!("salvaged: the last frame is dropped: {error}"));
        }
    }
    Ok(values)
}

fn push_row(line: Line<'_>, width: usize, values: &mut Vec<f64>) -> Result<(), TextError> {
    let fields = line.text.split(u8::is_ascii_whitespace).filter(|field| !field.is_empty());
    let mut found = 0;
    for field in fields {
        found += 1;
        values.push(number::finite(field, line.number, found)?);
    }
    if found != width {
        return Err(TextError::Width { line: line.number, expected: width, found });
    }
    Ok(())
}
