use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use gapfill::Bones;
use mocap_io::MarkerFile;
use mocap_report::{FigureFormat, PlotInput, plot_take};

use crate::{
    files::{OutputArgs, ReadArgs},
    marker_sets::MarkerSetArgs,
    say::say,
};

/// Draw trajectories with their filled parts marked, bone lengths and the gap timeline
///
/// With one recording, its gaps are shown; with two, the samples that FILLED has and INPUT lacks are marked as filled.
#[derive(Debug, Args)]
pub(crate) struct Plot {
    /// Recording
    input: PathBuf,
    /// The same recording with its gaps filled
    filled: Option<PathBuf>,
    /// Complete recording, drawn beside the fill
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// Marker to draw; may be repeated [default: those with most missing samples]
    #[arg(long, value_name = "NAME")]
    marker: Vec<String>,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    sets: MarkerSetArgs,
    #[command(flatten)]
    read: ReadArgs,
}

impl Plot {
    pub(crate) fn run(self) -> Result<()> {
        let others = [&self.filled, &self.truth].into_iter().flatten();
        let inputs: Vec<_> =
            std::iter::once(&self.input).chain(others).map(PathBuf::as_path).collect();
        self.output.check(&inputs)?;
        FigureFormat::from_path(&self.output.output)?;
        let input = self.read.read(&self.input)?;
        let filled = self.filled.as_ref().map(|path| self.read.read(path)).transpose()?;
        let truth = self.truth.as_ref().map(|path| self.read.read(path)).transpose()?;
        let shown = filled.as_ref().map_or(input.take(), |f| f.take());
        if input.take().markers() != shown.markers() {
            bail!("{} and its fill do not have the same markers", self.input.display());
        }
        let bones = Bones::Auto(self.sets.known()?).resolve(input.take())?;
        let chosen = self.marker.iter().map(|name| input.take().markers().find(name));
        let chosen: Vec<usize> = chosen.collect::<Result<_, _>>()?;
        let title = self.input.file_name().unwrap_or_default().to_string_lossy();
        let plot = PlotInput {
            truth: truth.as_ref().map(MarkerFile::take),
            markers: (!chosen.is_empty()).then_some(chosen),
            ..PlotInput::pair(&title, input.take(), shown, &bones)
        };
        let bytes = plot_take(&plot, &self.output.output)?;
        self.output.write(&bytes)?;
        say!("wrote {}", self.output.output.display());
        Ok(())
    }
}
