//! The benchmark matrix, run by the program `mocap-repro`.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::Result;
use clap::{Args, ValueEnum};

use crate::{process, setup};

/// Rebuild a paper's tables and figures, ours beside the published figures
///
/// Goes on where it was if it is stopped and started again.
#[derive(Args)]
pub struct Paper {
    /// Which results to rebuild
    #[arg(value_enum, default_value = "bolero")]
    which: Which,
    #[command(flatten)]
    options: Options,
}

#[derive(Clone, Copy, ValueEnum)]
enum Which {
    Bolero,
    Localmocap,
    Leaderboard,
}

/// Rank all methods on the same gaps
///
/// Goes on where it was if it is stopped and started again.
#[derive(Args)]
pub struct Board {
    /// Rules by which gaps are cut: bolero-90, multi, limb, blackout, realistic; or pseudo-gaps, on which
    /// parameters may be chosen; or raw, recordings with gaps of their own [default: all but the last two]
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    protocol: Vec<String>,
    #[command(flatten)]
    options: Options,
}

#[derive(Args)]
struct Options {
    /// A small matrix on the project's own recordings, in seconds; needs no data
    #[arg(long)]
    quick: bool,
    /// Folder with the recordings [default: the variable `MOCAP_DATA`]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder for the results [default: out/bolero or out/leaderboard]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Methods [default: all of the registry]; `bolero-sc+lambda=100` sets an option
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    methods: Vec<String>,
    /// Install what is missing without asking
    #[arg(short, long)]
    yes: bool,
    /// More options for `mocap-repro`, such as `--threads 2 --coordinates world`
    #[arg(last = true)]
    more: Vec<String>,
}

/// The code of a task that cannot be done yet, told apart from one that failed.
const NOT_YET: u8 = 2;

/// Compare the synthetic people with captured ones
///
/// Joint angles, speeds, accelerations and bones by activity; tables, figures and a web page.
#[derive(Args)]
pub struct Synth {
    /// Folder with the recordings [default: the variable `MOCAP_DATA`]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder for the results [default: out/synth-report]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Install what is missing without asking
    #[arg(short, long)]
    yes: bool,
}

/// Runs the comparison.
pub fn synth(root: &Path, synth: &Synth) -> Result<ExitCode> {
    let Synth { data, out, yes } = synth;
    let options = Options {
        data: data.clone(),
        out: out.clone(),
        yes: *yes,
        quick: false,
        methods: Vec::new(),
        more: Vec::new(),
    };
    run(root, "synth-report", &options, &[])
}

/// Runs the evaluation of a paper.
pub fn paper(root: &Path, paper: &Paper) -> Result<ExitCode> {
    match paper.which {
        Which::Bolero => run(root, "bolero", &paper.options, &[]),
        Which::Leaderboard => run(root, "leaderboard", &paper.options, &[]),
        Which::Localmocap => {
            eprintln!(
                "reproduce-paper localmocap: not yet: its networks are not in this workspace. \
                 `cargo xtask leaderboard` ranks the methods that are."
            );
            Ok(ExitCode::from(NOT_YET))
        }
    }
}

/// Runs the leader board.
pub fn leaderboard(root: &Path, board: &Board) -> Result<ExitCode> {
    let is_raw = |protocol: &&String| protocol.as_str() == RAW;
    let cut: Vec<String> = board.protocol.iter().filter(|p| !is_raw(p)).cloned().collect();
    if !board.protocol.iter().any(|p| is_raw(&p)) {
        return run(root, "leaderboard", &board.options, &cut);
    }
    if !cut.is_empty() {
        run(root, "leaderboard", &board.options, &cut)?;
    }
    run(root, RAW, &board.options, &[])
}

/// The protocol that cuts no gaps; a task of its own.
const RAW: &str = "raw";

fn run(root: &Path, task: &str, options: &Options, protocols: &[String]) -> Result<ExitCode> {
    setup::ensure(options.yes)?;
    let mut command = process::cargo(root);
    command.args(["run", "--release", "--package", "mocap-repro", "--", task]);
    command.args(arguments(root, task, options)?);
    if !protocols.is_empty() {
        command.args(["--protocol", &protocols.join(",")]);
    }
    process::run(&mut command)?;
    Ok(ExitCode::SUCCESS)
}

/// Paths are made absolute, as the program runs at the root of the workspace.
fn arguments(root: &Path, task: &str, options: &Options) -> Result<Vec<std::ffi::OsString>> {
    let out = match &options.out {
        Some(out) => std::path::absolute(out)?,
        None => root.join("out").join(task),
    };
    let mut arguments = vec!["--out".into(), out.into()];
    if options.quick {
        arguments.push("--quick".into());
    }
    if let Some(data) = &options.data {
        arguments.extend(["--data".into(), std::path::absolute(data)?.into()]);
    }
    if !options.methods.is_empty() {
        arguments.extend(["--methods".into(), options.methods.join(",").into()]);
    }
    arguments.extend(options.more.iter().map(Into::into));
    Ok(arguments)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options() -> Options {
        Options {
            quick: false,
            data: None,
            out: None,
            methods: Vec::new(),
            yes: false,
            more: Vec::new(),
        }
    }

    #[test]
    fn results_go_below_the_root_by_default() {
        let arguments =
            arguments(Path::new("root"), "bolero", &options()).expect("no path is given");
        assert_eq!(arguments, ["--out", "root/out/bolero"]);
    }

    #[test]
    fn options_are_handed_on_and_paths_made_absolute() {
        let options = Options {
            quick: true,
            data: Some("data".into()),
            out: Some("results".into()),
            methods: vec!["lds".into(), "ridge".into()],
            more: vec!["--threads".into(), "2".into()],
            ..options()
        };
        let arguments = arguments(Path::new("root"), "bolero", &options).expect("paths are short");
        assert!(Path::new(&arguments[1]).is_absolute() && Path::new(&arguments[4]).is_absolute());
        assert_eq!(arguments[2], "--quick");
        assert_eq!(arguments[5..], ["--methods", "lds,ridge", "--threads", "2"]);
    }
}
