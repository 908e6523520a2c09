//! The tasks of this workspace, run as `cargo xtask <task>`.
//!
//! Links no crate of the workspace, so that it builds in seconds on a machine that has nothing
//! but Rust and a C compiler, and can then install the rest.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command-line program")]

use std::process::ExitCode;

use clap::{Parser, Subcommand};

mod bench;
mod ci;
mod data;
mod demo;
mod fixtures;
#[path = "../../crates/openblas-src/search.rs"]
mod openblas;
mod process;
mod repro;
mod setup;
mod tidy;

/// The tasks of this workspace.
///
/// On a new machine two commands do everything: `cargo xtask demo` shows the program at work, and
/// `cargo xtask ci` runs every check. Both first install what is missing.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    Setup(setup::Options),
    Demo(demo::Options),
    Ci(ci::Options),
    /// Check the rules of the house that no compiler checks
    ///
    /// Dependencies and crates against ARCHITECTURE.md, crate front pages, citations against
    /// docs/references.bib, file sizes, lints, leftovers. Each finding names the file, the line, the
    /// rule and the way out.
    Tidy,
    Fixtures(fixtures::Options),
    Bench(bench::Options),
    #[command(subcommand)]
    Data(data::Task),
    ReproducePaper(repro::Paper),
    Leaderboard(repro::Board),
    SynthReport(repro::Synth),
}

fn main() -> ExitCode {
    let task = Cli::parse().task;
    run(&task).unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}

fn run(task: &Task) -> anyhow::Result<ExitCode> {
    let root = process::workspace_root()?;
    match task {
        Task::Setup(options) => setup::run(options)?,
        Task::Demo(options) => demo::run(&root, options)?,
        Task::Ci(options) => return Ok(ci::run(&root, options)),
        Task::Tidy => tidy::run(&root)?,
        Task::Fixtures(options) => fixtures::run(&root, options)?,
        Task::Bench(options) => bench::run(&root, options)?,
        Task::Data(task) => data::run(task)?,
        Task::ReproducePaper(options) => return repro::paper(&root, options),
        Task::Leaderboard(options) => return repro::leaderboard(&root, options),
        Task::SynthReport(options) => return repro::synth(&root, options),
    }
    Ok(ExitCode::SUCCESS)
}
