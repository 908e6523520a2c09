use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use mocap_core::Mask;
use serde_json::json;

use crate::files::ReadArgs;
use crate::say::say;

/// Compare a fill with the truth, over the samples that were hidden
///
/// The hidden samples are those that OCCLUDED lacks and TRUTH has.
#[derive(Debug, Args)]
#[command(after_help = "Example:
  mocap score walk.c3d filled.c3d --occluded gap.c3d

mse is Eq. 13 of the BoLeRO paper: the mean squared error of a coordinate, in m².")]
pub(crate) struct Score {
    /// Complete recording
    truth: PathBuf,
    /// Recording with the gaps filled
    filled: PathBuf,
    /// Recording with the gaps
    #[arg(long, value_name = "IN")]
    occluded: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    read: ReadArgs,
}

impl Score {
    pub(crate) fn run(self) -> Result<()> {
        let (truth, filled, occluded) = (
            self.read.read(&self.truth)?,
            self.read.read(&self.filled)?,
            self.read.read(&self.occluded)?,
        );
        let (t, o) = (truth.take(), occluded.take());
        if t.markers() != o.markers() || t.frames() != o.frames() {
            bail!(
                "{} and {} do not have the same markers and frames",
                self.truth.display(),
                self.occluded.display()
            );
        }
        let hidden = Mask::from_fn(t.frames(), t.marker_count(), |f, m| {
            t.is_observed(f, m) && !o.is_observed(f, m)
        });
        let score = metrics::score(t, filled.take(), &hidden)?;
        if self.json {
            let object = json!({
                "mse_m2": score.mse_m2, "mean_mm": score.mean_mm, "median_mm": score.median_mm,
                "p95_mm": score.p95_mm, "max_mm": score.max_mm, "rms_mm": score.rms_mm,
                "hidden_samples": score.hidden_cells, "unfilled_samples": score.unfilled_cells,
            });
            say!("{object}");
        } else {
            say!("hidden samples   {:>10}", score.hidden_cells);
            say!("left open        {:>10}", score.unfilled_cells);
            say!("mse (Eq. 13)     {:>10.3e} m²", score.mse_m2);
            say!("mean 3-D error   {:>10.2} mm", score.mean_mm);
            say!("median           {:>10.2} mm", score.median_mm);
            say!("95 % quantile    {:>10.2} mm", score.p95_mm);
            say!("largest          {:>10.2} mm", score.max_mm);
        }
        Ok(())
    }
}
