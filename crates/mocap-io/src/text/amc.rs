//! AMC, the motion of the Acclaim format, for the skeleton of an ASF file.
//!
//! The first frame says which bones the file moves; bones of the skeleton that it leaves out rest, and are
//! noted. Every later frame has to move the same bones, or the file is damaged. The file states no
//! sampling rate: [`ReadOptions::rate_hz`](crate::ReadOptions::rate_hz) does, 120 Hz otherwise. The axes are the skeleton's own,
//! y up in CMU's files: their markers (millimetres, z up) are at `1000 · (z, x, y)` of these metres.
//!
//! AMC joints are a program's fit to markers, not a measurement.

use mocap_core::{Motion, Pose, Rotation};

use super::{
    TextError,
    asf::{Asf, Dof, content},
    bvh::check_balance,
    grid::note_line_end,
    lines::{Line, Lines, shorten},
    number, rate,
};
use crate::{FileInfo, Format, ReadOptions};

mod encode;

pub use encode::encode;

/// An AMC file.
#[derive(Debug, Clone)]
pub struct Amc {
    bytes: Vec<u8>,
    motion: Motion,
    info: FileInfo,
}

impl Amc {
    /// Reads an AMC file with the skeleton that it was made for.
    ///
    /// # Errors
    /// [`TextError`], with the line; [`TextError::MissingBone`] for a last frame that is cut off, unless
    /// [`ReadOptions::salvage`], which keeps the frames before the first damaged one.
    ///
    /// ```
    /// use mocap_io::{ReadOptions, text::{amc::Amc, asf::Asf}};
    /// let asf = ":units\n length 1.0\n angle deg\n:root\n order TX TY TZ RX RY RZ\n axis XYZ\n\
    ///     :bonedata\n begin\n name arm\n direction 1 0 0\n length 10\n axis 0 0 0 XYZ\n dof rz\n end\n\
    ///     :hierarchy\n begin\n root arm\n end\n";
    /// let asf = Asf::parse(asf.into(), &ReadOptions::default())?;
    /// let amc = Amc::parse("1\nroot 0 0 0 0 0 0\narm 90\n".into(), &asf, &ReadOptions::default())?;
    /// let at = asf.skeleton().positions(&amc.motion().poses()[0])?;
    /// assert!((at[2][1] - 0.254).abs() < 1e-12, "ten inches up");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn parse(bytes: Vec<u8>, asf: &Asf, options: &ReadOptions) -> Result<Self, TextError> {
        let mut info = FileInfo::new(Format::Amc, "text");
        info.unit = asf.info().unit;
        let mut reader = Reader::new(asf, bytes.len());
        if let Err(error) = reader.read(&bytes) {
            if !options.salvage || reader.poses.is_empty() {
                return Err(error);
            }
            info.notes
                .push(format!("salvaged: {} whole frames are kept: {error}", reader.poses.len()));
        }
        info.first_frame = reader.first_frame;
        reader.note_resting(&mut info.notes);
        let rate_hz = rate::undeclared(options, &mut info.notes);
        note_line_end(&bytes, &mut info.notes);
        let motion = Motion::new(asf.skeleton().clone(), rate_hz, reader.poses)?;
        Ok(Self { bytes, motion, info })
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

    /// The motion in metres.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }
}

struct Reader<'a> {
    asf: &'a Asf,
    bytes: usize,
    poses: Vec<Pose>,
    first_frame: i64,
    radians_per_angle: f64,
    /// Bones that the first frame moves.
    moved: Vec<bool>,
    /// The frame that is being read.
    open: Option<Open>,
    /// Frame, counted from 1, that moved each bone last.
    seen: Vec<usize>,
    last_line: usize,
}

struct Open {
    number: i64,
    pose: Pose,
}

impl<'a> Reader<'a> {
    fn new(asf: &'a Asf, bytes: usize) -> Self {
        let bones = asf.bones().count();
        Self {
            asf,
            bytes,
            poses: Vec::new(),
            first_frame: 1,
            radians_per_angle: asf.radians_per_angle(),
            moved: vec![false; bones],
            open: None,
            seen: vec![0; bones],
            last_line: 0,
        }
    }

    fn read(&mut self, bytes: &[u8]) -> Result<(), TextError> {
        for line in content(Lines::new(bytes)?) {
            let mut words =
                line.text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            let Some(first) = words.next() else { continue };
            if first.starts_with(b":") {
                self.keyword(first);
            } else if first[0].is_ascii_digit() || first[0] == b'-' {
                self.close()?;
                self.begin(first, line)?;
            } else {
                self.bone(first, words, line)?;
            }
            self.last_line = line.number;
        }
        self.close()?;
        if self.poses.is_empty() {
            return Err(TextError::NoFrames { line: self.last_line });
        }
        if self.poses.len() == 1 {
            self.check_only_frame()?;
        }
        Ok(())
    }

    fn keyword(&mut self, word: &[u8]) {
        if word.eq_ignore_ascii_case(b":degrees") {
            self.radians_per_angle = 1_f64.to_radians();
        } else if word.eq_ignore_ascii_case(b":radians") {
            self.radians_per_angle = 1.0;
        }
    }

    fn begin(&mut self, word: &[u8], line: Line<'_>) -> Result<(), TextError> {
        let found = number::whole(word, line.number, 1)?;
        if self.poses.is_empty() {
            self.first_frame = found;
        }
        let expected = self.first_frame.saturating_add_unsigned(self.poses.len() as u64);
        if found != expected {
            return Err(TextError::FrameNumber { line: line.number, expected, found });
        }
        let joints = self.asf.skeleton().joints().len();
        check_balance(self.poses.len(), joints, self.bytes)?;
        let rotations = vec![Rotation::IDENTITY; joints];
        self.open = Some(Open { number: found, pose: Pose { root_m: [0.0; 3], rotations } });
        Ok(())
    }

    fn bone<'w>(
        &mut self,
        name: &[u8],
        words: impl Iterator<Item = &'w [u8]>,
        line: Line<'_>,
    ) -> Result<(), TextError> {
        let error = |rule| TextError::Bone { line: line.number, bone: shorten(name), rule };
        let Some(open) = &mut self.open else {
            return Err(line.error("the number of a frame has to come before its bones"));
        };
        let found = std::str::from_utf8(name).ok().and_then(|name| self.asf.find(name));
        let bone = found.ok_or_else(|| error("is not in the skeleton; is this its ASF file?"))?;
        let frame = self.poses.len() + 1;
        if std::mem::replace(&mut self.seen[bone], frame) == frame {
            return Err(error("comes twice in one frame"));
        }
        let mut turns = Vec::with_capacity(3);
        let (dofs, mut count) = (&self.asf.bone(bone).dofs, 0);
        for (at, word) in words.enumerate() {
            count = at + 1;
            let value = number::finite(word, line.number, at + 2)?;
            match dofs.get(at) {
                Some(&Dof::Rotation(axis)) => turns.push((axis, value * self.radians_per_angle)),
                Some(&Dof::Translation(axis)) if bone == 0 => {
                    open.pose.root_m[axis] = value * self.asf.metres_per_unit();
                }
                _ => {}
            }
        }
        if count != dofs.len() {
            let (expected, found) = (dofs.len() + 1, count + 1);
            return Err(TextError::Width { line: line.number, expected, found });
        }
        open.pose.rotations[self.asf.joint(bone)] = self.asf.rotation(bone, &turns);
        Ok(())
    }

    /// Ends the open frame.
    fn close(&mut self) -> Result<(), TextError> {
        let Some(Open { number: frame, pose }) = self.open.take() else { return Ok(()) };
        let index = self.poses.len() + 1;
        if index == 1 {
            self.moved = self.seen.iter().map(|&seen| seen == 1).collect();
            // Every recording moves the root, so a frame without it is none.
            self.moved[0] = true;
        }
        let missing = (0..self.seen.len()).find(|&b| (self.seen[b] == index) != self.moved[b]);
        match missing {
            None => {
                self.poses.push(pose);
                Ok(())
            }
            Some(bone) if self.moved[bone] => Err(self.missing(bone, frame)),
            Some(bone) => Err(TextError::Bone {
                line: self.last_line,
                bone: self.asf.bone(bone).name.clone(),
                rule: "moves in this frame and not in the first",
            }),
        }
    }

    fn missing(&self, bone: usize, frame: i64) -> TextError {
        TextError::MissingBone {
            line: self.last_line,
            frame,
            bone: self.asf.bone(bone).name.clone(),
        }
    }

    fn resting(&self) -> impl Iterator<Item = usize> {
        (0..self.moved.len()).filter(|&b| !self.moved[b] && !self.asf.bone(b).dofs.is_empty())
    }

    /// A single frame has no other to be compared with, so it has to move every bone that can move.
    fn check_only_frame(&mut self) -> Result<(), TextError> {
        let Some(bone) = self.resting().next() else { return Ok(()) };
        let error = self.missing(bone, self.first_frame);
        self.poses.clear();
        Err(error)
    }

    fn note_resting(&self, notes: &mut Vec<String>) {
        let names: Vec<&str> = self.resting().map(|b| self.asf.bone(b).name.as_str()).collect();
        if !names.is_empty() {
            notes.push(format!("bones that the file does not move: {}", names.join(", ")));
        }
    }
}
