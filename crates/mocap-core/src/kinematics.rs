//! Where joints are in a pose, and how they move when it changes.

use ndarray::Array2;

use crate::{
    CoreError, Pose, Rotation, Skeleton,
    geometry::{add, sub},
};

/// The joints of a skeleton in the world, for one pose.
#[derive(Debug, Clone, PartialEq)]
pub struct JointFrames {
    /// Places in metres, `(joints, 3)`.
    pub origins_m: Vec<[f64; 3]>,
    /// Rotations from the rest pose to the world, `(joints,)`.
    pub rotations: Vec<Rotation>,
}

impl JointFrames {
    /// A point that is fixed to a joint, in the world.
    ///
    /// # Panics
    /// If the skeleton has no such joint.
    ///
    /// # Units
    /// Metres.
    #[must_use]
    pub fn point(&self, joint: usize, local_m: [f64; 3]) -> [f64; 3] {
        add(self.origins_m[joint], self.rotations[joint].apply(local_m))
    }
}

impl Skeleton {
    /// Forward kinematics: the joints in the world.
    ///
    /// # Errors
    /// [`CoreError::PoseLength`].
    pub fn frames(&self, pose: &Pose) -> Result<JointFrames, CoreError> {
        let joints = self.joints();
        if pose.rotations.len() != joints.len() {
            let (expected, found) = (joints.len(), pose.rotations.len());
            return Err(CoreError::PoseLength { expected, found });
        }
        let mut frames = JointFrames {
            origins_m: Vec::with_capacity(joints.len()),
            rotations: Vec::with_capacity(joints.len()),
        };
        for (joint, &rotation) in joints.iter().zip(&pose.rotations) {
            let (origin, turn) = match joint.parent {
                None => (add(pose.root_m, joint.offset_m), rotation),
                Some(p) => (frames.point(p, joint.offset_m), frames.rotations[p].after(rotation)),
            };
            frames.origins_m.push(origin);
            frames.rotations.push(turn);
        }
        Ok(frames)
    }

    /// The joint and its ancestors, the root last.
    ///
    /// # Panics
    /// If the skeleton has no such joint.
    pub fn ancestry(&self, joint: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(joint), |&j| self.joints()[j].parent)
    }

    /// How a point that is fixed to a joint moves with the pose: `(3, 3 + 3 · joints)`, by the coordinates of
    /// [`moved`](Self::moved). The point is given in the world, in metres.
    ///
    /// # Panics
    /// If the skeleton has no such joint, or the frames are those of another.
    ///
    /// # Units
    /// Metres per metre in the first three columns, metres per radian in the others.
    #[must_use]
    pub fn jacobian(&self, frames: &JointFrames, joint: usize, point_m: [f64; 3]) -> Array2<f64> {
        let mut jacobian = Array2::zeros((3, 3 + 3 * self.joints().len()));
        for axis in 0..3 {
            jacobian[(axis, axis)] = 1.0;
        }
        for j in self.ancestry(joint) {
            // d = ω × arm, so column a is eₐ × arm.
            let [x, y, z] = sub(point_m, frames.origins_m[j]);
            let columns = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
            for (axis, column) in columns.into_iter().enumerate() {
                for (row, value) in column.into_iter().enumerate() {
                    jacobian[(row, 3 + 3 * j + axis)] = value;
                }
            }
        }
        jacobian
    }

    /// The pose moved by a step `(3 + 3 · joints,)`: the first three numbers shift the root, in metres, and
    /// three more for each joint turn all that hangs on it about the joint, a rotation vector along the
    /// world's axes, in radians.
    ///
    /// # Panics
    /// If the step is shorter, or the frames are not those of the pose.
    #[must_use]
    pub fn moved(&self, pose: &Pose, frames: &JointFrames, step: &[f64]) -> Pose {
        let three = |at: usize| [step[at], step[at + 1], step[at + 2]];
        let turn = |(j, &rotation): (usize, &Rotation)| {
            let by = three(3 + 3 * j);
            let by = match self.joints()[j].parent {
                None => by,
                Some(p) => frames.rotations[p].inverse().apply(by),
            };
            Rotation::exp(by).after(rotation).normalized()
        };
        Pose {
            root_m: add(pose.root_m, three(0)),
            rotations: pose.rotations.iter().enumerate().map(turn).collect(),
        }
    }
}
