use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use mocap_core::{Mask, Take};
use mocap_io::Edit;

use crate::files::{self, OutputArgs, ReadArgs};
use crate::say::say;

/// Hide samples, to see how well a method brings them back
///
/// The output differs from the input in the hidden samples alone.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  mocap occlude walk.c3d -o gap.c3d --marker RKNE --marker RSHN --frames 25..90
  mocap occlude walk.c3d -o gaps.c3d --list gaps.csv     (columns marker,start,end)")]
pub(crate) struct Occlude {
    /// Complete recording
    input: PathBuf,
    #[command(flatten)]
    output: OutputArgs,
    /// Marker to hide, with or without its subject prefix; may be repeated
    #[arg(long, value_name = "NAME", requires = "frames")]
    marker: Vec<String>,
    /// Frames to hide, both included, as the file counts them
    #[arg(long, value_name = "A..B", requires = "marker")]
    frames: Option<String>,
    /// CSV with the columns marker, start and end, one gap a line
    #[arg(long, value_name = "CSV")]
    list: Option<PathBuf>,
    #[command(flatten)]
    read: ReadArgs,
}

impl Occlude {
    pub(crate) fn run(self) -> Result<()> {
        self.output.check(&[&self.input])?;
        let file = self.read.read(&self.input)?;
        let hidden = self.hidden(file.take(), file.info().first_frame)?;
        let edits = Edit::hides(file.take(), &hidden);
        self.output.write(&file.patched(&edits)?)?;
        say!("{} samples hidden in {}", edits.len(), self.output.output.display());
        Ok(())
    }

    fn hidden(&self, take: &Take, first_frame: i64) -> Result<Mask> {
        let mut hidden = Mask::none(take.frames(), take.marker_count());
        let mut hide = |marker: &str, frames: &str| -> Result<()> {
            let marker = take.markers().find(marker)?;
            for t in files::frames(frames, first_frame, take)? {
                hidden.insert(t, marker)?;
            }
            Ok(())
        };
        if let Some(frames) = &self.frames {
            self.marker.iter().try_for_each(|marker| hide(marker, frames))?;
        }
        if let Some(list) = &self.list {
            let named = || format!("cannot use {}", list.display());
            let mut reader = csv::ReaderBuilder::new()
                .trim(csv::Trim::All)
                .from_path(list)
                .with_context(named)?;
            for row in reader.deserialize() {
                let Row { marker, start, end } = row.with_context(named)?;
                hide(&marker, &format!("{start}..{end}")).with_context(named)?;
            }
        }
        if self.frames.is_none() && self.list.is_none() {
            bail!("nothing to hide; give --marker NAME --frames A..B, or --list CSV");
        }
        Ok(hidden)
    }
}

/// One gap of a list.
#[derive(serde::Deserialize)]
struct Row {
    marker: String,
    start: i64,
    end: i64,
}
