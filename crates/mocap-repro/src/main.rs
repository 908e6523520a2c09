//! Runs the benchmark matrix and writes its tables and figures.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command-line program")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result};
use clap::{Args, Parser, Subcommand, ValueEnum};
use mocap_repro::{
    Coordinates, Evaluation, Knowledge, Matrix, Motion, Motions, Protocol, Report, Store, Trial,
    Variant, bolero_report, fixture_trials, leaderboard_report, protocol_trials, run,
};

mod meter;
mod raw_task;
mod synth_task;

use meter::Meter;
use raw_task::Raw;
use synth_task::SynthReport;

/// Runs every gap-filling method on the same gaps, and sets the results beside the published ones.
///
/// A run that was stopped goes on where it was when it is started again with the same --out.
#[derive(Parser)]
#[command(name = "mocap-repro", version = mocap_repro::VERSION, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    Bolero(Bolero),
    Leaderboard(Leaderboard),
    Raw(Raw),
    SynthReport(SynthReport),
}

/// The evaluation of the BoLeRO paper: case studies, 90 trials twice over, sweeps, tables and figures
///
/// Without --methods: every method of the registry, and bolero-sc without bones.
#[derive(Args)]
struct Bolero {
    /// Coordinates to run in; may be given several times [default: body]
    #[arg(long, value_enum)]
    coordinates: Vec<Frame>,
    #[command(flatten)]
    common: Common,
}

/// Every method on the protocols of the leader board
///
/// `pseudo-gaps` is no part of the board: it is the protocol on which parameters may be chosen, for
/// instance with --protocol pseudo-gaps --methods ridge,bolero-sc+lambda=1e4,bolero-sc+lambda=1e6.
#[derive(Args)]
struct Leaderboard {
    /// bolero-90, multi, limb, blackout, realistic or pseudo-gaps; several with commas between
    /// [default: all but pseudo-gaps]
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    protocol: Vec<String>,
    #[command(flatten)]
    common: Common,
}

#[derive(Args)]
struct Common {
    /// Folder with the recordings [default: the variable `MOCAP_DATA`]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// A small matrix on the project's own synthetic recordings; needs no data
    #[arg(long)]
    quick: bool,
    /// Cells computed at a time; no result depends on it [default: all cores]
    #[arg(long, value_name = "N")]
    threads: Option<std::num::NonZeroUsize>,
    /// Methods, with commas between [default: all]; `bolero-sc+lambda=100` sets an option
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    methods: Vec<String>,
    /// Iterations at most [default: each method's own number, or 20 with --quick]
    #[arg(long, value_name = "N")]
    iterations: Option<std::num::NonZeroUsize>,
    /// Print the figures as JSON rather than as tables
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Frame {
    Body,
    World,
}

fn main() -> ExitCode {
    let done = match Cli::parse().task {
        Task::Bolero(task) => task.run(),
        Task::Leaderboard(task) => task.run(),
        Task::Raw(task) => task.run(),
        Task::SynthReport(task) => task.run(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// Beside the methods as they come: those of the paper with all its settings, and the soft bone lengths without
/// bones, which show what of a result is due to the bones.
const ALSO: [&str; 5] = [
    "dynammo+published",
    "bolero-sc+published+lambda=0",
    "bolero-sc+published",
    "bolero-hc+published",
    "bolero-sc+lambda=0",
];

impl Bolero {
    fn run(&self) -> Result<()> {
        let common = &self.common;
        let mut variants = Variant::parse_list(&common.methods)?;
        if common.methods.is_empty() {
            for text in ALSO {
                variants.push(Variant::parse(text)?);
            }
        }
        let evaluation = if common.quick {
            Evaluation::of_fixtures(&fixtures())?
        } else {
            Evaluation::of_paper(&common.data()?)?
        };
        let coordinates = match self.coordinates.as_slice() {
            [] => vec![Coordinates::Body],
            some => some.iter().map(|frame| Coordinates::from(*frame)).collect(),
        };
        let iterations = common.iterations();
        let matrices = evaluation.matrices(&variants, &coordinates, iterations);
        common.execute(&matrices, "bolero", |cells| {
            Ok(bolero_report(&evaluation, &variants, iterations, cells)?)
        })
    }
}

impl Leaderboard {
    fn run(&self) -> Result<()> {
        let common = &self.common;
        let variants = Variant::parse_list(&common.methods)?;
        let protocols = if self.protocol.is_empty() {
            Protocol::BOARD.to_vec()
        } else {
            self.protocol.iter().map(|text| text.trim().parse()).collect::<Result<_, _>>()?
        };
        let matrix = |(trials, motions): (Vec<Trial>, Motions)| Matrix {
            trials,
            motions,
            variants: variants.clone(),
            coordinates: vec![Coordinates::Own],
            knowledge: vec![Knowledge::Visible],
            iterations: common.iterations(),
        };
        let cut = |protocol: &Protocol| {
            if common.quick {
                quick_board(*protocol)
            } else {
                full_board(*protocol, &common.data()?)
            }
        };
        let matrices = protocols.iter().map(|protocol| Ok(matrix(cut(protocol)?)));
        let matrices = matrices.collect::<Result<Vec<_>>>()?;
        common.execute(&matrices, "leaderboard", |cells| Ok(leaderboard_report(cells)))
    }
}

fn full_board(protocol: Protocol, data: &Path) -> Result<(Vec<Trial>, Motions)> {
    let motions = if protocol == Protocol::PseudoGaps {
        Motion::read_aside(data)?
    } else {
        let listed = protocol_trials(Protocol::Bolero90, data, &Motions::new())?;
        let names = listed.iter().map(|trial| trial.motion.as_str());
        Motion::read_all(&data.join("cmu/bolero-nine"), names)?
    };
    Ok((protocol_trials(protocol, data, &motions)?, motions))
}

/// The short gaps of each protocol on two recordings; the fixtures' own list stands for `bolero-90`.
fn quick_board(protocol: Protocol) -> Result<(Vec<Trial>, Motions)> {
    if protocol == Protocol::Bolero90 {
        let trials = fixture_trials();
        let motions = Motion::read_all(&fixtures(), trials.iter().map(|t| t.motion.as_str()))?;
        return Ok((trials, motions));
    }
    let names = if protocol == Protocol::PseudoGaps { ["walk", "jump"] } else { ["run", "throw"] };
    let motions = Motion::read_all(&fixtures(), names)?;
    let mut trials = protocol_trials(protocol, Path::new(""), &motions)?;
    trials.retain(|trial| !trial.class.ends_with(", 2 s"));
    Ok((trials, motions))
}

impl Common {
    fn data(&self) -> Result<PathBuf> {
        self.data.clone().or_else(|| std::env::var_os("MOCAP_DATA").map(PathBuf::from)).context(
            "no recordings: name their folder with --data DIR or in the variable MOCAP_DATA, or run \
             with --quick on the project's own",
        )
    }

    /// Iterations at most; `None`: each method's own number.
    fn iterations(&self) -> Option<usize> {
        self.iterations.map(std::num::NonZero::get).or(self.quick.then_some(20))
    }

    fn execute(
        &self,
        matrices: &[Matrix],
        name: &str,
        report: impl Fn(&[mocap_repro::Finished<'_>]) -> Result<Report>,
    ) -> Result<()> {
        matrices.iter().try_for_each(Matrix::check)?;
        fs::create_dir_all(&self.out)
            .with_context(|| format!("cannot make the folder {}", self.out.display()))?;
        let mut store = Store::open(&self.out.join("cells.jsonl"))?;
        if store.dropped() > 0 {
            eprintln!("{} broken lines of the cells file: computed again", store.dropped());
        }
        let threads = self.threads.or_else(|| std::thread::available_parallelism().ok());
        let meter = Meter::new();
        let threads = threads.map_or(1, std::num::NonZero::get);
        let cells = run(matrices, &mut store, threads, &|progress| meter.show(progress))?;
        meter.finish();
        let report = report(&cells)?;
        let [markdown, page] = report.write(&self.out, name)?;
        if self.json {
            println!("{:#}", report.to_json());
        } else {
            print!("{}", report.to_markdown());
        }
        eprintln!("tables: {}\nweb page: {}", markdown.display(), page.display());
        Ok(())
    }
}

impl From<Frame> for Coordinates {
    fn from(frame: Frame) -> Self {
        match frame {
            Frame::Body => Self::Body,
            Frame::World => Self::World,
        }
    }
}

/// The synthetic recordings of this workspace.
fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures")
}
