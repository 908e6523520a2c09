use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use anyhow::{Context, Result, bail};
use clap::Args;
use mocap_core::{Holdout, Mask, Motion, Take};
use mocap_io::{Format, LengthUnit, MotionFile, ReadOptions, encode_markers};
use mocap_synth::{
    Activity, Hands, Layout, Person, Synth as Generator, SynthError, SynthParams, SyntheticTake,
};
use serde_json::json;

use crate::{files::OutputArgs, progress::Progress, say::say};

mod gaps;
mod outputs;

/// Make a synthetic recording of a moving body whose truth is known
///
/// A body walks, runs, jumps, throws, turns, reaches, kicks, leaps or goes round corners, or does what a recorded skeleton does, and wears markers
/// that slide with the skin and are measured with noise. Nothing of it is captured: files may be shipped freely. The same
/// options give the same bytes, on any machine.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  mocap synth --motion walk -o walk.c3d
  mocap synth --motion reach --layout production-57 --hands 10 --body-seed 7 -o reach.c3d \\
      --truth clean.c3d --joints reach.bvh --animate film.svg
  mocap synth --motion dance.amc --skeleton subject.asf --body-seed 7 -o dance.c3d
  mocap synth --motion run --layout front_waist-53 --occlusion 0.1 -o gappy.c3d --truth complete.c3d

Layouts: `cmu-41` is the set of the CMU database; `front_waist-53` and `production-57` are full-body sets whose gap
statistics are known. --hands 5 or 10 adds finger markers to each hand, and fingers that grasp and pinch.

Bodies: without --body-seed, the template at --stature with lengths a few percent off by --seed. With it, a person: sex,
stature, lengths and girths drawn together as in surveys, and markers on the person's skin.

Truth: -o holds what cameras would measure; --truth where the markers were, without noise and gaps; --joints the skeleton,
with y up as readers of BVH and ASF/AMC expect, or as JSON with z up like the markers.")]
pub(crate) struct Synth {
    /// What the body does: walk, run, jump, throw, turn, reach, kick, leap, corner, or a file with joint motion (.amc, .bvh)
    #[arg(long, value_name = "NAME|FILE")]
    motion: String,
    /// Skeleton of an AMC file; by default the ASF file beside it
    #[arg(long, value_name = "FILE.asf")]
    skeleton: Option<PathBuf>,
    /// Number of frames [default: 300, or all of a file's]
    #[arg(long)]
    frames: Option<usize>,
    /// Sampling rate in Hz [default: 120, or that of the file]
    #[arg(long)]
    rate: Option<f64>,
    /// Seed of markers, motion and noise, and of the template's lengths: the same seed gives the same file
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    wearer: Wearer,
    #[command(flatten)]
    outputs: outputs::Outputs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Body and markers")]
struct Wearer {
    /// Draw a person by this seed
    #[arg(long, value_name = "N")]
    body_seed: Option<u64>,
    /// Height of the template in metres [default: 1.75]
    #[arg(long, value_name = "M", conflicts_with = "body_seed")]
    stature: Option<f64>,
    /// Marker set: cmu-41, front_waist-53 or production-57
    #[arg(long, default_value = "cmu-41")]
    layout: Layout,
    /// Markers on the fingers of each hand: 0, 5 or 10
    #[arg(long, value_name = "N", default_value = "0")]
    hands: Hands,
    /// Standard deviation of the measurement noise a coordinate, in mm
    #[arg(long, value_name = "MM", default_value_t = 0.25)]
    noise: f64,
    /// Soft-tissue movement over the usual; 0 glues the markers to the bones
    #[arg(long, value_name = "X", default_value_t = 1.0)]
    soft_tissue: f64,
    /// Radius of the markers in mm; finger markers have 0.4 of it
    #[arg(long, value_name = "MM", default_value_t = 7.0)]
    marker_radius: f64,
    /// Hide this share of the samples, with gaps as long and as likely for each marker as in captures
    #[arg(long, value_name = "SHARE")]
    occlusion: Option<f64>,
}

impl Synth {
    pub(crate) fn run(self) -> Result<()> {
        let format = self.check()?;
        let generator = self.generator()?;
        let frames = generator.params().frames;
        let progress = Progress::new("synth", self.json);
        let start = Instant::now();
        let recorded = generator.take_observed(&mut |done| progress.count(done, frames))?;
        progress.finish();
        let seconds = start.elapsed().as_secs_f64();
        let hidden = match self.wearer.occlusion {
            None => Mask::none(frames, recorded.take().marker_count()),
            Some(share) => gaps::draw(recorded.take(), generator.params(), share)?,
        };
        let take = Holdout::new(recorded.take().clone(), &hidden)?.visible().clone();
        self.output.write(&encode_markers(&take, format, LengthUnit::Millimetre, 1)?)?;
        self.outputs.write(&self.output, &self.title(), &recorded, &take)?;
        self.tell(&generator, &recorded, &take, seconds);
        Ok(())
    }

    /// Everything that can be refused before any work is done.
    fn check(&self) -> Result<Format> {
        let inputs = [Some(Path::new(&self.motion)), self.skeleton.as_deref()];
        let inputs: Vec<&Path> = inputs.into_iter().flatten().collect();
        self.output.check(&inputs)?;
        self.outputs.check(&self.output, &inputs)?;
        let path = &self.output.output;
        match Format::of(path) {
            Some(format) if format.holds_markers() => Ok(format),
            _ => bail!("{}: markers go into .c3d, .trc, .csv or .tsv files", path.display()),
        }
    }

    fn generator(&self) -> Result<Generator> {
        let wearer = &self.wearer;
        let defaults = SynthParams::default();
        let params = SynthParams {
            frames: self.frames.unwrap_or(300),
            rate_hz: self.rate.unwrap_or(120.0),
            seed: self.seed,
            stature_m: wearer.stature.unwrap_or(defaults.stature_m),
            person: wearer.body_seed.map(Person::draw),
            layout: wearer.layout,
            hands: wearer.hands,
            marker_radius_m: 1e-3 * wearer.marker_radius,
            noise_m: 1e-3 * wearer.noise,
            soft_tissue: wearer.soft_tissue,
            ..defaults
        };
        let Some(file) = self.recording()? else {
            if self.skeleton.is_some() {
                bail!("--skeleton goes with a motion from an .amc file; leave it out");
            }
            return Ok(Generator::new(SynthParams { motion: self.motion.parse()?, ..params })?);
        };
        let motion = file.motion();
        let rate_hz = self.rate.unwrap_or(motion.rate_hz());
        let params = SynthParams {
            frames: self.frames.unwrap_or_else(|| frames_at(motion, rate_hz)),
            rate_hz,
            ..params
        };
        Generator::retarget(params, motion)
            .with_context(|| format!("{} does not fit the body", self.motion))
    }

    /// The file that `--motion` names, if it names one.
    fn recording(&self) -> Result<Option<MotionFile>> {
        let path = Path::new(&self.motion);
        match Format::of(path) {
            None if path.is_file() => {
                bail!("{}: a motion comes from an .amc or .bvh file", self.motion)
            }
            None => Ok(None),
            Some(format) if format.holds_markers() => {
                bail!("{} holds markers; a motion comes from an .amc or .bvh file", self.motion)
            }
            Some(_) => {
                let options = ReadOptions::default();
                Ok(Some(MotionFile::read(path, self.skeleton.as_deref(), &options)?))
            }
        }
    }

    fn title(&self) -> String {
        let path = Path::new(&self.motion);
        path.file_name().map_or_else(|| self.motion.clone(), |n| n.to_string_lossy().into_owned())
    }

    fn tell(&self, generator: &Generator, recorded: &SyntheticTake, take: &Take, seconds: f64) {
        let params = generator.params();
        let joints = recorded.motion().skeleton().joints().len();
        let gaps = take.gaps().len();
        let cells = take.frames() * take.marker_count();
        let hidden = 1.0 - take.observed().count() as f64 / cells as f64;
        let stature_m = params.person.map_or(params.stature_m, |p| p.stature_m());
        let slid = recorded.sliding_m();
        let sliding_mm = 1e3 * slid.iter().sum::<f64>() / slid.len() as f64;
        if self.json {
            let object = json!({
                "motion": self.title(), "frames": take.frames(), "rate_hz": take.rate_hz(), "seed": self.seed,
                "layout": params.layout.name(), "finger_markers_per_hand": params.hands.per_hand(),
                "markers": take.marker_count(), "joints": joints, "stature_m": stature_m,
                "sex": params.person.map(|p| format!("{:?}", p.sex()).to_lowercase()),
                "mean_sliding_mm": sliding_mm, "hidden_share": hidden, "gaps": gaps, "seconds": seconds,
            });
            say!("{object}");
            return;
        }
        say!(
            "{} frames at {} Hz, {} markers ({}), {joints} joints, stature {stature_m:.2} m",
            take.frames(),
            take.rate_hz(),
            take.marker_count(),
            params.layout,
        );
        say!("soft tissue moves the markers by {sliding_mm:.1} mm on average");
        if gaps > 0 {
            say!("{:.1} % of the samples are hidden in {gaps} gaps", 100.0 * hidden);
        }
        say!("wrote {}", self.output.output.display());
    }
}

/// Frames at another rate that last as long as a motion.
fn frames_at(motion: &Motion, rate_hz: f64) -> usize {
    let last = motion.poses().len().saturating_sub(1) as f64 * rate_hz / motion.rate_hz();
    // A rate that is none is refused with the parameters.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let frames = last.floor() as usize;
    frames.saturating_add(1)
}

/// A complete synthetic take.
pub(crate) fn make(
    activity: Activity,
    frames: usize,
    rate_hz: f64,
    seed: u64,
) -> Result<Take, SynthError> {
    let params = SynthParams { motion: activity, frames, rate_hz, seed, ..SynthParams::default() };
    Ok(Generator::new(params)?.take()?.into_take())
}
