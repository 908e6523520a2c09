use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Instant,
};

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use mocap_core::{
    MarkerKnowledge, Motion, RigidTransform, Rotation, Take, UpAxis, geometry::distance,
};
use mocap_io::{Format, LengthUnit, encode_markers, encode_motion};
use mocap_report::{FigureFormat, MotionPlot, animate_motion, plot_motion};
use serde_json::{Value, json};
use solve_ik::Solution;

mod bodies;

use bodies::BodyArgs;

use crate::{
    convert::skeleton_beside,
    files::{OutputArgs, ReadArgs},
    progress::Progress,
    say::say,
};

/// Solve labelled markers, gaps and all, into the motion of a skeleton
///
/// The body is fitted to the wearer first (lengths of bones, places of markers), then every frame is solved. Missing
/// markers are simply absent. The output is BVH, AMC with its ASF beside it, ASF, or JSON (positions in metres,
/// quaternions w x y z). BVH and ASF/AMC are written with y up, as their readers expect.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  mocap solve walk.c3d -o walk.bvh
  mocap solve walk.c3d -o walk.amc --skeleton subject.asf
  mocap solve walk.c3d -o walk.bvh --plot walk.svg --animate film.svg --markers clean.c3d

  mocap solve walk.c3d -o walk.bvh --calibrate-on 1..600 --save-body subject.body
  mocap solve walk.c3d -o walk.bvh --t-pose 1..60
  mocap solve jump.c3d -o jump.bvh --skeleton subject.body --no-calibration
  mocap solve jump.c3d -o jump.bvh --learn-from walk.c3d --motion walk.amc --skeleton subject.asf

Bodies: three are built in, for the 41 markers of the CMU database (and the Plug-in Gait names of the same places), and for
the layouts front_waist-53 and production-57 with up to ten markers on each hand. An .asf, .amc or .bvh file gives the
bones of a known skeleton whose joints have a built-in body's names. With --learn-from, a body comes from a take and the
motion that another program made of it, and is used as it is.

A body file is text with one fact a line. Print one with --save-body, and change what differs:
  joint  hips                          the root; parents come before their children
  joint  knee hips 0 -0.42 0           name, parent, place relative to it in the rest pose, in metres
  rigid  knee                          never turns
  spread knee 70 6 1 0 0               standard deviation in degrees about an axis, across it, the axis
  limit  knee -5 165                   degrees about that axis
  t-pose knee 0 0 -20                  its turn in a T-pose: a rotation vector in degrees
  marker LKNE hips 0.05 -0.42 0 share knee 0.3 spread 0.03
  alias  LKNE L_Knee                   `L_Knee` of a take counts as `LKNE`")]
pub(crate) struct Solve {
    /// Recording of labelled markers
    input: PathBuf,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    body: BodyArgs,
    /// How to solve
    #[arg(long, value_enum, default_value = "ik")]
    method: Method,
    /// Keep the fitted body for other takes of the same session
    #[arg(long, value_name = "FILE.body")]
    save_body: Option<PathBuf>,
    /// Write where the solved body would show its markers: clean, and without gaps
    #[arg(long, value_name = "FILE")]
    markers: Option<PathBuf>,
    /// Draw skeleton and markers at six moments, and how far the markers miss (.svg, .png)
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Draw an animation that browsers play (.svg)
    #[arg(long, value_name = "FILE")]
    animate: Option<PathBuf>,
    /// Refuse markers that the body does not know, instead of leaving them out
    #[arg(long)]
    strict: bool,
    /// Axes of the written motion
    #[arg(long, value_enum, default_value = "y-up")]
    axes: Axes,
    /// Threads to use; the result is the same for any number
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    read: ReadArgs,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Method {
    /// Calibration, then Levenberg-Marquardt a frame
    Ik,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Axes {
    /// y up, turned if the recording has z up
    YUp,
    /// As in the recording
    Keep,
}

impl Solve {
    pub(crate) fn run(self) -> Result<()> {
        let format = self.check()?;
        if let Some(threads) = self.threads {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
        }
        let Method::Ik = self.method;
        let file = self.read.read(&self.input)?;
        let take = file.take();
        let solver = self.body.solver(&file, &self.read)?;
        if self.strict {
            let checked = solver.check_markers(take);
            checked.with_context(|| format!("cannot solve {}", self.input.display()))?;
        }
        let progress = Progress::new("ik", self.json);
        let start = Instant::now();
        let solution = solver.solve_observed(take, &mut |report| progress.show(report));
        let seconds = start.elapsed().as_secs_f64();
        progress.finish();
        let solution =
            solution.with_context(|| format!("cannot solve {}", self.input.display()))?;
        let up =
            UpAxis::guess(take, &MarkerKnowledge::for_markers(take.markers())).unwrap_or(UpAxis::Z);
        let motion = match (self.axes, up) {
            (Axes::YUp, UpAxis::Z) => lie_down(&solution.motion)?,
            _ => solution.motion.clone(),
        };
        self.write(format, &motion)?;
        let info = file.info();
        self.write_others(take, &solution, up, info.unit, info.first_frame)?;
        self.tell(take, &solution, info.first_frame, seconds);
        Ok(())
    }

    /// Everything that can be refused before any work is done.
    fn check(&self) -> Result<Format> {
        let mut inputs = self.inputs();
        self.output.check(&inputs)?;
        inputs.push(&self.output.output);
        let others = [&self.save_body, &self.markers, &self.plot, &self.animate];
        for path in others.into_iter().flatten() {
            self.output.named(path).check(&inputs)?;
        }
        if self.threads == Some(0) {
            bail!("--threads must be at least 1");
        }
        if let Some(path) = &self.plot {
            FigureFormat::from_path(path)?;
        }
        if let Some(path) = &self.animate
            && FigureFormat::from_path(path)? != FigureFormat::Svg
        {
            bail!("{}: an animation is an .svg file", path.display());
        }
        if let Some(path) = &self.markers
            && !Format::of(path).is_some_and(Format::holds_markers)
        {
            bail!("{}: markers go into .c3d, .trc, .csv or .tsv files", path.display());
        }
        let output = &self.output.output;
        if is_json(output) {
            return Ok(Format::Bvh);
        }
        match Format::of(output) {
            Some(format) if !format.holds_markers() => Ok(format),
            _ => bail!("{}: a solved motion goes into .bvh, .amc, .asf or .json", output.display()),
        }
    }

    fn inputs(&self) -> Vec<&Path> {
        self.body.inputs().chain([self.input.as_path()]).collect()
    }

    fn write(&self, format: Format, motion: &Motion) -> Result<()> {
        if is_json(&self.output.output) {
            return self.output.write(&serde_json::to_vec(&motion_json(motion)?)?);
        }
        let bytes = encode_motion(motion, format, LengthUnit::Centimetre)?;
        if format == Format::Amc {
            skeleton_beside(&self.output, &self.inputs(), motion)?;
        }
        self.output.write(&bytes)
    }

    fn write_others(
        &self,
        take: &Take,
        solution: &Solution,
        up: UpAxis,
        unit: LengthUnit,
        first_frame: i64,
    ) -> Result<()> {
        let write =
            |path: &Path, bytes: &[u8]| -> Result<()> { self.output.named(path).write(bytes) };
        if let Some(path) = &self.save_body {
            write(path, solution.body.to_string().as_bytes())?;
        }
        if let Some(path) = &self.markers {
            let format = Format::of(path).context("the extension was checked")?;
            let markers = Arc::clone(take.markers());
            let clean = Take::from_positions(markers, take.rate_hz(), solution.markers.clone())?;
            write(path, &encode_markers(&clean, format, unit, first_frame)?)?;
        }
        let title = self.input.file_name().unwrap_or_default().to_string_lossy();
        let mapped: Vec<usize> = (0..take.marker_count())
            .filter(|&m| !solution.unmapped.iter().any(|name| name == take.markers().name(m)))
            .collect();
        let shown = take.select(&mapped)?;
        let plot = MotionPlot {
            title: &title,
            motion: &solution.motion,
            take: &shown,
            residual_m: &solution.residual_m,
            up,
        };
        if let Some(path) = &self.plot {
            write(path, &plot_motion(&plot, path)?)?;
        }
        if let Some(path) = &self.animate {
            write(path, &animate_motion(&plot)?)?;
        }
        Ok(())
    }

    fn tell(&self, take: &Take, solution: &Solution, first_frame: i64, seconds: f64) {
        let shown: Vec<f64> =
            solution.residual_m.iter().copied().filter(|r| r.is_finite()).collect();
        let mean_mm = 1e3 * shown.iter().sum::<f64>() / shown.len().max(1) as f64;
        let worst = solution
            .residual_m
            .iter()
            .enumerate()
            .filter(|(_, r)| r.is_finite())
            .max_by(|a, b| a.1.total_cmp(b.1))
            .map(|(t, residual)| (t, first_frame.saturating_add_unsigned(t as u64), residual));
        let culprit = worst.and_then(|(t, ..)| farthest(take, solution, t));
        let frames = take.frames();
        let dark = frames - shown.len();
        if self.json {
            let object = json!({
                "frames": frames, "joints": solution.motion.skeleton().joints().len(), "seconds": seconds,
                "mean_residual_mm": mean_mm,
                "largest_residual_mm": worst.map(|(.., r)| 1e3 * r), "largest_residual_frame": worst.map(|(_, frame, _)| frame),
                "largest_residual_marker": culprit.map(|(name, _)| name),
                "frames_without_markers": dark, "unconverged_frames": solution.unconverged,
                "unmapped_markers": solution.unmapped, "termination": solution.termination.as_str(),
                "calibration": solution.calibration.iter().map(|round| json!({
                    "frames": round.frames, "steps": round.steps,
                })).collect::<Vec<_>>(),
            });
            say!("{object}");
            return;
        }
        say!("frames           {frames:>10}");
        say!("markers miss by  {mean_mm:>10.2} mm on average");
        if let Some((_, frame, residual)) = worst {
            let most = culprit.map(|(name, off)| format!(", {name} by {:.0} mm", 1e3 * off));
            say!(
                "at most          {:>10.2} mm in frame {frame}{}",
                1e3 * residual,
                most.unwrap_or_default()
            );
        }
        if dark > 0 {
            say!("without markers  {dark:>10} frames: their poses are interpolated");
        }
        if solution.unconverged > 0 {
            say!("not settled      {:>10} frames: look at them in the plot", solution.unconverged);
        }
        if !solution.unmapped.is_empty() {
            const LISTED: usize = 8;
            let listed =
                solution.unmapped.iter().take(LISTED).map(String::as_str).collect::<Vec<_>>();
            let more = solution.unmapped.len().saturating_sub(LISTED);
            let more = if more > 0 { format!(", and {more} more") } else { String::new() };
            say!(
                "not on the body  {}{more}: left out; a body file can place them",
                listed.join(", ")
            );
        }
        say!("wrote {} in {seconds:.1} s", self.output.output.display());
    }
}

/// The marker that misses most in a frame, and by how much in metres.
fn farthest<'a>(take: &'a Take, solution: &Solution, frame: usize) -> Option<(&'a str, f64)> {
    let off = |marker: usize| {
        let expected = std::array::from_fn(|a| solution.markers[(frame, marker, a)]);
        let off = distance(take.position(frame, marker)?, expected);
        off.is_finite().then(|| (take.markers().name(marker), off))
    };
    (0..take.marker_count()).filter_map(off).max_by(|a, b| a.1.total_cmp(&b.1))
}

pub(crate) fn is_json(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"))
}

/// The motion with z up turned to y up: x becomes z, y becomes x, z becomes y.
pub(crate) fn lie_down(motion: &Motion) -> Result<Motion> {
    Ok(motion.transformed(&RigidTransform { rotation: to_y_up()?, translation: [0.0; 3] })?)
}

fn to_y_up() -> Result<Rotation> {
    Rotation::from_matrix(&[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
        .context("a permutation of the axes is a rotation")
}

/// Joints, and for each frame their places in metres and rotations relative to the parent as w, x, y, z.
pub(crate) fn motion_json(motion: &Motion) -> Result<Value> {
    let skeleton = motion.skeleton();
    let joints: Vec<Value> = skeleton
        .joints()
        .iter()
        .map(
            |joint| json!({"name": joint.name, "parent": joint.parent, "offset_m": joint.offset_m}),
        )
        .collect();
    let mut frames = Vec::with_capacity(motion.poses().len());
    for pose in motion.poses() {
        let rotations: Vec<[f64; 4]> = pose
            .rotations
            .iter()
            .map(|rotation| {
                let (w, [x, y, z]) = rotation.quaternion();
                [w, x, y, z]
            })
            .collect();
        let positions_m = skeleton.positions(pose)?;
        frames.push(
            json!({"root_m": pose.root_m, "rotations": rotations, "positions_m": positions_m}),
        );
    }
    Ok(json!({"rate_hz": motion.rate_hz(), "joints": joints, "frames": frames}))
}
