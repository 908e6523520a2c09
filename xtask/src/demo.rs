//! Shows the program at work, from a new machine to a plot.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;

use crate::{process, setup};

/// See the program at work: fill a gap in a sample recording and plot it
///
/// Installs what is missing, builds `mocap`, hides a part of a synthetic recording, fills it by
/// several methods, prints how far each is from the truth, writes a plot and says where.
#[derive(Args)]
pub struct Options {
    /// The folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out/demo")]
    output: PathBuf,
    /// Install what is missing without asking
    #[arg(short, long)]
    yes: bool,
}

/// Sets the machine up and hands over to `mocap demo`.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    setup::ensure(options.yes)?;
    process::build_mocap(root)?;
    let take = root.join("fixtures/run.c3d");
    process::run(process::mocap(root).arg("demo").arg(take).arg("-o").arg(&options.output))
}
