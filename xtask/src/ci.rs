//! Every check, in one command: what people run before a change and `.ci/run` runs after it.

use std::{
    env, fs,
    io::{BufRead, BufReader},
    path::Path,
    process::{Command, ExitCode, ExitStatus, Stdio},
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail};
use clap::Args;

use crate::{fixtures, process, setup, tidy};

/// Run every check and test
///
/// Sets the machine up, then: format, tidy, clippy, fixtures, tests (unit, integration and
/// documentation), documentation, a run of the demo and of the benchmark matrix, and cargo-deny where it is installed. Goes on after
/// a failure, so that one run shows everything; fails if any step did.
#[derive(Args)]
pub struct Options {
    /// Leave out what needs a release build, and the documentation
    #[arg(long)]
    quick: bool,
    /// Install what is missing without asking
    #[arg(short, long)]
    yes: bool,
}

/// What a step came to.
enum Outcome {
    Passed,
    Skipped(&'static str),
    Failed(anyhow::Error),
}

/// Tests counted over all test programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Count {
    passed: u64,
    failed: u64,
}

struct Session<'a> {
    root: &'a Path,
    count: Count,
    steps: Vec<(&'static str, Outcome, Duration)>,
}

/// Runs the steps, prints a table of them, and last the number of tests that passed and failed.
pub fn run(root: &Path, options: &Options) -> ExitCode {
    let mut session = Session { root, count: Count::default(), steps: Vec::new() };
    if session.step("setup", |_| setup::ensure(options.yes).map(|()| Outcome::Passed)) {
        session.check(options.quick);
    }
    if session.report() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

impl Session<'_> {
    fn check(&mut self, quick: bool) {
        self.cargo("fmt", &["fmt", "--all", "--check"]);
        self.step("tidy", |session| tidy::run(session.root).map(|()| Outcome::Passed));
        self.cargo(
            "clippy",
            &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"],
        );
        self.step("test", |session| session.test(quick));
        if quick {
            return;
        }
        self.step("doc", |session| {
            let mut doc = process::cargo(session.root);
            doc.args(["doc", "--workspace", "--no-deps", "--locked"]);
            process::run(doc.env("RUSTDOCFLAGS", "-D warnings")).map(|()| Outcome::Passed)
        });
        self.step("fixtures", |session| fixtures::check(session.root).map(|()| Outcome::Passed));
        self.step("demo", |session| demo(session.root).map(|()| Outcome::Passed));
        self.step("reproduce", |session| reproduce(session.root).map(|()| Outcome::Passed));
        self.step("deny", |session| deny(session.root));
    }

    fn cargo(&mut self, name: &'static str, args: &[&str]) {
        self.step(name, |session| {
            process::run(process::cargo(session.root).args(args)).map(|()| Outcome::Passed)
        });
    }

    /// Runs one step and says whether it passed.
    fn step(
        &mut self,
        name: &'static str,
        work: impl FnOnce(&mut Self) -> Result<Outcome>,
    ) -> bool {
        println!("\n== {name}");
        let start = Instant::now();
        let outcome = work(self).unwrap_or_else(Outcome::Failed);
        let time = start.elapsed();
        match &outcome {
            Outcome::Passed => println!("== {name}: passed in {:.1} s", time.as_secs_f64()),
            Outcome::Skipped(why) => println!("== {name}: skipped: {why}"),
            Outcome::Failed(error) => println!("== {name}: FAILED: {error:#}"),
        }
        let passed = !matches!(outcome, Outcome::Failed(_));
        self.steps.push((name, outcome, time));
        passed
    }

    /// Runs the tests with their output shown, and adds up their result lines.
    fn test(&mut self, quick: bool) -> Result<Outcome> {
        let mut command = process::cargo(self.root);
        command.args(["test", "--workspace", "--locked", "--no-fail-fast"]);
        // An unchanged tree gets an unchanged verdict; `cargo test` draws new cases each time.
        command.env(
            "PROPTEST_RNG_SEED",
            env::var("PROPTEST_RNG_SEED").unwrap_or_else(|_| "20".into()),
        );
        if quick {
            command.args(["--lib", "--bins", "--tests"]);
        }
        match env::var_os("MOCAP_DATA") {
            Some(folder) => println!("real recordings: {}", folder.display()),
            None => println!("MOCAP_DATA is not set: tests on real recordings skip, see README.md"),
        }
        let shown = process::display(&command);
        println!("$ {shown}");
        let (count, status) = run_and_count(&mut command)?;
        self.count = count;
        if !status.success() {
            bail!("`{shown}` ended with {status}");
        }
        if count.passed == 0 {
            bail!("`{shown}` ran no test at all");
        }
        Ok(Outcome::Passed)
    }

    /// Prints the table; the count of tests is the last line, for programs that read this output.
    fn report(&self) -> bool {
        println!("\n{:<10} {:<8} {:>8}", "step", "outcome", "seconds");
        let mut failed = Vec::new();
        for (name, outcome, time) in &self.steps {
            let word = match outcome {
                Outcome::Passed => "passed",
                Outcome::Skipped(_) => "skipped",
                Outcome::Failed(_) => {
                    failed.push(*name);
                    "FAILED"
                }
            };
            println!("{name:<10} {word:<8} {:>8.1}", time.as_secs_f64());
        }
        if !failed.is_empty() {
            println!("\nfailed steps: {}", failed.join(", "));
        }
        println!("\n{} passed, {} failed", self.count.passed, self.count.failed);
        failed.is_empty()
    }
}

/// Runs `cargo test`, passing its output on line by line.
fn run_and_count(command: &mut Command) -> Result<(Count, ExitStatus)> {
    let mut child = command.stdout(Stdio::piped()).spawn().context("cannot start cargo")?;
    let mut count = Count::default();
    for line in child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines) {
        let line = line.context("cannot read the output of cargo")?;
        println!("{line}");
        count.add(&line);
    }
    Ok((count, child.wait()?))
}

impl Count {
    /// Adds a line such as `test result: ok. 7 passed; 0 failed; 1 ignored; …`; others count
    /// nothing.
    fn add(&mut self, line: &str) {
        let Some(result) = line.trim_start().strip_prefix("test result: ") else { return };
        let number_before = |word: &str| {
            let words = result.split([' ', ';']).filter(|text| !text.is_empty());
            words
                .clone()
                .zip(words.skip(1))
                .find_map(|(number, next)| (next == word).then(|| number.parse::<u64>().ok())?)
                .unwrap_or(0)
        };
        self.passed += number_before("passed");
        self.failed += number_before("failed");
    }
}

/// Runs the benchmark matrix on the sample recordings; its tables are written to files too.
fn reproduce(root: &Path) -> Result<()> {
    let output = root.join("target/ci-reproduce");
    if output.exists() {
        fs::remove_dir_all(&output)?;
    }
    ["bolero", "leaderboard"].into_iter().try_for_each(|task| {
        let mut matrix = process::cargo(root);
        matrix.args(["run", "--quiet", "--release", "--locked", "--package", "mocap-repro", "--"]);
        process::run(matrix.args([task, "--quick", "--out"]).arg(&output).stdout(Stdio::null()))
    })
}

/// Runs the demo and looks for its plot.
fn demo(root: &Path) -> Result<()> {
    let output = root.join("target/ci-demo");
    if output.exists() {
        fs::remove_dir_all(&output)?;
    }
    process::build_mocap(root)?;
    process::run(process::mocap(root).arg("demo").arg("-o").arg(&output))?;
    let is_plot = |path: &Path| path.extension().is_some_and(|end| end == "svg" || end == "png");
    let plots = fs::read_dir(&output)
        .with_context(|| format!("the demo left no folder {}", output.display()))?
        .filter_map(Result::ok)
        .filter(|entry| is_plot(&entry.path()) && entry.metadata().is_ok_and(|file| file.len() > 0))
        .count();
    if plots == 0 {
        bail!("the demo wrote no plot into {}", output.display());
    }
    Ok(())
}

/// Licences, sources and banned crates: what depends on this tree alone. A new advisory must not
/// turn an unchanged tree red, so those are asked for by hand, see CONTRIBUTING.md.
fn deny(root: &Path) -> Result<Outcome> {
    if !process::succeeds("cargo", &["deny", "--version"]) {
        return Ok(Outcome::Skipped(
            "cargo-deny is not installed (`cargo install --locked cargo-deny`)",
        ));
    }
    let checks = ["deny", "check", "bans", "licenses", "sources"];
    process::run(process::cargo(root).args(checks)).map(|()| Outcome::Passed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(lines: &[&str]) -> Count {
        let mut count = Count::default();
        for line in lines {
            count.add(line);
        }
        count
    }

    #[test]
    fn result_lines_are_added_up() {
        let lines = [
            "running 2 tests",
            "test result: ok. 41 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; \
             finished in 0.01s",
            "test result: FAILED. 1 passed; 3 failed; 0 ignored; 0 measured; 0 filtered out",
        ];
        assert_eq!(sum(&lines), Count { passed: 42, failed: 3 });
    }

    #[test]
    fn other_lines_count_nothing() {
        assert_eq!(sum(&["12 passed; 3 failed", "test a ... ok"]), Count::default());
    }

    #[test]
    fn a_step_that_fails_makes_the_report_fail() {
        let mut session = Session { root: Path::new("."), count: Count::default(), steps: vec![] };
        assert!(session.step("good", |_| Ok(Outcome::Passed)));
        assert!(session.report());
        assert!(!session.step("bad", |_| bail!("for the test")));
        assert!(!session.report());
    }

    #[test]
    fn the_exit_status_and_the_count_of_a_child_are_both_kept() {
        let mut child = Command::new("sh");
        child.args(["-c", "echo 'test result: FAILED. 2 passed; 1 failed; 0 ignored'; exit 101"]);
        let (count, status) = run_and_count(&mut child).expect("sh starts");
        assert_eq!(count, Count { passed: 2, failed: 1 });
        assert_eq!(status.code(), Some(101));
    }
}
