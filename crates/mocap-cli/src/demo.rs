use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use gapfill::{Bones, Options};
use mocap_core::{BoneSet, Filled, Holdout, MarkerKnowledge, Mask};
use mocap_io::write_atomic;
use mocap_report::{PlotInput, render_png, render_svg};
use mocap_synth::Activity;

use crate::{files::create_folder, fill, synth};

/// See it work: hide two markers of a synthetic runner, fill them, and plot the result
#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// Folder for the plots
    #[arg(short, long, value_name = "DIR", default_value = "mocap-demo")]
    output: PathBuf,
    /// Fewer iterations
    #[arg(long)]
    quick: bool,
}

const HIDDEN: [&str; 2] = ["RKNE", "RSHN"];
const GAP: std::ops::Range<usize> = 80..140;
const METHODS: [&str; 4] = ["linear", "spline", "lds", "bolero-sc"];
/// The method whose fill is drawn.
const DRAWN: &str = gapfill::DEFAULT;

impl Demo {
    pub(crate) fn run(self) -> Result<()> {
        let truth = synth::make(Activity::Run, 300, 120.0, 7)?;
        let markers = truth.markers().clone();
        let gone: Vec<usize> = HIDDEN.iter().map(|n| markers.find(n)).collect::<Result<_, _>>()?;
        let hidden = Mask::from_fn(truth.frames(), truth.marker_count(), |t, m| {
            GAP.contains(&t) && gone.contains(&m)
        });
        let holdout = Holdout::new(truth, &hidden)?;
        let known = vec![MarkerKnowledge::cmu_41()];
        let bones = Bones::Auto(known.clone()).resolve(holdout.visible())?;
        println!(
            "A synthetic run, {} frames at {} Hz, {} markers. Hidden: {} in frames {} to {} ({:.1} s).\n",
            holdout.truth().frames(),
            holdout.truth().rate_hz(),
            holdout.truth().marker_count(),
            HIDDEN.join(" and "),
            GAP.start + 1,
            GAP.end,
            GAP.len() as f64 / holdout.truth().rate_hz(),
        );
        println!("{:<10} {:>12} {:>9} {:>9} {:>14} {:>9}", "method", "mse [m²]", "mean", "p95", "bone deviation", "time");
        let mut drawn = None;
        for method in METHODS {
            let options = Options {
                bones: Bones::Given(bones.clone()),
                known: known.clone(),
                iterations: self.quick.then_some(20),
                ..Options::default()
            };
            let run = fill::fill(holdout.visible(), method, &options, false)?;
            Self::row(method, &run, &holdout, &bones)?;
            if method == DRAWN {
                drawn = Some(run.filled);
            }
        }
        drawn.map_or(Ok(()), |filled| self.draw(&filled, &holdout, &bones))
    }

    fn row(method: &str, run: &fill::Run, holdout: &Holdout, bones: &BoneSet) -> Result<()> {
        let score = metrics::score(holdout.truth(), run.filled.take(), holdout.hidden())?;
        let bones = metrics::bone_deviation(run.filled.take(), bones, Some(holdout.hidden()))?;
        println!(
            "{method:<10} {:>12.2e} {:>6.1} mm {:>6.1} mm {:>11.1} mm {:>7.2} s",
            score.mse_m2, score.mean_mm, score.p95_mm, bones.mean_mm, run.seconds
        );
        Ok(())
    }

    fn draw(&self, filled: &Filled, holdout: &Holdout, bones: &BoneSet) -> Result<()> {
        create_folder(&self.output)?;
        let title = format!("A synthetic run, filled by {DRAWN}");
        let plot = PlotInput {
            truth: Some(holdout.truth()),
            ..PlotInput::fill(&title, filled, bones)
        };
        let (svg, png) = (self.output.join("fill.svg"), self.output.join("fill.png"));
        write_atomic(&svg, &render_svg(&plot)?, true)?;
        write_atomic(&png, &render_png(&plot)?, true)?;
        println!("\nThe fill by {DRAWN} beside the truth: {} and {}", svg.display(), png.display());
        Ok(())
    }
}
