//! Other recordings of the same person with the same markers.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use anyhow::{Result, bail};
use mocap_core::Take;
use mocap_io::MarkerFile;

use super::named_hash;
use crate::files::{ReadArgs, same_file};

/// A marker and the three neighbours of a local frame.
const SHARED_AT_LEAST: usize = 4;

/// The recordings of `--session`.
pub(super) struct Session<'a> {
    files: Vec<(&'a Path, MarkerFile)>,
}

impl<'a> Session<'a> {
    /// Reads them, and refuses what nothing can be learnt from.
    pub(super) fn read(
        paths: &'a [PathBuf],
        method: &str,
        (input, take): (&Path, &Take),
        read: &ReadArgs,
    ) -> Result<Self> {
        let deaf = |m: &gapfill::Method| m.id == method && !m.options.contains(&"session");
        if !paths.is_empty() && gapfill::METHODS.iter().any(deaf) {
            bail!("--session: `{method}` does not learn from other recordings; `auto` does");
        }
        let mut files = Vec::new();
        for path in paths {
            if same_file(path, input) {
                bail!("--session: {} is the recording to fill; name others", path.display());
            }
            let file = read.read(path)?;
            let other = file.take();
            let (own, hz) = (take.rate_hz(), other.rate_hz());
            if (hz / own - 1.0).abs() > 1e-6 {
                bail!("--session: {} has {hz} Hz, not {own} Hz", path.display());
            }
            let shared = |&m: &usize| other.markers().find(take.markers().split(m).1).is_ok();
            let shared = (0..take.marker_count()).filter(shared).count();
            if shared < SHARED_AT_LEAST {
                bail!(
                    "--session: {} shares {shared} marker names with {}; markers go by their names, and learning \
                     takes at least {SHARED_AT_LEAST}",
                    path.display(),
                    input.display()
                );
            }
            files.push((path.as_path(), file));
        }
        Ok(Self { files })
    }

    pub(super) fn takes(&self) -> Vec<Arc<Take>> {
        self.files.iter().map(|(_, file)| Arc::new(file.take().clone())).collect()
    }

    pub(super) fn hashes(&self) -> serde_json::Value {
        self.files.iter().map(|(path, file)| named_hash(path, file.bytes())).collect()
    }
}
