use std::collections::HashMap;

use super::{Dof, FileBone, content, numbers};
use crate::text::{
    TextError,
    lines::{Line, Lines, shorten},
};

/// An ASF file in its own units.
pub(super) struct File {
    /// The root first, then the bones in the file's order.
    pub bones: Vec<FileBone>,
    /// Children of each bone.
    pub children: Vec<Vec<usize>>,
    pub root_position: [f64; 3],
    pub length_scale: f64,
    pub radians_per_angle: f64,
}

#[derive(Clone, Copy, PartialEq)]
enum Section {
    Other,
    Units,
    Root,
    Bones,
    Hierarchy,
}

struct Reader {
    file: File,
    index: HashMap<String, usize>,
    parents: Vec<Option<usize>>,
    section: Section,
    /// The bone between `begin` and `end`.
    bone: Option<FileBone>,
    has_hierarchy: bool,
    root_angles: [f64; 3],
    root_order: Vec<usize>,
}

/// Reads the whole file.
pub(super) fn read(bytes: &[u8], notes: &mut Vec<String>) -> Result<File, TextError> {
    let mut reader = Reader::new();
    let mut last = 0;
    for line in content(Lines::new(bytes)?) {
        last = line.number;
        let text = String::from_utf8_lossy(line.text);
        let words: Vec<&str> = text.split_whitespace().collect();
        reader.take(&words, line)?;
    }
    reader.finish(last, notes)
}

fn root() -> FileBone {
    FileBone {
        name: "root".into(),
        direction: [0.0; 3],
        length: 0.0,
        axis: Vec::new(),
        dofs: Vec::new(),
    }
}

impl Reader {
    fn new() -> Self {
        let file = File {
            bones: vec![root()],
            children: vec![Vec::new()],
            root_position: [0.0; 3],
            length_scale: 1.0,
            radians_per_angle: 1_f64.to_radians(),
        };
        Self {
            file,
            index: HashMap::from([("root".to_owned(), 0)]),
            parents: vec![None],
            section: Section::Other,
            bone: None,
            has_hierarchy: false,
            root_angles: [0.0; 3],
            root_order: vec![0, 1, 2],
        }
    }

    fn take(&mut self, words: &[&str], line: Line<'_>) -> Result<(), TextError> {
        let Some(&first) = words.first() else { return Ok(()) };
        if first.starts_with(':') {
            return self.open_section(&first.to_ascii_lowercase(), line);
        }
        match self.section {
            Section::Other => Ok(()),
            Section::Units => self.unit(words, line),
            Section::Root => self.root(words, line),
            Section::Bones => self.bone(words, line),
            Section::Hierarchy => self.family(words, line),
        }
    }

    fn open_section(&mut self, name: &str, line: Line<'_>) -> Result<(), TextError> {
        if self.bone.is_some() {
            return Err(line.error("the bone before this has no `end`"));
        }
        self.section = match name {
            ":units" => Section::Units,
            ":root" => Section::Root,
            ":bonedata" => Section::Bones,
            ":hierarchy" => {
                self.has_hierarchy = true;
                Section::Hierarchy
            }
            _ => Section::Other,
        };
        Ok(())
    }

    fn unit(&mut self, words: &[&str], line: Line<'_>) -> Result<(), TextError> {
        match words[0].to_ascii_lowercase().as_str() {
            "length" => {
                let [scale] = numbers(words, line)?;
                if !(scale > 0.0 && (1.0 / scale).is_finite()) {
                    return Err(line.error("`length` is a factor above 0"));
                }
                self.file.length_scale = scale;
            }
            "angle" => {
                self.file.radians_per_angle = match words.get(1).map(|w| w.to_ascii_lowercase()) {
                    Some(w) if w.starts_with("deg") => 1_f64.to_radians(),
                    Some(w) if w.starts_with("rad") => 1.0,
                    _ => return Err(line.error("`angle` is `deg` or `rad`")),
                };
            }
            _ => {}
        }
        Ok(())
    }

    fn root(&mut self, words: &[&str], line: Line<'_>) -> Result<(), TextError> {
        match words[0].to_ascii_lowercase().as_str() {
            "order" => self.file.bones[0].dofs = dofs(&words[1..], line, 2)?,
            "axis" => self.root_order = order(words.get(1).copied(), line, 2)?,
            "position" => self.file.root_position = numbers(words, line)?,
            "orientation" => self.root_angles = numbers(words, line)?,
            _ => {}
        }
        Ok(())
    }

    fn bone(&mut self, words: &[&str], line: Line<'_>) -> Result<(), TextError> {
        let word = words[0].to_ascii_lowercase();
        if word == "begin" {
            let fresh = FileBone { name: String::new(), ..root() };
            return match self.bone.replace(fresh) {
                None => Ok(()),
                Some(_) => Err(line.error("the bone before this has no `end`")),
            };
        }
        let Some(bone) = &mut self.bone else {
            return Err(line.error("a bone starts with `begin`"));
        };
        match word.as_str() {
            "name" => words.get(1).copied().unwrap_or_default().clone_into(&mut bone.name),
            "direction" => bone.direction = numbers(words, line)?,
            "length" => [bone.length] = numbers(words, line)?,
            "axis" => {
                let angles: [f64; 3] = numbers(words, line)?;
                let order = order(words.get(4).copied(), line, 5)?;
                bone.axis = order.into_iter().zip(angles).collect();
            }
            "dof" => bone.dofs = dofs(&words[1..], line, 2)?,
            "end" => self.close_bone(line)?,
            // Limits, masses and ids say nothing about geometry.
            _ => {}
        }
        Ok(())
    }

    fn close_bone(&mut self, line: Line<'_>) -> Result<(), TextError> {
        let Some(bone) = self.bone.take() else { return Ok(()) };
        if bone.name.is_empty() {
            return Err(line.error("the bone that ends here has no `name`"));
        }
        if self.index.insert(bone.name.clone(), self.file.bones.len()).is_some() {
            let rule = "is described twice";
            return Err(TextError::Bone { line: line.number, bone: bone.name, rule });
        }
        let to_unit = bone.direction.iter().map(|c| c * c).sum::<f64>().sqrt();
        let length = bone.length;
        let direction = bone.direction.map(|c| if to_unit > 0.0 { c / to_unit } else { c });
        self.file.bones.push(FileBone { direction, length, ..bone });
        self.file.children.push(Vec::new());
        self.parents.push(None);
        Ok(())
    }

    /// A line `parent child…`.
    fn family(&mut self, words: &[&str], line: Line<'_>) -> Result<(), TextError> {
        if matches!(words, ["begin" | "end"]) {
            return Ok(());
        }
        let parent = self.known(words[0], line)?;
        for &word in &words[1..] {
            let child = self.known(word, line)?;
            if child == 0 || self.parents[child].replace(parent).is_some() {
                let rule = "has two parents";
                return Err(TextError::Bone {
                    line: line.number,
                    bone: shorten(word.as_bytes()),
                    rule,
                });
            }
            self.file.children[parent].push(child);
        }
        Ok(())
    }

    fn known(&self, name: &str, line: Line<'_>) -> Result<usize, TextError> {
        self.index.get(name).copied().ok_or_else(|| TextError::Bone {
            line: line.number,
            bone: shorten(name.as_bytes()),
            rule: "is not described in `:bonedata`",
        })
    }

    fn finish(mut self, last: usize, notes: &mut Vec<String>) -> Result<File, TextError> {
        if !self.has_hierarchy || self.bone.is_some() {
            return Err(TextError::Ended { line: last, what: "the end of `:hierarchy`" });
        }
        if self.file.bones[0].dofs.is_empty() {
            return Err(TextError::Ended { line: last, what: "the `order` of `:root`" });
        }
        self.check_tree(last)?;
        if self.root_angles.iter().any(|&a| a != 0.0) {
            notes.push("the root's orientation is taken as the axis of its rotations".into());
        }
        self.file.bones[0].axis = self.root_order.iter().copied().zip(self.root_angles).collect();
        Ok(self.file)
    }

    /// Every bone hangs on the root: the file is not cut, and no bones form a ring.
    fn check_tree(&self, last: usize) -> Result<(), TextError> {
        let mut is_reached = vec![false; self.file.bones.len()];
        let mut waiting = vec![0];
        while let Some(bone) = waiting.pop() {
            is_reached[bone] = true;
            waiting.extend(&self.file.children[bone]);
        }
        match is_reached.iter().position(|reached| !reached) {
            None => Ok(()),
            Some(lost) => Err(TextError::Bone {
                line: last,
                bone: self.file.bones[lost].name.clone(),
                rule: "does not hang on the root by `:hierarchy`",
            }),
        }
    }
}

/// Reads `TX TY TZ RX RY RZ`, in either case.
fn dofs(words: &[&str], line: Line<'_>, first: usize) -> Result<Vec<Dof>, TextError> {
    let dof = |(at, word): (usize, &&str)| match word.to_ascii_lowercase().as_str() {
        "rx" => Ok(Dof::Rotation(0)),
        "ry" => Ok(Dof::Rotation(1)),
        "rz" => Ok(Dof::Rotation(2)),
        "tx" => Ok(Dof::Translation(0)),
        "ty" => Ok(Dof::Translation(1)),
        "tz" => Ok(Dof::Translation(2)),
        "l" => Ok(Dof::Length),
        _ => Err(TextError::Field {
            line: line.number,
            field: first + at,
            text: shorten(word.as_bytes()),
            rule: "is no degree of freedom; they are rx, ry, rz, tx, ty, tz, l",
        }),
    };
    words.iter().enumerate().map(dof).collect()
}

/// Reads `XYZ`, an order of axes.
fn order(word: Option<&str>, line: Line<'_>, field: usize) -> Result<Vec<usize>, TextError> {
    let text = word.unwrap_or_default();
    let axis = |c: char| "xyz".find(c.to_ascii_lowercase());
    let axes: Option<Vec<usize>> = text.chars().map(axis).collect();
    match axes {
        Some(axes) if axes.len() == 3 => Ok(axes),
        _ => Err(TextError::Field {
            line: line.number,
            field,
            text: shorten(text.as_bytes()),
            rule: "is no order of axes, such as XYZ",
        }),
    }
}
