#![doc = include_str!("../README.md")]

mod body_frame;
mod bone_report;
mod bones;
mod error;
mod filled;
mod filler;
mod fit;
mod gap;
pub mod geometry;
mod holdout;
mod kinematics;
mod knowledge;
mod marker_set;
mod mask;
mod part_frame;
mod rotation;
mod skeleton;
mod solver;
mod take;

pub use body_frame::{BodyFrame, BodyMarkers, UpAxis};
pub use bone_report::{BoneReport, InfeasibleFrame};
pub use bones::{Bone, BoneRule, BoneSet, BoneSource, RigidPairs};
pub use error::CoreError;
pub use filled::{CellState, Estimates, Filled};
pub use filler::{
    Choice, FillError, FillReport, GapFiller, IterReport, Refusal, Refused, Termination,
};
pub use gap::{Gap, GapContext};
pub use geometry::{RigidTransform, Rotation};
pub use holdout::Holdout;
pub use kinematics::JointFrames;
pub use knowledge::MarkerKnowledge;
pub use marker_set::MarkerSet;
pub use mask::Mask;
pub use part_frame::{Alignment, PairAxis, PartFrame, PartMarkers, Side};
pub use skeleton::{Joint, Motion, Pose, Skeleton};
pub use solver::{MotionSolver, SolveError, Solved};
pub use take::Take;
