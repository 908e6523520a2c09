//! The `mocap` command: inspect, fill, solve, convert, occlude, score and plot recordings.
#![allow(clippy::print_stderr)] // a command talks to its user

mod bones;
mod convert;
mod demo;
mod detect;
mod files;
mod fill;
mod inspect;
mod marker_sets;
mod methods;
mod occlude;
mod plot;
mod progress;
mod say;
mod score;
mod solve;
mod synth;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Fill, solve, inspect and compare optical motion capture recordings
#[derive(Debug, Parser)]
#[command(
    name = "mocap",
    version,
    after_help = "Start with `mocap demo -o demo`, or with a recording of your own:
  mocap inspect walk.c3d              what is in it, and where its gaps are
  mocap detect walk.c3d               list samples that no body can have made
  mocap fill walk.c3d -o filled.c3d   fill the gaps; nothing else in the file changes
  mocap plot walk.c3d filled.c3d -o fill.svg
  mocap solve walk.c3d -o walk.bvh    markers into the motion of a skeleton

Files: C3D, TRC, CSV, TSV for markers; BVH and ASF/AMC for skeletons; each also with .gz.
Inputs are never overwritten, and an output appears whole or not at all."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Inspect(inspect::Inspect),
    Detect(detect::Detect),
    Fill(fill::Fill),
    Solve(solve::Solve),
    Plot(plot::Plot),
    Convert(convert::Convert),
    Occlude(occlude::Occlude),
    Score(score::Score),
    Bones(bones::Bones),
    Methods(methods::Methods),
    Synth(synth::Synth),
    Demo(demo::Demo),
}

fn main() -> ExitCode {
    let run = match Cli::parse().command {
        Command::Inspect(command) => command.run(),
        Command::Detect(command) => command.run(),
        Command::Fill(command) => command.run(),
        Command::Solve(command) => command.run(),
        Command::Plot(command) => command.run(),
        Command::Convert(command) => command.run(),
        Command::Occlude(command) => command.run(),
        Command::Score(command) => command.run(),
        Command::Bones(command) => command.run(),
        Command::Methods(command) => command.run(),
        Command::Synth(command) => command.run(),
        Command::Demo(command) => command.run(),
    };
    match run {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
