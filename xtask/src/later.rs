//! Tasks whose engine, the benchmark matrix, is not in this workspace.

use std::process::ExitCode;

use clap::{Args, ValueEnum};

/// Rebuild a paper's tables and figures (not yet: says what works today)
#[derive(Args)]
pub struct Paper {
    /// Which results to rebuild
    #[arg(value_enum)]
    which: Option<Which>,
    /// A small part of the matrix, in minutes
    #[arg(long)]
    quick: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Which {
    Bolero,
    Localmocap,
    Leaderboard,
}

/// Rank all methods on the same gaps (not yet: says what works today)
#[derive(Args)]
pub struct Board {
    /// A small part of the matrix, in minutes
    #[arg(long)]
    quick: bool,
}

/// The code of a task that cannot be done yet, told apart from one that failed.
const NOT_YET: u8 = 2;

/// Says what is missing and what to use today.
pub fn answer(task: &str) -> ExitCode {
    eprintln!(
        "{task}: not yet: the benchmark matrix is not built.\n\
         What works today, one recording at a time:\n  \
         mocap occlude TAKE -o GAPPY --marker NAME --frames A..B   hide what you know\n  \
         mocap fill GAPPY -o FILLED --method bolero-sc             fill it\n  \
         mocap score TAKE FILLED --occluded GAPPY                  measure the error\n\
         `cargo run --release -p mocap-cli -- methods` lists the methods; `cargo xtask demo` does \
         all three steps."
    );
    ExitCode::from(NOT_YET)
}
