use std::path::Path;

/// A file format, known by its extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// C3D, the exchange format of biomechanics.
    C3d,
    /// TRC, marker trajectories for `OpenSim`.
    Trc,
    /// Comma-separated columns: three a marker, or an `OptiTrack` Motive export.
    Csv,
    /// Tab-separated columns of Qualisys Track Manager.
    Tsv,
    /// Biovision hierarchy: a skeleton and its motion.
    Bvh,
    /// Acclaim skeleton.
    Asf,
    /// Acclaim motion, for the skeleton of an ASF file.
    Amc,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 7] =
        [Self::C3d, Self::Trc, Self::Csv, Self::Tsv, Self::Bvh, Self::Asf, Self::Amc];

    /// The format of a path by its extension, in any case, with or without a final `.gz`.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?.to_lowercase();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        let extension = name.rsplit_once('.')?.1;
        Self::ALL.into_iter().find(|format| format.extension() == extension)
    }

    /// The extension, in lower case.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::C3d => "c3d",
            Self::Trc => "trc",
            Self::Csv => "csv",
            Self::Tsv => "tsv",
            Self::Bvh => "bvh",
            Self::Asf => "asf",
            Self::Amc => "amc",
        }
    }

    /// Whether files of this format hold marker trajectories, rather than a skeleton.
    #[must_use]
    pub fn holds_markers(self) -> bool {
        matches!(self, Self::C3d | Self::Trc | Self::Csv | Self::Tsv)
    }
}

/// Whether a path names a gzip file.
pub(crate) fn is_gzip(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"))
}
