use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use mocap_io::{Format, LengthUnit, encode_markers};
use mocap_synth::Activity;

use crate::files::OutputArgs;

/// Make a synthetic recording of a moving body with 41 markers
#[derive(Debug, Args)]
pub(crate) struct Synth {
    /// What the body does: walk, run, jump or throw
    #[arg(long)]
    motion: Activity,
    /// Number of frames
    #[arg(long, default_value_t = 300)]
    frames: usize,
    /// Sampling rate in Hz
    #[arg(long, default_value_t = 120.0)]
    rate: f64,
    /// Seed of body, motion and noise: the same seed gives the same file
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    output: OutputArgs,
}

impl Synth {
    pub(crate) fn run(self) -> Result<()> {
        self.output.check(&[])?;
        let path: &PathBuf = &self.output.output;
        let format =
            Format::of(path).with_context(|| format!("{}: unknown extension", path.display()))?;
        let take = make(self.motion, self.frames, self.rate, self.seed)?;
        self.output.write(&encode_markers(&take, format, LengthUnit::Millimetre, 1)?)
    }
}

/// A complete synthetic take.
pub(crate) fn make(
    activity: Activity,
    frames: usize,
    rate_hz: f64,
    seed: u64,
) -> Result<mocap_core::Take> {
    let params =
        mocap_synth::SynthParams { motion: activity, frames, rate_hz, seed, ..Default::default() };
    Ok(mocap_synth::Synth::new(params)?.take()?.into_take())
}
