use mocap_core::{Joint, Skeleton};

use super::Channel;
use crate::text::{
    TextError,
    lines::{Line, Lines, shorten},
    names, number,
};

/// The skeleton of a BVH file in the file's unit, parents first.
#[derive(Debug, Clone)]
pub(super) struct Hierarchy {
    joints: Vec<FileJoint>,
    channels: Vec<Vec<Channel>>,
    channel_count: usize,
}

#[derive(Debug, Clone)]
pub(super) struct FileJoint {
    name: String,
    parent: Option<usize>,
    offset: [f64; 3],
}

impl Hierarchy {
    pub fn joints(&self) -> &[FileJoint] {
        &self.joints
    }

    pub fn channels(&self) -> &[Vec<Channel>] {
        &self.channels
    }

    /// Values of one frame; above 0.
    pub fn channel_count(&self) -> usize {
        self.channel_count
    }

    pub fn skeleton(&self, metres_per_unit: f64) -> Result<Skeleton, TextError> {
        let joint = |j: &FileJoint| Joint {
            name: j.name.clone(),
            parent: j.parent,
            offset_m: j.offset.map(|c| c * metres_per_unit),
        };
        Ok(Skeleton::new(self.joints.iter().map(joint).collect())?)
    }

    /// Reads from `HIERARCHY` to `MOTION`.
    pub fn read(lines: &mut Lines<'_>, notes: &mut Vec<String>) -> Result<Self, TextError> {
        let mut reader = Reader::default();
        let first = next_line(lines, "`HIERARCHY`")?;
        if !first.text.trim_ascii().eq_ignore_ascii_case(b"HIERARCHY") {
            return Err(first.error("a BVH file starts with `HIERARCHY`"));
        }
        loop {
            let line = next_line(lines, "`MOTION`")?;
            if line.text.trim_ascii().eq_ignore_ascii_case(b"MOTION") {
                return reader.finish(line, notes);
            }
            reader.take(line)?;
        }
    }
}

fn next_line<'a>(lines: &mut Lines<'a>, what: &'static str) -> Result<Line<'a>, TextError> {
    loop {
        let line = lines.need(what)?;
        if !line.text.trim_ascii().is_empty() {
            return Ok(line);
        }
    }
}

#[derive(Default)]
struct Reader {
    joints: Vec<FileJoint>,
    channels: Vec<Vec<Channel>>,
    has_offset: Vec<bool>,
    is_end: Vec<bool>,
    /// Joints whose braces are open.
    open: Vec<usize>,
    /// A joint is named, and its brace has not come.
    is_named: bool,
}

impl Reader {
    fn take(&mut self, line: Line<'_>) -> Result<(), TextError> {
        let text = String::from_utf8_lossy(line.text);
        // Braces stand on their own line or beside a name.
        let spaced = text.replace('{', " { ").replace('}', " } ");
        let words: Vec<&str> = spaced.split_whitespace().collect();
        let mut rest = words.as_slice();
        while let Some((&word, after)) = rest.split_first() {
            let own = after.iter().position(|w| matches!(*w, "{" | "}")).unwrap_or(after.len());
            let (own, next) = after.split_at(own);
            self.word(word, own, line)?;
            // A brace has no words of its own.
            rest = if matches!(word, "{" | "}") { after } else { next };
        }
        Ok(())
    }

    fn word(&mut self, word: &str, own: &[&str], line: Line<'_>) -> Result<(), TextError> {
        match word.to_ascii_uppercase().as_str() {
            "ROOT" if self.joints.is_empty() => self.push(None, name(own, line)?),
            "ROOT" => return Err(line.error("a BVH file has one `ROOT`; split the file")),
            "JOINT" => {
                let parent = self.moving(line)?;
                self.push(Some(parent), name(own, line)?);
            }
            "END" => {
                let parent = self.moving(line)?;
                self.push(Some(parent), format!("{}_end", self.joints[parent].name));
                self.is_end[self.joints.len() - 1] = true;
            }
            "{" if self.is_named => {
                self.is_named = false;
                self.open.push(self.joints.len() - 1);
            }
            "}" => {
                let joint = self.top(line)?;
                if !self.has_offset[joint] {
                    return Err(line.error("every joint needs an `OFFSET`"));
                }
                self.open.pop();
            }
            "OFFSET" => {
                let joint = self.top(line)?;
                self.joints[joint].offset = offset(own, line)?;
                self.has_offset[joint] = true;
            }
            "CHANNELS" => {
                let joint = self.moving(line)?;
                self.channels[joint] = channels(own, line)?;
            }
            _ => {
                return Err(line.error(
                    "a skeleton is made of ROOT, JOINT, End Site, OFFSET, CHANNELS and braces",
                ));
            }
        }
        Ok(())
    }

    fn push(&mut self, parent: Option<usize>, name: String) {
        self.joints.push(FileJoint { name, parent, offset: [0.0; 3] });
        self.channels.push(Vec::new());
        self.has_offset.push(false);
        self.is_end.push(false);
        self.is_named = true;
    }

    /// The joint whose braces are open.
    fn top(&self, line: Line<'_>) -> Result<usize, TextError> {
        let outside = || line.error("this belongs between the braces of a joint");
        if self.is_named {
            return Err(line.error("`{` has to follow the name of a joint"));
        }
        self.open.last().copied().ok_or_else(outside)
    }

    /// The joint whose braces are open, which may have channels and children.
    fn moving(&self, line: Line<'_>) -> Result<usize, TextError> {
        let joint = self.top(line)?;
        if self.is_end[joint] {
            return Err(line.error("an `End Site` has an `OFFSET` and nothing else"));
        }
        Ok(joint)
    }

    fn finish(self, line: Line<'_>, notes: &mut Vec<String>) -> Result<Hierarchy, TextError> {
        if self.joints.is_empty() || self.is_named || !self.open.is_empty() {
            return Err(line.error("`MOTION` comes before the skeleton's last brace"));
        }
        let channel_count = self.channels.iter().map(Vec::len).sum();
        if channel_count == 0 {
            return Err(line.error("no joint has a channel"));
        }
        let moved = |c: &&Vec<Channel>| c.iter().any(|c| matches!(c, Channel::Position(_)));
        let moving = self.channels.iter().skip(1).filter(moved).count();
        if moving > 0 {
            notes.push(format!("position channels of {moving} joints below the root are not read"));
        }
        let mut joints = self.joints;
        let labels = joints.iter_mut().map(|j| std::mem::take(&mut j.name)).collect();
        for (joint, name) in joints.iter_mut().zip(names::unique(labels, "joint", notes)) {
            joint.name = name;
        }
        Ok(Hierarchy { joints, channels: self.channels, channel_count })
    }
}

fn name(words: &[&str], line: Line<'_>) -> Result<String, TextError> {
    // Names of ends repeat the names of their joints, so that long names could outgrow the file.
    const LONGEST: usize = 256;
    let name = words.join(" ");
    if name.len() > LONGEST {
        return Err(line.error("the name of a joint has at most 256 bytes"));
    }
    Ok(name)
}

fn offset(words: &[&str], line: Line<'_>) -> Result<[f64; 3], TextError> {
    if words.len() != 3 {
        return Err(line.error("`OFFSET` takes three numbers"));
    }
    let mut offset = [0.0; 3];
    for (at, (value, word)) in offset.iter_mut().zip(words).enumerate() {
        *value = number::finite(word.as_bytes(), line.number, at + 2)?;
    }
    Ok(offset)
}

fn channels(words: &[&str], line: Line<'_>) -> Result<Vec<Channel>, TextError> {
    let (count, names) =
        words.split_first().ok_or_else(|| line.error("`CHANNELS` takes a number"))?;
    let declared = number::count(count.as_bytes(), line.number, 2)?;
    if declared != names.len() {
        let (line, found) = (line.number, names.len());
        return Err(TextError::Count { line, what: "channels", declared, found });
    }
    names.iter().enumerate().map(|(at, name)| channel(name, line, at + 3)).collect()
}

fn channel(name: &str, line: Line<'_>, field: usize) -> Result<Channel, TextError> {
    Ok(match name.to_ascii_lowercase().as_str() {
        "xposition" => Channel::Position(0),
        "yposition" => Channel::Position(1),
        "zposition" => Channel::Position(2),
        "xrotation" => Channel::Rotation(0),
        "yrotation" => Channel::Rotation(1),
        "zrotation" => Channel::Rotation(2),
        _ => {
            return Err(TextError::Field {
                line: line.number,
                field,
                text: shorten(name.as_bytes()),
                rule: "is no channel; channels are Xposition … Zposition, Xrotation … Zrotation",
            });
        }
    })
}
