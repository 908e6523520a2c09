//! The task `synth-report`: synthetic people beside captured ones.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use mocap_repro::synth_report;

/// Distributions of the synthetic people beside those of captured ones
///
/// Joint angles, speeds and accelerations by activity, and lengths of bones. Writes synth.md, synth.html, the tables as CSV and
/// the figures as SVG and PNG.
#[derive(Args)]
pub(crate) struct SynthReport {
    /// Folder with the recordings [default: the variable `MOCAP_DATA`]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl SynthReport {
    pub(crate) fn run(&self) -> Result<()> {
        let data = self.data.clone().or_else(|| std::env::var_os("MOCAP_DATA").map(PathBuf::from));
        let data = data.context(
            "no recordings: name their folder with --data DIR or in the variable MOCAP_DATA",
        )?;
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("cannot make the folder {}", self.out.display()))?;
        let report = synth_report(&data, &mut |activity| eprintln!("{activity} …"))?;
        let [markdown, page] = report.write(&self.out, "synth")?;
        print!("{}", report.to_markdown());
        eprintln!("tables: {}\nweb page: {}", markdown.display(), page.display());
        Ok(())
    }
}
