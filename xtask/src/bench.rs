//! Runs the benchmarks of all crates.

use std::path::Path;

use anyhow::Result;
use clap::Args;

use crate::process;

/// Run the benchmarks of all crates, or those whose name holds FILTER
///
/// Benchmark names read method/dataset/gap/size. Close other programs first: the times are
/// those of this machine at this moment.
#[derive(Args)]
pub struct Options {
    /// Run only benchmarks whose name holds this text
    filter: Option<String>,
}

/// Passes the filter on to `cargo bench`.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    let filter = options.filter.iter();
    process::run(process::cargo(root).args(["bench", "--workspace", "--"]).args(filter))
}
