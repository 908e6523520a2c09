//! Runs the benchmark matrix and writes its tables and figures.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command-line program")]

use std::{
    collections::BTreeSet,
    fs,
    io::IsTerminal,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result};
use clap::{Args, Parser, Subcommand, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use mocap_repro::{
    Coordinates, Knowledge, Matrix, Motion, Motions, Progress, Protocol, Report, Store, Trial,
    Variant, bolero_report, bolero_trials, fixture_trials, leaderboard_report, leaderboard_trials,
    run,
};

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
}

/// The evaluation of the BoLeRO paper: case studies, 90 trials, tables and figures
#[derive(Args)]
struct Bolero {
    /// Coordinates to run in; may be given several times [default: body]
    #[arg(long, value_enum)]
    coordinates: Vec<Frame>,
    #[command(flatten)]
    common: Common,
}

/// Every method on the protocols of the leader board
#[derive(Args)]
struct Leaderboard {
    /// bolero-90, multi, limb or blackout; may be given several times [default: all]
    #[arg(long)]
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
    /// Iterations at most [default: 100, or 20 with --quick]
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
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

impl Bolero {
    fn run(&self) -> Result<()> {
        let common = &self.common;
        let variants = Variant::parse_list(&common.methods)?;
        let (trials, folder) = if common.quick {
            (fixture_trials(), fixtures())
        } else {
            let data = common.data()?;
            (bolero_trials(&data)?, recordings(&data))
        };
        let motions = Motion::read_all(&folder, trials.iter().map(|t| t.motion.as_str()))?;
        let coordinates = match self.coordinates.as_slice() {
            [] => vec![Coordinates::Body],
            some => some.iter().map(|frame| Coordinates::from(*frame)).collect(),
        };
        let matrix = Matrix {
            trials,
            motions,
            variants,
            coordinates,
            knowledge: vec![Knowledge::Oracle, Knowledge::Visible],
            iterations: Some(common.iterations()),
        };
        common.execute(&matrix, "bolero", bolero_report)
    }
}

impl Leaderboard {
    fn run(&self) -> Result<()> {
        let common = &self.common;
        let variants = Variant::parse_list(&common.methods)?;
        let protocols = if self.protocol.is_empty() {
            Protocol::ALL.to_vec()
        } else {
            self.protocol.iter().map(|text| text.parse()).collect::<Result<_, _>>()?
        };
        let (trials, motions) = if common.quick {
            quick_board(&protocols)?
        } else {
            full_board(&protocols, &common.data()?)?
        };
        let matrix = Matrix {
            trials,
            motions,
            variants,
            coordinates: vec![Coordinates::Own],
            knowledge: vec![Knowledge::Visible],
            iterations: Some(common.iterations()),
        };
        common.execute(&matrix, "leaderboard", leaderboard_report)
    }
}

fn full_board(protocols: &[Protocol], data: &Path) -> Result<(Vec<Trial>, Motions)> {
    let folder = recordings(data);
    let names: BTreeSet<String> =
        bolero_trials(data)?.into_iter().map(|trial| trial.motion).collect();
    let motions = Motion::read_all(&folder, names.iter().map(String::as_str))?;
    let mut trials = Vec::new();
    for &protocol in protocols {
        trials.extend(leaderboard_trials(protocol, data, &motions)?);
    }
    Ok((trials, motions))
}

/// The short gaps of each protocol on two recordings; the fixtures' own list stands for `bolero-90`.
fn quick_board(protocols: &[Protocol]) -> Result<(Vec<Trial>, Motions)> {
    let motions = Motion::read_all(&fixtures(), ["run", "throw", "walk", "jump"])?;
    let two: Motions =
        motions.iter().filter(|(name, _)| *name == "run" || *name == "throw").map(clone).collect();
    let mut trials = Vec::new();
    for &protocol in protocols {
        if protocol == Protocol::Bolero90 {
            trials.extend(fixture_trials());
        } else {
            let all = leaderboard_trials(protocol, Path::new(""), &two)?;
            trials.extend(all.into_iter().filter(|trial| !trial.class.ends_with(", 2 s")));
        }
    }
    Ok((trials, motions))
}

fn clone<A: Clone, B: Clone>((a, b): (&A, &B)) -> (A, B) {
    (a.clone(), b.clone())
}

impl Common {
    fn data(&self) -> Result<PathBuf> {
        self.data.clone().or_else(|| std::env::var_os("MOCAP_DATA").map(PathBuf::from)).context(
            "no recordings: name their folder with --data DIR or in the variable MOCAP_DATA, or run \
             with --quick on the project's own",
        )
    }

    fn iterations(&self) -> usize {
        self.iterations.map_or(if self.quick { 20 } else { 100 }, std::num::NonZero::get)
    }

    fn execute(
        &self,
        matrix: &Matrix,
        name: &str,
        report: impl Fn(&[mocap_repro::Finished<'_>]) -> Report,
    ) -> Result<()> {
        matrix.check()?;
        fs::create_dir_all(&self.out)
            .with_context(|| format!("cannot make the folder {}", self.out.display()))?;
        let mut store = Store::open(&self.out.join("cells.jsonl"))?;
        if store.dropped() > 0 {
            eprintln!("{} broken lines of the cells file: computed again", store.dropped());
        }
        let threads = self.threads.or_else(|| std::thread::available_parallelism().ok());
        let bar = bar();
        let show = |progress: Progress| {
            bar.set_length(progress.total as u64);
            bar.set_position(progress.done as u64);
        };
        let cells = run(matrix, &mut store, threads.map_or(1, std::num::NonZero::get), &show)?;
        bar.finish_and_clear();
        let report = report(&cells);
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

fn recordings(data: &Path) -> PathBuf {
    data.join("cmu/bolero-nine")
}

/// The synthetic recordings of this workspace.
fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures")
}

/// A bar on a terminal, nothing elsewhere; its unit is a frame, as long takes take longer.
fn bar() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {percent} %  {elapsed} gone, {eta} to go")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(0).with_style(style)
}
