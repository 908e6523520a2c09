use std::fmt::Write;

use mocap_core::{
    Skeleton,
    geometry::{distance, norm},
};

use crate::{LengthUnit, text::names};

/// `length` of `:units` in the files of CMU's database, which other programs take for granted.
const LENGTH_SCALE: f64 = 0.45;

/// Units of length in a metre in the files that are written here.
pub(in crate::text) fn units_per_metre() -> f64 {
    LengthUnit::Inch.per_metre() * LENGTH_SCALE
}

/// Writes a skeleton as ASF, in the units of CMU's database: inches times 0.45, and degrees.
///
/// Every bone may turn about all three axes, so that any pose of the skeleton fits, and all axes are the
/// world's. A last joint called `<parent>_end` is where its parent's bone ends. Where children of one
/// joint start at different places, each hangs on a stiff bone of its own, called `to_<child>`.
/// The root is called `root`, as the format has it.
#[must_use]
pub fn encode(skeleton: &Skeleton) -> Vec<u8> {
    let bones = bones(skeleton);
    let [x, y, z] = skeleton.joints().first().map_or([0.0; 3], |root| root.offset_m);
    let root = [x, y, z].map(|c| format!("{:.9}", c * units_per_metre())).join(" ");
    let mut out = format!(
        ":version 1.10\n:name skeleton\n:units\n  mass 1.0\n  length {LENGTH_SCALE}\n  angle deg\n\
         :documentation\n  lengths are inches times {LENGTH_SCALE}\n\
         :root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n  position {root}\n  orientation 0 0 0\n:bonedata\n"
    );
    for (id, bone) in bones.iter().enumerate().skip(1) {
        bone.push(id, &mut out);
    }
    out.push_str(":hierarchy\n  begin\n");
    let mut children: Vec<Vec<&str>> = vec![Vec::new(); bones.len()];
    for bone in &bones {
        if let Some(parent) = bone.parent {
            children[parent].push(&bone.name);
        }
    }
    for (bone, children) in bones.iter().zip(children).filter(|(_, children)| !children.is_empty())
    {
        let _ = writeln!(out, "    {} {}", bone.name, children.join(" "));
    }
    out.push_str("  end\n");
    out.into_bytes()
}

/// A bone of a file that is written.
pub(in crate::text) struct Bone {
    pub(in crate::text) name: String,
    /// The joint at its start; `None` for a stiff bone that the format needs.
    pub(in crate::text) joint: Option<usize>,
    parent: Option<usize>,
    /// From its start to its end, in metres.
    vector_m: [f64; 3],
}

impl Bone {
    fn push(&self, id: usize, out: &mut String) {
        let length = norm(self.vector_m);
        // A bone without length has no direction; the format wants one.
        let along = if length > 0.0 { self.vector_m.map(|c| c / length) } else { [0.0, 0.0, 1.0] };
        let along = along.map(|c| format!("{c:.12}")).join(" ");
        let _ = write!(
            out,
            "  begin\n    id {id}\n    name {}\n    direction {along}\n    length {:.9}\n    axis 0 0 0 XYZ\n",
            self.name,
            length * units_per_metre()
        );
        if self.joint.is_some() {
            out.push_str("    dof rx ry rz\n");
        }
        out.push_str("  end\n");
    }
}

/// The bones of a skeleton, the root first and parents before their children.
pub(in crate::text) fn bones(skeleton: &Skeleton) -> Vec<Bone> {
    let joints = skeleton.joints();
    let mut children = vec![Vec::new(); joints.len()];
    for (index, joint) in joints.iter().enumerate() {
        if let Some(parent) = joint.parent {
            children[parent].push(index);
        }
    }
    let is_end = |joint: usize| {
        joints[joint].parent.is_some_and(|parent| {
            let stem = joints[joint].name.strip_suffix("_end");
            // The root's bone has no length, so its end is a bone.
            parent > 0
                && children[joint].is_empty()
                && children[parent].len() == 1
                && stem == Some(joints[parent].name.as_str())
        })
    };
    let mut bone_of = vec![0; joints.len()];
    let mut bones: Vec<Bone> = Vec::with_capacity(joints.len());
    for (index, joint) in joints.iter().enumerate() {
        if is_end(index) {
            continue;
        }
        let mut parent = joint.parent.map(|p| bone_of[p]);
        if let Some(p) = parent
            && !is_one_place(bones[p].vector_m, joint.offset_m)
        {
            let name = format!("to_{}", joint.name);
            bones.push(Bone { name, joint: None, parent, vector_m: joint.offset_m });
            parent = Some(bones.len() - 1);
        }
        // The bone reaches as far as all its children agree on.
        let mut starts = children[index].iter().map(|&c| joints[c].offset_m);
        let first = starts.next().filter(|_| index > 0);
        let vector_m =
            first.filter(|first| starts.all(|s| is_one_place(s, *first))).unwrap_or([0.0; 3]);
        bone_of[index] = bones.len();
        bones.push(Bone { name: joint.name.clone(), joint: Some(index), parent, vector_m });
    }
    name(&mut bones);
    bones
}

/// Whether two places are the same to the last bit.
fn is_one_place(p: [f64; 3], q: [f64; 3]) -> bool {
    distance(p, q) <= 0.0
}

/// Gives each bone a name that both files of the format can hold.
fn name(bones: &mut [Bone]) {
    let safe = |(index, bone): (usize, &Bone)| {
        let plain = |c: char| if c.is_whitespace() || c.is_control() { '_' } else { c };
        let text: String = bone.name.chars().map(plain).collect();
        // A line of an AMC file that starts with a number opens a frame; other signs open comments and sections.
        let is_word = text.starts_with(|c: char| c.is_alphabetic() || c == '_');
        match index {
            0 => "root".to_owned(),
            _ if is_word => text,
            _ => format!("_{text}"),
        }
    };
    let labels = bones.iter().enumerate().map(safe).collect();
    for (bone, name) in bones.iter_mut().zip(names::unique(labels, "bone", &mut Vec::new())) {
        bone.name = name;
    }
}
