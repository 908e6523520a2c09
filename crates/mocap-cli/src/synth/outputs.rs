//! What else is written of a synthetic take.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use mocap_core::{Motion, Take, UpAxis};
use mocap_io::{Format, LengthUnit, encode_markers, encode_motion};
use mocap_report::{FigureFormat, MotionPlot, animate_motion, plot_motion};
use mocap_synth::SyntheticTake;

use crate::{
    convert::skeleton_beside,
    files::OutputArgs,
    solve::{is_json, lie_down, motion_json},
};

#[derive(Debug, Args)]
#[command(next_help_heading = "Truth and pictures")]
pub(super) struct Outputs {
    /// Write where the markers really were, without noise and gaps (.c3d, .trc, .csv, .tsv)
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// Write the true motion of the skeleton (.bvh, .amc with its .asf, .json)
    #[arg(long, value_name = "FILE")]
    joints: Option<PathBuf>,
    /// Draw skeleton and markers at six moments, and how far soft tissue moves them (.svg, .png)
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Draw an animation that browsers play (.svg)
    #[arg(long, value_name = "FILE")]
    animate: Option<PathBuf>,
}

impl Outputs {
    /// Refuses what cannot be written.
    pub(super) fn check(&self, output: &OutputArgs, inputs: &[&Path]) -> Result<()> {
        let all = [&self.truth, &self.joints, &self.plot, &self.animate];
        for path in all.into_iter().flatten() {
            if *path == output.output {
                bail!("{} is named twice; give each output its own name", path.display());
            }
            output.named(path).check(inputs)?;
        }
        if let Some(path) = &self.truth
            && !Format::of(path).is_some_and(Format::holds_markers)
        {
            bail!("{}: markers go into .c3d, .trc, .csv or .tsv files", path.display());
        }
        if let Some(path) = &self.joints
            && !is_json(path)
            && Format::of(path).is_none_or(Format::holds_markers)
        {
            bail!("{}: joint motion goes into .bvh, .amc, .asf or .json", path.display());
        }
        if let Some(path) = &self.plot {
            FigureFormat::from_path(path)?;
        }
        if let Some(path) = &self.animate
            && FigureFormat::from_path(path)? != FigureFormat::Svg
        {
            bail!("{}: an animation is an .svg file", path.display());
        }
        Ok(())
    }

    /// Writes them all; `take` is what the cameras saw.
    pub(super) fn write(
        &self,
        output: &OutputArgs,
        title: &str,
        recorded: &SyntheticTake,
        take: &Take,
    ) -> Result<()> {
        if let Some(path) = &self.truth {
            let format = Format::of(path).context("the extension was checked")?;
            let bytes = encode_markers(recorded.truth(), format, LengthUnit::Millimetre, 1)?;
            output.named(path).write(&bytes)?;
        }
        if let Some(path) = &self.joints {
            joints(&output.named(path), recorded.motion())?;
        }
        let plot = MotionPlot {
            title,
            motion: recorded.motion(),
            take,
            residual_m: recorded.sliding_m(),
            up: UpAxis::Z,
        };
        if let Some(path) = &self.plot {
            output.named(path).write(&plot_motion(&plot, path)?)?;
        }
        if let Some(path) = &self.animate {
            output.named(path).write(&animate_motion(&plot)?)?;
        }
        Ok(())
    }
}

fn joints(output: &OutputArgs, motion: &Motion) -> Result<()> {
    if is_json(&output.output) {
        return output.write(&serde_json::to_vec(&motion_json(motion)?)?);
    }
    let format = Format::of(&output.output).context("the extension was checked")?;
    let motion = lie_down(motion)?;
    let bytes = encode_motion(&motion, format, LengthUnit::Centimetre)?;
    if format == Format::Amc {
        skeleton_beside(output, &[], &motion)?;
    }
    output.write(&bytes)
}
