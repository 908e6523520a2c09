use std::{ops::Range, path::PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use gapfill::{Bones, Options};
use mocap_core::{BoneSet, Filled, Holdout, MarkerKnowledge, Mask, Take};
use mocap_io::write_atomic;
use mocap_report::{PlotInput, render_png, render_svg};
use mocap_synth::Activity;

use crate::{
    files::{ReadArgs, create_folder},
    fill,
    say::say,
    synth,
};

/// See it work: hide two markers of a runner, fill them by several methods, and plot the result
#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// Complete recording to use [default: a synthetic run]
    take: Option<PathBuf>,
    /// Folder for the plots
    #[arg(short, long, value_name = "DIR", default_value = "mocap-demo")]
    output: PathBuf,
    /// Fewer iterations
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    read: ReadArgs,
}

/// The knee and the shin, as in the running motion of [Li10] Fig. 3.
const HIDDEN: [&str; 2] = ["RKNE", "RSHN"];
/// Length of the gap, in the middle of the take.
const GAP_S: f64 = 0.5;
const METHODS: [&str; 5] = ["linear", "spline", "lds", "bolero-sc", "auto"];
/// The method whose fill is drawn.
const DRAWN: &str = gapfill::DEFAULT;

impl Demo {
    pub(crate) fn run(self) -> Result<()> {
        let truth = match &self.take {
            Some(path) => self.read.read(path)?.take().clone(),
            None => synth::make(Activity::Run, 240, 120.0, 2)?,
        };
        let gap = middle(&truth)?;
        let holdout = hide(truth, gap.clone())?;
        let known = vec![MarkerKnowledge::cmu_41()];
        let bones = Bones::Auto(known.clone()).resolve(holdout.visible())?;
        introduce(&holdout, &gap);
        let mut drawn = None;
        for method in METHODS {
            let options = Options {
                bones: Bones::Given(bones.clone()),
                known: known.clone(),
                iterations: self.quick.then_some(20),
                ..Options::default()
            };
            let run = fill::fill(holdout.visible(), method, &options, false)?;
            print_row(method, &run, &holdout, &bones)?;
            if method == DRAWN {
                drawn = Some(run.filled);
            }
        }
        drawn.map_or(Ok(()), |filled| self.draw(&filled, &holdout, &bones))
    }

    fn draw(&self, filled: &Filled, holdout: &Holdout, bones: &BoneSet) -> Result<()> {
        create_folder(&self.output)?;
        let title = format!("{}, filled by {DRAWN}", HIDDEN.join(" and "));
        let plot =
            PlotInput { truth: Some(holdout.truth()), ..PlotInput::fill(&title, filled, bones) };
        let (svg, png) = (self.output.join("fill.svg"), self.output.join("fill.png"));
        write_atomic(&svg, &render_svg(&plot)?, true)?;
        write_atomic(&png, &render_png(&plot)?, true)?;
        say!("\nThe fill by {DRAWN} beside the truth: {} and {}", svg.display(), png.display());
        Ok(())
    }
}

/// The frames to hide.
fn middle(take: &Take) -> Result<Range<usize>> {
    let length = (0..take.frames()).filter(|&n| (n as f64) < GAP_S * take.rate_hz()).count();
    if 3 * length > take.frames() {
        bail!("the demo needs a take of at least {} s", 3.0 * GAP_S);
    }
    let start = (take.frames() - length) / 2;
    Ok(start..start + length)
}

fn hide(truth: Take, gap: Range<usize>) -> Result<Holdout> {
    let markers = truth.markers();
    let gone: Vec<usize> = HIDDEN.iter().map(|n| markers.find(n)).collect::<Result<_, _>>()?;
    let hidden = Mask::from_fn(truth.frames(), truth.marker_count(), |t, m| {
        gap.contains(&t) && gone.contains(&m)
    });
    Ok(Holdout::new(truth, &hidden)?)
}

fn introduce(holdout: &Holdout, gap: &Range<usize>) {
    let take = holdout.truth();
    say!(
        "{} markers, {} frames at {} Hz. Hidden: {} in frames {} to {} ({:.1} s).\n",
        take.marker_count(),
        take.frames(),
        take.rate_hz(),
        HIDDEN.join(" and "),
        gap.start + 1,
        gap.end,
        gap.len() as f64 / take.rate_hz(),
    );
    say!(
        "{:<10} {:>12} {:>9} {:>9} {:>14} {:>9}",
        "method",
        "mse [m²]",
        "mean",
        "p95",
        "bone deviation",
        "time"
    );
}

fn print_row(method: &str, run: &fill::Run, holdout: &Holdout, bones: &BoneSet) -> Result<()> {
    let score = metrics::score(holdout.truth(), run.filled.take(), holdout.hidden())?;
    let bones = metrics::bone_deviation(run.filled.take(), bones, Some(holdout.hidden()))?;
    say!(
        "{method:<10} {:>12.2e} {:>6.1} mm {:>6.1} mm {:>11.1} mm {:>7.2} s",
        score.mse_m2,
        score.mean_mm,
        score.p95_mm,
        bones.mean_mm,
        run.seconds
    );
    Ok(())
}
