use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use mocap_core::Motion;
use mocap_io::{Format, LengthUnit, MotionFile, encode_markers, encode_motion};

use crate::files::{OutputArgs, ReadArgs};

/// Write a recording in another format; the same format gives identical bytes
///
/// Markers go between C3D, TRC, CSV and TSV; skeleton motion between BVH and ASF/AMC. Units and axes are kept, but for
/// ASF/AMC, which is written in inches times 0.45 as in CMU's database. With an AMC file its skeleton is written
/// beside it, under the same name with .asf.
#[derive(Debug, Args)]
pub(crate) struct Convert {
    /// File to read
    input: PathBuf,
    /// File to write; its extension chooses the format
    output: PathBuf,
    /// Replace the output if it exists
    #[arg(long)]
    force: bool,
    /// Skeleton of an AMC file; by default the ASF file beside it
    #[arg(long, value_name = "FILE")]
    asf: Option<PathBuf>,
    #[command(flatten)]
    read: ReadArgs,
}

impl Convert {
    pub(crate) fn run(self) -> Result<()> {
        let output = OutputArgs::new(self.output, self.force);
        let inputs: Vec<&Path> = [Some(&self.input), self.asf.as_ref()]
            .into_iter()
            .flatten()
            .map(PathBuf::as_path)
            .collect();
        output.check(&inputs)?;
        let to = Format::of(&output.output)
            .with_context(|| format!("{}: unknown extension", output.output.display()))?;
        let from = Format::of(&self.input);
        let bytes = if from.is_some_and(Format::holds_markers) {
            let file = self.read.read(&self.input)?;
            if from == Some(to) {
                file.patched(&[])?
            } else {
                let info = file.info();
                encode_markers(file.take(), to, info.unit, info.first_frame)?
            }
        } else {
            let file = MotionFile::read(&self.input, self.asf.as_deref(), &self.read.options())?;
            if from == Some(to) {
                file.bytes().to_vec()
            } else {
                let bytes = encode_motion(file.motion(), to, file.info().unit)?;
                if to == Format::Amc {
                    skeleton_beside(&output, &inputs, file.motion())?;
                }
                bytes
            }
        };
        output.write(&bytes)
    }
}

/// Writes the ASF file that goes with an AMC file.
pub(crate) fn skeleton_beside(
    output: &OutputArgs,
    inputs: &[&Path],
    motion: &Motion,
) -> Result<PathBuf> {
    let asf = output.named(&output.output.with_extension(Format::Asf.extension()));
    asf.check(inputs)?;
    asf.write(&encode_motion(motion, Format::Asf, LengthUnit::Inch)?)?;
    Ok(asf.output)
}
