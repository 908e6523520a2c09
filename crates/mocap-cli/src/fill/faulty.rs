//! Faults found before filling.

use std::path::Path;

use anyhow::Result;
use marker_faults::FaultDetector;
use mocap_core::Take;
use mocap_io::MarkerFile;

use crate::detect;

/// What `--detect` found, and what is left to fill from.
pub(super) struct Faulty {
    pub report: detect::Report,
    pub left: Take,
}

impl Faulty {
    pub fn of(file: &MarkerFile, path: &Path, apply: bool) -> Result<Self> {
        let faults = FaultDetector::default().detect(file.take());
        let report = detect::Report::new(file, path, &faults);
        let left = if apply { faults.hide(file.take())? } else { file.take().clone() };
        Ok(Self { report, left })
    }
}
