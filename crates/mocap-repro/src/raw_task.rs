//! The task `raw`: real gaps, of which no truth is known.

use std::{num::NonZeroUsize, path::PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use mocap_repro::{Variant, raw_fills, raw_table};

/// Every method on the recordings that have gaps of their own: what was filled, and how it fits
///
/// Nothing is known of what was hidden, so the table has gaps filled and left open, steps at their borders, bone
/// lengths, and the count of measured samples that a method altered, which has to be zero. Writes raw.md, raw.csv
/// and raw.json.
#[derive(Args)]
pub(crate) struct Raw {
    /// Folder with the recordings [default: the variable `MOCAP_DATA`]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Methods, with commas between [default: all]; `bolero-sc+lambda=100` sets an option
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    methods: Vec<String>,
    /// Iterations at most [default: each method's own number]
    #[arg(long, value_name = "N")]
    iterations: Option<NonZeroUsize>,
    /// Print the figures as JSON rather than as a table
    #[arg(long)]
    json: bool,
}

impl Raw {
    pub(crate) fn run(&self) -> Result<()> {
        let data = self.data.clone().or_else(|| std::env::var_os("MOCAP_DATA").map(PathBuf::from));
        let data = data.context(
            "no recordings: name their folder with --data DIR or in the variable MOCAP_DATA",
        )?;
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("cannot make the folder {}", self.out.display()))?;
        let variants = Variant::parse_list(&self.methods)?;
        let iterations = self.iterations.map(NonZeroUsize::get);
        let fills = raw_fills(&data, &variants, iterations, |fill| {
            eprintln!("{}: {} in {:.2} s", fill.recording, fill.method, fill.seconds);
        })?;
        let table = raw_table(&fills);
        let json = serde_json::to_string_pretty(&fills)?;
        for (name, text) in [
            ("raw.md", table.to_markdown()),
            ("raw.csv", table.to_csv()),
            ("raw.json", json.clone()),
        ] {
            mocap_io::write_atomic(&self.out.join(name), text.as_bytes(), true)?;
        }
        println!("{}", if self.json { json } else { table.to_text() });
        if let Some(fill) = fills.iter().find(|fill| fill.altered > 0) {
            bail!(
                "{} altered {} measured samples of {}",
                fill.method,
                fill.altered,
                fill.recording
            );
        }
        Ok(())
    }
}
