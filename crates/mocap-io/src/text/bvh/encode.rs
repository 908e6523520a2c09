use std::fmt::Write;

use mocap_core::{Motion, Rotation, Skeleton};

use crate::{LengthUnit, text::euler};

/// Writes a motion as BVH: the root with six channels, every other joint with
/// `Zrotation Yrotation Xrotation`, six decimals of a degree and eight of the unit.
///
/// A last joint called `<parent>_end`, as [`Bvh`](super::Bvh) names them, becomes an `End Site`; under any other last
/// joint an `End Site` of no length is written, which the format asks for.
///
/// # Units
/// Lengths in `unit`, which the file does not name.
#[must_use]
pub fn encode(motion: &Motion, unit: LengthUnit) -> Vec<u8> {
    let tree = Tree::of(motion.skeleton());
    let mut out = String::from("HIERARCHY\n");
    let order = tree.push_hierarchy(unit, &mut out);
    let frames = motion.poses().len();
    let _ = write!(out, "MOTION\nFrames: {frames}\nFrame Time: {}\n", 1.0 / motion.rate_hz());
    for pose in motion.poses() {
        let root = pose.root_m.map(|c| format!("{:.8}", c * unit.per_metre()));
        out.push_str(&root.join(" "));
        for &joint in &order {
            push_angles(pose.rotations[joint], &mut out);
        }
        out.push('\n');
    }
    out.into_bytes()
}

fn push_angles(rotation: Rotation, out: &mut String) {
    for angle in euler::zyx(rotation) {
        let _ = write!(out, " {:.6}", angle.to_degrees());
    }
}

struct Tree<'a> {
    skeleton: &'a Skeleton,
    children: Vec<Vec<usize>>,
}

/// A step of the walk through the tree.
enum Step {
    Enter(usize, usize),
    Leave(usize),
}

impl<'a> Tree<'a> {
    fn of(skeleton: &'a Skeleton) -> Self {
        let mut children = vec![Vec::new(); skeleton.joints().len()];
        for (index, joint) in skeleton.joints().iter().enumerate() {
            if let Some(parent) = joint.parent {
                children[parent].push(index);
            }
        }
        Self { skeleton, children }
    }

    fn is_end(&self, joint: usize) -> bool {
        let joints = self.skeleton.joints();
        let Some(parent) = joints[joint].parent else { return false };
        let name = joints[joint].name.strip_suffix("_end");
        self.children[joint].is_empty() && name == Some(joints[parent].name.as_str())
    }

    /// Writes the joints depth first, and tells their order without the ends.
    fn push_hierarchy(&self, unit: LengthUnit, out: &mut String) -> Vec<usize> {
        let mut order = Vec::new();
        let mut steps = if self.children.is_empty() { vec![] } else { vec![Step::Enter(0, 0)] };
        while let Some(step) = steps.pop() {
            match step {
                Step::Leave(depth) => push_line(out, depth, "}"),
                Step::Enter(joint, depth) => {
                    self.push_joint(joint, depth, unit, out);
                    steps.push(Step::Leave(depth));
                    if !self.is_end(joint) {
                        order.push(joint);
                        let children = self.children[joint].iter().rev();
                        steps.extend(children.map(|&child| Step::Enter(child, depth + 1)));
                    }
                }
            }
        }
        order
    }

    /// Writes a joint but for its closing brace.
    fn push_joint(&self, index: usize, depth: usize, unit: LengthUnit, out: &mut String) {
        let joint = &self.skeleton.joints()[index];
        let is_end = self.is_end(index);
        let name: String = joint.name.chars().map(|c| if is_unsafe(c) { '_' } else { c }).collect();
        match joint.parent {
            None => push_line(out, depth, &format!("ROOT {name}")),
            Some(_) if is_end => push_line(out, depth, "End Site"),
            Some(_) => push_line(out, depth, &format!("JOINT {name}")),
        }
        push_line(out, depth, "{");
        let offset = joint.offset_m.map(|c| format!("{:.8}", c * unit.per_metre())).join(" ");
        push_line(out, depth + 1, &format!("OFFSET {offset}"));
        let rotations = "Zrotation Yrotation Xrotation";
        match joint.parent {
            None => {
                let line = format!("CHANNELS 6 Xposition Yposition Zposition {rotations}");
                push_line(out, depth + 1, &line);
            }
            Some(_) if is_end => {}
            Some(_) => push_line(out, depth + 1, &format!("CHANNELS 3 {rotations}")),
        }
        if self.children[index].is_empty() && !is_end {
            for (deeper, text) in [(0, "End Site"), (0, "{"), (1, "OFFSET 0 0 0"), (0, "}")] {
                push_line(out, depth + 1 + deeper, text);
            }
        }
    }
}

fn is_unsafe(c: char) -> bool {
    c.is_whitespace() || c.is_control() || matches!(c, '{' | '}')
}

fn push_line(out: &mut String, depth: usize, text: &str) {
    // Deep chains of joints would fill the file with tabs.
    const DEEPEST: usize = 40;
    out.extend(std::iter::repeat_n('\t', depth.min(DEEPEST)));
    out.push_str(text);
    out.push('\n');
}
