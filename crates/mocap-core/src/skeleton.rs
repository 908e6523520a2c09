use std::sync::Arc;

use crate::{
    CoreError, RigidTransform, Rotation,
    geometry::{add, sub},
};

/// A joint of a skeleton.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Name, unique in its skeleton.
    pub name: String,
    /// Index of the parent; `None` for the root alone.
    pub parent: Option<usize>,
    /// Place relative to the parent in the rest pose, in metres.
    pub offset_m: [f64; 3],
}

/// A tree of joints: the root first, and parents before their children.
#[derive(Debug, Clone, PartialEq)]
pub struct Skeleton {
    joints: Vec<Joint>,
}

impl Skeleton {
    /// Checks and takes the joints.
    ///
    /// # Errors
    /// [`CoreError::JointOrder`] unless the first joint is the only root and each other joint
    /// names an earlier one as parent; [`CoreError::DuplicateMarkerName`] for two joints of one name.
    pub fn new(joints: Vec<Joint>) -> Result<Self, CoreError> {
        for (i, joint) in joints.iter().enumerate() {
            let in_order = match joint.parent {
                None => i == 0,
                Some(parent) => parent < i,
            };
            if !in_order {
                let name = joint.name.clone();
                return Err(CoreError::JointOrder { joint: i, name, parent: joint.parent });
            }
        }
        crate::MarkerSet::new(joints.iter().map(|j| j.name.as_str()))?;
        Ok(Self { joints })
    }

    /// The joints, parents first.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Index of a joint by name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|j| j.name == name)
    }

    /// Forward kinematics: the joints' positions in metres, `(joints, 3)`.
    ///
    /// See [`frames`](Self::frames) for their rotations too.
    ///
    /// # Errors
    /// [`CoreError::PoseLength`].
    pub fn positions(&self, pose: &Pose) -> Result<Vec<[f64; 3]>, CoreError> {
        Ok(self.frames(pose)?.origins_m)
    }
}

/// One frame of a skeleton's motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    /// Translation of the root in metres.
    pub root_m: [f64; 3],
    /// Rotation of each joint relative to its parent, `(joints,)`.
    pub rotations: Vec<Rotation>,
}

impl Pose {
    /// The rest pose of a skeleton, with its root at its own offset.
    #[must_use]
    pub fn rest(skeleton: &Skeleton) -> Self {
        Self { root_m: [0.0; 3], rotations: vec![Rotation::IDENTITY; skeleton.joints().len()] }
    }
}

/// A skeleton and its poses over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    skeleton: Arc<Skeleton>,
    rate_hz: f64,
    poses: Vec<Pose>,
}

impl Motion {
    /// Takes poses of a skeleton at a sampling rate.
    ///
    /// # Errors
    /// [`CoreError::Rate`] and [`CoreError::PoseLength`].
    pub fn new(
        skeleton: impl Into<Arc<Skeleton>>,
        rate_hz: f64,
        poses: Vec<Pose>,
    ) -> Result<Self, CoreError> {
        let skeleton = skeleton.into();
        if !(rate_hz.is_finite() && rate_hz > 0.0) {
            return Err(CoreError::Rate { rate_hz });
        }
        let expected = skeleton.joints().len();
        match poses.iter().map(|p| p.rotations.len()).find(|&found| found != expected) {
            Some(found) => Err(CoreError::PoseLength { expected, found }),
            None => Ok(Self { skeleton, rate_hz, poses }),
        }
    }

    /// The skeleton.
    #[must_use]
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// Sampling rate in Hz.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// The poses, one a frame.
    #[must_use]
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// The same motion somewhere else, or in other axes.
    ///
    /// # Errors
    /// None in practice; the signature is that of [`new`](Self::new).
    pub fn transformed(&self, by: &RigidTransform) -> Result<Self, CoreError> {
        let offset = self.skeleton.joints().first().map_or([0.0; 3], |root| root.offset_m);
        let moved = |pose: &Pose| {
            let mut rotations = pose.rotations.clone();
            if let Some(root) = rotations.first_mut() {
                *root = by.rotation.after(*root);
            }
            Pose { root_m: sub(by.apply(add(pose.root_m, offset)), offset), rotations }
        };
        let poses = self.poses.iter().map(moved).collect();
        Self::new(Arc::clone(&self.skeleton), self.rate_hz, poses)
    }
}
