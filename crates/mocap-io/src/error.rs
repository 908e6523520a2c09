use std::path::PathBuf;

use mocap_core::CoreError;
use thiserror::Error;

use crate::{Format, c3d::C3dError, text::TextError};

/// Why bytes are not a recording.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ParseError {
    /// Not a C3D file, or a damaged one.
    #[error(transparent)]
    C3d(#[from] C3dError),
    /// Not a text file of its format, or a damaged one.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The content breaks a rule of the core types.
    #[error(transparent)]
    Core(#[from] CoreError),
    /// A skeleton where markers are needed.
    #[error(".{} files hold a skeleton and no markers", format.extension())]
    NoMarkers {
        /// The format.
        format: Format,
    },
    /// Markers where a skeleton's motion is needed.
    #[error(".{} files hold no skeleton motion", format.extension())]
    NoMotion {
        /// The format.
        format: Format,
    },
}

/// Why a file cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system refused.
    #[error("cannot read {}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
    /// An extension that names no format.
    #[error(
        "{}: no format goes by this extension; known are .c3d .trc .csv .tsv .bvh .asf .amc, each \
         also with .gz",
        path.display()
    )]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// An AMC file without its skeleton.
    #[error("{}: the ASF file of its skeleton is not beside it; name it with --asf", path.display())]
    NoSkeleton {
        /// The AMC file.
        path: PathBuf,
    },
    /// The content is not what the extension says.
    #[error("{}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        #[source]
        source: ParseError,
    },
}

/// Why a file cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// Something is there already.
    #[error("{} exists; choose another name, or allow replacing it with --force", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The operating system refused.
    #[error("cannot write {}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
    /// The samples do not fit into the C3D file.
    #[error(transparent)]
    C3d(#[from] C3dError),
    /// The samples do not fit into the text file.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A conversion that does not exist.
    #[error("no .{} file can be made of this: {rule}", to.extension())]
    Conversion {
        /// Format of the target.
        to: Format,
        /// Why not.
        rule: &'static str,
    },
}
