use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use mocap_core::MarkerKnowledge;

/// Marker sets that the program should know.
#[derive(Debug, Clone, Args)]
pub(crate) struct MarkerSetArgs {
    /// File that describes a marker set: lines `marker NAME`, `alias NAME OTHER…`, `bone A B`, `role back NAME…`, `role
    /// front NAME…`; may be repeated. The CMU 41 markers, Plug-in Gait names, front_waist-53 and production-57 are known
    #[arg(long, value_name = "FILE")]
    marker_set: Vec<PathBuf>,
}

impl MarkerSetArgs {
    /// The user's sets, then the built-in ones.
    pub(crate) fn known(&self) -> Result<Vec<MarkerKnowledge>> {
        let mut known = Vec::new();
        for path in &self.marker_set {
            let text = std::fs::read_to_string(path)
                .with_context(|| format!("cannot read {}", path.display()))?;
            known.push(MarkerKnowledge::parse(&text, &path.display().to_string())?);
        }
        known.extend(MarkerKnowledge::built_in());
        Ok(known)
    }
}
