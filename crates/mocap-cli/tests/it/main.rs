//! The command as its users run it.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // tests

mod bytes;
mod contract;
mod detect;
mod real;
mod safety;
mod solve;
mod synth;

use std::{
    path::{Path, PathBuf},
    process::{Command, Output},
};

/// A folder of its own and the command to run in it.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    /// Runs the command line, split at spaces.
    fn run(&self, line: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_mocap"))
            .args(line.split_whitespace())
            .current_dir(self.folder.path())
            .output()
            .unwrap()
    }

    /// Runs a command that has to succeed, and gives its standard output.
    fn ok(&self, line: &str) -> String {
        let output = self.run(line);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "`mocap {line}` failed: {error}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs a command that has to fail, and gives its standard error.
    fn fails(&self, line: &str) -> String {
        let output = self.run(line);
        assert!(!output.status.success(), "`mocap {line}` did not fail");
        String::from_utf8(output.stderr).unwrap()
    }

    /// Runs a command that has to succeed, and gives its output as JSON.
    fn json(&self, line: &str) -> serde_json::Value {
        serde_json::from_str(&self.ok(line)).unwrap()
    }

    /// A walk of 200 frames, and the same with the right knee and shin hidden in frames 60 to 90.
    fn with_gap(extension: &str) -> Self {
        let bench = Self::new();
        bench.ok(&format!("synth --motion walk --frames 200 --seed 3 -o walk.{extension}"));
        bench.ok(&format!(
            "occlude walk.{extension} -o gap.{extension} --marker RKNE --marker RSHN --frames 60..90"
        ));
        bench
    }
}

fn exists(path: &Path) -> bool {
    path.exists()
}
