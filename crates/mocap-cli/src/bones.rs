use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use gapfill::Bones as Choice;
use mocap_io::write_bones;

use crate::{files::ReadArgs, marker_sets::MarkerSetArgs, say::say};

/// List the bones of a recording: marker pairs a fixed distance apart, with their lengths
///
/// Pairs come from known marker sets (CMU 41, Plug-in Gait names), else from distances that hardly change. Lengths are means
/// over the visible samples. The output is a file for `mocap fill --bones`.
#[derive(Debug, Args)]
pub(crate) struct Bones {
    /// Recording
    input: PathBuf,
    #[command(flatten)]
    sets: MarkerSetArgs,
    #[command(flatten)]
    read: ReadArgs,
}

impl Bones {
    pub(crate) fn run(self) -> Result<()> {
        let file = self.read.read(&self.input)?;
        let bones = Choice::Auto(self.sets.known()?).resolve(file.take())?;
        if bones.is_empty() {
            bail!(
                "no bones found in {}: no two markers keep their distance; list pairs in a CSV \
                 file with the columns marker_a,marker_b,length_mm",
                self.input.display()
            );
        }
        say!("{}", write_bones(&bones, file.take().markers()).trim_end());
        Ok(())
    }
}
