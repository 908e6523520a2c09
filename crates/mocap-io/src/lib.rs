#![doc = include_str!("../README.md")]

mod atomic;
mod bone_file;
pub mod c3d;
mod error;
mod format;
mod marker_file;
mod motion_file;
mod recording;
pub mod text;
mod unit;

pub use atomic::write_atomic;
pub use bone_file::{BoneFileError, read_bones, write_bones};
pub use error::{ParseError, ReadError, WriteError};
pub use format::Format;
pub use marker_file::{MarkerFile, encode_markers};
pub use motion_file::{MotionFile, encode_motion};
pub use recording::{Edit, FileInfo, MissingMarks, ReadOptions, Sample};
pub use unit::LengthUnit;
