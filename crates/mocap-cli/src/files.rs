//! Reading and writing files the way every command does it.

use std::{
    ops::Range,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, bail};
use clap::Args;
use mocap_core::Take;
use mocap_io::{LengthUnit, MarkerFile, ReadOptions, write_atomic};

/// How to read the input, for files that leave something open.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Reading")]
pub(crate) struct ReadArgs {
    /// Sampling rate in Hz, for files that state none (CSV)
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Unit of length, for files that state none: m, cm, mm, in, ft
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    unit: Option<LengthUnit>,
    /// Read what is there of a file that is cut off
    #[arg(long)]
    salvage: bool,
    /// Take a marker at exactly (0, 0, 0) as measured, not as missing
    #[arg(long)]
    zeros_are_data: bool,
}

fn unit(text: &str) -> Result<LengthUnit, String> {
    LengthUnit::parse(text).ok_or_else(|| format!("`{text}` is none of m, cm, mm, in, ft"))
}

impl ReadArgs {
    /// The options of the reader.
    pub(crate) fn options(&self) -> ReadOptions {
        ReadOptions {
            salvage: self.salvage,
            rate_hz: self.rate,
            unit: self.unit,
            zero_is_position: self.zeros_are_data,
        }
    }

    /// Reads a marker file.
    pub(crate) fn read(&self, path: &Path) -> Result<MarkerFile> {
        Ok(MarkerFile::read(path, &self.options())?)
    }
}

/// Where to write the result.
#[derive(Debug, Clone, Args)]
pub(crate) struct OutputArgs {
    /// File to write; its extension chooses the format
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Replace the output if it exists (an input is never replaced)
    #[arg(long)]
    force: bool,
}

impl OutputArgs {
    /// An output named otherwise than by `-o`.
    pub(crate) fn new(output: PathBuf, force: bool) -> Self {
        Self { output, force }
    }

    /// Another output that may replace a file if this one may.
    pub(crate) fn named(&self, output: &Path) -> Self {
        Self { output: output.to_owned(), force: self.force }
    }

    /// Refuses an output that is one of the inputs, or that exists when it may not be replaced, before any work is done.
    pub(crate) fn check(&self, inputs: &[&Path]) -> Result<()> {
        for input in inputs {
            if same_file(input, &self.output) {
                bail!("{} is an input; an input is never overwritten", self.output.display());
            }
        }
        if self.output.exists() && !self.force {
            bail!("{} exists; choose another name or add --force", self.output.display());
        }
        Ok(())
    }

    /// Writes the output.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<()> {
        Ok(write_atomic(&self.output, bytes, self.force)?)
    }

    /// Writes a file that goes with the output: its name with `suffix` appended.
    pub(crate) fn write_beside(&self, suffix: &str, bytes: &[u8]) -> Result<PathBuf> {
        let mut name = self.output.clone().into_os_string();
        name.push(suffix);
        let path = PathBuf::from(name);
        write_atomic(&path, bytes, self.force)?;
        Ok(path)
    }

    /// The same checks for a file that goes with the output.
    pub(crate) fn check_beside(&self, suffix: &str) -> Result<()> {
        let mut name = self.output.clone().into_os_string();
        name.push(suffix);
        let path = PathBuf::from(name);
        if path.exists() && !self.force {
            bail!("{} exists; remove it or add --force", path.display());
        }
        Ok(())
    }
}

/// Whether two paths lead to one file, through links or not.
pub(crate) fn same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Creates a folder for results.
pub(crate) fn create_folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).with_context(|| format!("cannot create {}", path.display()))
}

/// Zero-based frames from a range `A..B` of the file's own frame numbers, both included.
pub(crate) fn frames(text: &str, first_frame: i64, take: &Take) -> Result<Range<usize>> {
    let last_frame = first_frame + i64::try_from(take.frames())? - 1;
    let parse = |s: &str| s.trim().parse::<i64>();
    let numbers = text.split_once("..").map(|(a, b)| (parse(a), parse(b.trim_start_matches('='))));
    let Some((Ok(start), Ok(end))) = numbers else {
        bail!("`{text}` is no range of frames; write it as 25..90, both ends included");
    };
    if start > end || start < first_frame || end > last_frame {
        bail!("frames {start}..{end} do not lie in the take's {first_frame}..{last_frame}");
    }
    Ok(usize::try_from(start - first_frame)?..usize::try_from(end - first_frame + 1)?)
}
