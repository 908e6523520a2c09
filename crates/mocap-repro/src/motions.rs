use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use mocap_core::Take;
use mocap_io::{MarkerFile, ReadOptions};
use sha2::{Digest, Sha256};

use crate::ReproError;

/// A recording to cut gaps into.
#[derive(Debug, Clone)]
pub struct Motion {
    take: Take,
    digest: String,
}

/// Recordings by name.
pub type Motions = BTreeMap<String, Arc<Motion>>;

/// Sampling rate of the CMU recordings, whose tables state none.
const CMU_RATE_HZ: f64 = 120.0;
const ENDINGS: [&str; 3] = ["c3d", "csv.gz", "csv"];

impl Motion {
    /// A recording as it is.
    #[must_use]
    pub fn new(take: Take) -> Self {
        let mut hasher = Sha256::new();
        hasher.update(take.rate_hz().to_le_bytes());
        for name in take.markers().names() {
            hasher.update(name.as_bytes());
            hasher.update([0]);
        }
        // Missing cells are one and the same NaN, so the digest is that of what was observed.
        for c in take.positions() {
            hasher.update(if c.is_nan() { f64::NAN } else { *c }.to_le_bytes());
        }
        Self { digest: hex(&hasher.finalize()[..8]), take }
    }

    /// Reads the named recording from a folder; a table without a sampling rate counts as 120 Hz.
    ///
    /// # Errors
    /// [`ReproError::Motion`] if there is no such file, [`ReproError::Read`] if it is none.
    pub fn read(folder: &Path, name: &str) -> Result<Self, ReproError> {
        let paths = ENDINGS.map(|ending| folder.join(format!("{name}.{ending}")));
        let path: PathBuf = paths.into_iter().find(|path| path.is_file()).ok_or_else(|| {
            ReproError::Motion { motion: name.to_owned(), folder: folder.to_owned() }
        })?;
        let options = ReadOptions { rate_hz: Some(CMU_RATE_HZ), ..ReadOptions::default() };
        Ok(Self::new(MarkerFile::read(&path, &options)?.take().clone()))
    }

    /// Reads each of the named recordings.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_all<'a>(
        folder: &Path,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Result<Motions, ReproError> {
        let mut motions = Motions::new();
        for name in names {
            if !motions.contains_key(name) {
                motions.insert(name.to_owned(), Arc::new(Self::read(folder, name)?));
            }
        }
        Ok(motions)
    }

    /// The recording.
    #[must_use]
    pub fn take(&self) -> &Take {
        &self.take
    }

    /// What tells two recordings apart.
    pub(crate) fn digest(&self) -> &str {
        &self.digest
    }
}

pub(crate) fn hex(bytes: &[u8]) -> String {
    let hex = |byte: &u8| {
        [byte >> 4, byte & 15].map(|half| char::from(b"0123456789abcdef"[usize::from(half)]))
    };
    bytes.iter().flat_map(hex).collect()
}
