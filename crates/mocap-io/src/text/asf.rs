//! ASF, the skeleton of the Acclaim format.
//!
//! # Geometry
//! A bone starts where its parent ends, and runs along its own direction for its own length. Its rotation in
//! a frame is C · R · C⁻¹ with C from `axis` and R from the angles of its `dof`; of both, the first
//! angle is applied first. In the [`Skeleton`], the joint of a bone's name is the bone's start, and the end of a last
//! bone is a joint called `<bone>_end`.
//!
//! # Units
//! Lengths are divided by `length` of the section `:units` and are inches then, as in CMU's and HDM05's
//! files, unless [`ReadOptions::unit`](crate::ReadOptions::unit) names another unit.

use std::{collections::HashMap, sync::Arc};

use mocap_core::{Joint, Rotation, Skeleton};

use super::{
    TextError, euler,
    grid::note_line_end,
    lines::{Line, Lines},
    names, number,
};
use crate::{FileInfo, Format, LengthUnit, ReadOptions};

mod encode;
mod reader;

pub use encode::encode;
pub(super) use encode::{bones, units_per_metre};

/// A degree of freedom of a bone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dof {
    /// Rotation about x, y or z (0, 1, 2).
    Rotation(usize),
    /// Translation along x, y or z (0, 1, 2).
    Translation(usize),
    /// Stretching of the bone.
    Length,
}

/// A bone as the file has it; bone 0 is the root.
#[derive(Debug, Clone)]
pub(super) struct FileBone {
    pub name: String,
    pub direction: [f64; 3],
    pub length: f64,
    /// Angles in the file's unit and their axes, first applied first.
    pub axis: Vec<(usize, f64)>,
    pub dofs: Vec<Dof>,
}

/// An ASF file.
#[derive(Debug, Clone)]
pub struct Asf {
    bytes: Vec<u8>,
    bones: Vec<FileBone>,
    index: HashMap<String, usize>,
    /// Joint of each bone.
    joints: Vec<usize>,
    /// C of each bone.
    axes: Vec<Rotation>,
    skeleton: Arc<Skeleton>,
    metres_per_unit: f64,
    radians_per_angle: f64,
    info: FileInfo,
}

impl Asf {
    /// Reads an ASF file.
    ///
    /// # Errors
    /// [`TextError`], with the line.
    pub fn parse(bytes: Vec<u8>, options: &ReadOptions) -> Result<Self, TextError> {
        let mut info = FileInfo::new(Format::Asf, "text");
        let file = reader::read(&bytes, &mut info.notes)?;
        info.unit = options.unit.unwrap_or_else(|| {
            info.notes.push("the file names no unit of length; inches are assumed".into());
            LengthUnit::Inch
        });
        note_line_end(&bytes, &mut info.notes);
        let metres_per_unit = info.unit.metres() / file.length_scale;
        let radians_per_angle = file.radians_per_angle;
        let turns = |b: &FileBone| {
            euler::first_to_last(b.axis.iter().map(|&(a, angle)| (a, angle * radians_per_angle)))
        };
        let axes = file.bones.iter().map(turns).collect();
        let (joints, list) = joints(&file, metres_per_unit, &mut info.notes);
        let skeleton = Arc::new(Skeleton::new(list)?);
        let index = file.bones.iter().enumerate().map(|(i, b)| (b.name.clone(), i)).collect();
        let bones = file.bones;
        Ok(Self {
            bytes,
            bones,
            index,
            joints,
            axes,
            skeleton,
            metres_per_unit,
            radians_per_angle,
            info,
        })
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

    /// The skeleton in metres.
    #[must_use]
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// Metres in a unit of length of this file and its AMC files.
    #[must_use]
    pub fn metres_per_unit(&self) -> f64 {
        self.metres_per_unit
    }

    /// Names of the bones with their degrees of freedom, the root first.
    pub fn bones(&self) -> impl Iterator<Item = (&str, &[Dof])> {
        self.bones.iter().map(|bone| (bone.name.as_str(), bone.dofs.as_slice()))
    }

    pub(super) fn radians_per_angle(&self) -> f64 {
        self.radians_per_angle
    }

    pub(super) fn find(&self, bone: &str) -> Option<usize> {
        self.index.get(bone).copied()
    }

    pub(super) fn bone(&self, bone: usize) -> &FileBone {
        &self.bones[bone]
    }

    /// Joint of a bone in the skeleton.
    pub(super) fn joint(&self, bone: usize) -> usize {
        self.joints[bone]
    }

    /// Rotation of a bone's joint for the angles of a frame, in radians, first applied first.
    pub(super) fn rotation(&self, bone: usize, turns: &[(usize, f64)]) -> Rotation {
        let c = self.axes[bone];
        c.after(euler::first_to_last(turns.iter().copied())).after(c.inverse())
    }
}

/// The joint of each bone, and the skeleton's joints, depth first.
fn joints(
    file: &reader::File,
    metres_per_unit: f64,
    notes: &mut Vec<String>,
) -> (Vec<usize>, Vec<Joint>) {
    let mut joint_of = vec![0; file.bones.len()];
    let mut joints: Vec<Joint> = Vec::with_capacity(file.bones.len());
    let mut waiting = vec![(0_usize, None)];
    while let Some((bone, parent)) = waiting.pop() {
        let start = match parent {
            None => file.root_position,
            Some(parent) => end_of(&file.bones[parent]),
        };
        joint_of[bone] = joints.len();
        joints.push(Joint {
            name: file.bones[bone].name.clone(),
            parent: parent.map(|p| joint_of[p]),
            offset_m: start.map(|c| c * metres_per_unit),
        });
        let children = &file.children[bone];
        waiting.extend(children.iter().rev().map(|&child| (child, Some(bone))));
        if children.is_empty() && bone != 0 {
            joints.push(Joint {
                name: format!("{}_end", file.bones[bone].name),
                parent: Some(joint_of[bone]),
                offset_m: end_of(&file.bones[bone]).map(|c| c * metres_per_unit),
            });
        }
    }
    let labels = joints.iter_mut().map(|j| std::mem::take(&mut j.name)).collect();
    for (joint, name) in joints.iter_mut().zip(names::unique(labels, "joint", notes)) {
        joint.name = name;
    }
    (joint_of, joints)
}

/// End of a bone relative to its start, in the file's unit.
fn end_of(bone: &FileBone) -> [f64; 3] {
    bone.direction.map(|c| c * bone.length)
}

/// Reads numbers from the words after a keyword.
pub(super) fn numbers<const N: usize>(
    words: &[&str],
    line: Line<'_>,
) -> Result<[f64; N], TextError> {
    if words.len() < N + 1 {
        return Err(TextError::Width { line: line.number, expected: N + 1, found: words.len() });
    }
    let mut values = [0.0; N];
    for (at, value) in values.iter_mut().enumerate() {
        *value = number::finite(words[at + 1].as_bytes(), line.number, at + 2)?;
    }
    Ok(values)
}

/// The lines that are neither blank nor comments.
pub(super) fn content(lines: Lines<'_>) -> impl Iterator<Item = Line<'_>> {
    lines.filter(|line| !matches!(line.text.trim_ascii(), [] | [b'#', ..]))
}
