mod faulty;
mod session;

use std::{
    fmt::Write,
    path::{Path, PathBuf},
    time::Instant,
};

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use gapfill::{Bones, Borders, Coordinates, Edges, Options};
use mocap_core::{BoneSet, Filled, Mask, Refusal, Take};
use mocap_io::{Edit, Format, MarkerFile, encode_markers, read_bones};
use mocap_report::{FillSummary, PlotInput, TakeSummary, html_page, render_png, render_svg};
use serde_json::json;
use sha2::{Digest, Sha256};

use self::{faulty::Faulty, session::Session};
use crate::{
    files::{OutputArgs, ReadArgs, create_folder},
    marker_sets::MarkerSetArgs,
    progress::Progress,
    say::say,
};

const SIDECAR: &str = ".fill.json";

/// Fill the gaps of a recording; nothing else in the file changes
///
/// The filled samples are listed in OUT.fill.json, and marked in a C3D file as the standard says (residual 0, camera mask 0).
/// Gaps that a method cannot fill stay open and are listed with the reason.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  mocap fill walk.c3d -o filled.c3d
  mocap fill walk.c3d -o filled.c3d --max-error 10
  mocap fill walk.c3d -o filled.c3d --session walk2.c3d run.c3d
  mocap fill walk.c3d -o filled.c3d --method spline --max-gap 0.2
  mocap fill walk.csv -o filled.c3d --rate 120 --report report

Try `mocap methods` for the methods, `mocap occlude` and `mocap score` to test one on your own data.")]
pub(crate) struct Fill {
    /// Recording with gaps
    input: PathBuf,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    method: MethodArgs,
    /// List samples that no body can have made, as `mocap detect` does, before filling
    #[arg(long)]
    detect: bool,
    /// Fill those samples, too, as if they were missing
    #[arg(long, requires = "detect")]
    apply: bool,
    /// Leave gaps open that last longer
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    max_gap: Option<f64>,
    /// Threads to use; the result is the same for any number
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Folder for a report with plots and tables
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    read: ReadArgs,
}

/// Which method, and how.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Method")]
struct MethodArgs {
    /// How to fill; see `mocap methods`
    #[arg(long, value_name = "METHOD", default_value = gapfill::DEFAULT)]
    method: String,
    /// Bone lengths: a CSV file (see `mocap bones`), `auto` from the visible samples, or `none`
    #[arg(long, value_name = "FILE|auto|none", default_value = "auto")]
    bones: String,
    /// Coordinates in which the motion is learnt [default: the method's own choice]
    #[arg(long, value_enum, value_name = "FRAME")]
    frame: Option<FrameArg>,
    /// Hidden dimensions of a dynamical system [default: 32, or fewer for short takes]
    #[arg(long, value_name = "N")]
    hidden: Option<usize>,
    /// Weight of the bone lengths [default: 1e6]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    lambda: Option<f64>,
    /// Iterations at most
    #[arg(long, value_name = "N")]
    iterations: Option<usize>,
    /// Every setting of the paper, for `dynammo`, `bolero-sc` and `bolero-hc`, to compare with it
    #[arg(long)]
    published: bool,
    /// Seed of a random start: the same seed gives the same bits
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// What becomes of gaps at the start or end of the take, for methods that interpolate, and where no marker is seen there,
    /// for `auto`
    #[arg(long, value_enum, default_value = "refuse")]
    edges: EdgesArg,
    /// Leave gaps open that are expected to be filled with a larger error, for `auto` [default: a metre]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    max_error: Option<f64>,
    /// Other recordings of the same person with the same markers to learn from, for `auto`
    #[arg(long, value_name = "FILE", num_args = 1..)]
    session: Vec<PathBuf>,
    /// What becomes of the step at the borders of a gap [default: the method's own choice]
    #[arg(long, value_enum)]
    borders: Option<BordersArg>,
    #[command(flatten)]
    sets: MarkerSetArgs,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum BordersArg {
    /// The fill is shifted to join the measured samples
    Join,
    /// The fill stays as the method left it
    Keep,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FrameArg {
    /// Where the recording has them
    World,
    /// Relative to the body's place and heading
    Body,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum EdgesArg {
    /// They stay open
    Refuse,
    /// They hold the nearest position
    Hold,
}

impl Fill {
    pub(crate) fn run(self) -> Result<()> {
        self.check()?;
        if let Some(threads) = self.threads {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
        }
        let file = self.read.read(&self.input)?;
        let faults = self.detect.then(|| Faulty::of(&file, &self.input, self.apply)).transpose()?;
        let input = faults.as_ref().map_or(file.take(), |faults| &faults.left);
        let session = Session::read(
            &self.method.session,
            &self.method.method,
            (&self.input, input),
            &self.read,
        )?;
        let options = Options { session: session.takes(), ..self.method.options(input)? };
        let run = fill(input, &self.method.method, &options, self.json)?;
        let filled = self.keep_short(run.filled)?;
        let bytes = self.bytes(&file, &filled)?;
        self.output.write(&bytes)?;

        let first_frame = file.info().first_frame;
        let summary = FillSummary::new(&filled, first_frame, run.seconds);
        let mut sidecar = self.sidecar(&file, &bytes, &summary)?;
        sidecar["session"] = session.hashes();
        let detected = faults.as_ref().map(|faults| faults.report.to_json(self.apply));
        if let Some(detected) = &detected {
            sidecar["detected"] = detected.clone();
        }
        self.output.write_beside(SIDECAR, &serde_json::to_vec_pretty(&sidecar)?)?;
        if let Some(folder) = &self.report {
            let bones = options.bones.resolve(file.take())?;
            let title = file_name(&self.input);
            let take = TakeSummary::new(file.take(), first_frame);
            report(folder, &title, &take, &filled, &bones, &summary)?;
        }
        if self.json {
            let mut object = serde_json::to_value(&summary)?;
            if let Some(detected) = detected {
                object["detected"] = detected;
            }
            say!("{object}");
        } else {
            if let Some(faults) = &faults {
                faults.report.print();
            }
            say!("{}", summary.to_text());
            say!("wrote {}", self.output.output.display());
        }
        Ok(())
    }

    /// Everything that can be refused before any work is done.
    fn check(&self) -> Result<()> {
        let inputs = [&self.input].into_iter().chain(&self.method.session);
        self.output.check(&inputs.map(PathBuf::as_path).collect::<Vec<_>>())?;
        self.output.check_beside(SIDECAR)?;
        if self.max_gap.is_some_and(|s| !(s.is_finite() && s > 0.0)) {
            bail!("--max-gap must be a positive number of seconds");
        }
        if self.method.max_error.is_some_and(|mm| !(mm.is_finite() && mm > 0.0)) {
            bail!("--max-error must be a positive number of millimetres");
        }
        if self.threads == Some(0) {
            bail!("--threads must be at least 1");
        }
        let format = Format::of(&self.output.output);
        match format {
            Some(format) if format.holds_markers() => Ok(()),
            Some(format) => bail!(
                "a .{} file holds a skeleton; markers become joint motion by solving, not by filling",
                format.extension()
            ),
            None => bail!(
                "{}: no format goes by this extension; use .c3d, .trc, .csv or .tsv",
                self.output.output.display()
            ),
        }
    }

    fn keep_short(&self, filled: Filled) -> Result<Filled> {
        let Some(limit_s) = self.max_gap else { return Ok(filled) };
        let rate_hz = filled.take().rate_hz();
        let long = filled.gaps().into_iter().filter(|gap| gap.seconds(rate_hz) > limit_s);
        long.collect::<Vec<_>>().into_iter().try_fold(filled, |filled, gap| {
            let reason = Refusal::TooLong { gap_s: gap.seconds(rate_hz), limit_s };
            Ok(filled.refuse(gap, reason)?)
        })
    }

    fn bytes(&self, file: &MarkerFile, filled: &Filled) -> Result<Vec<u8>> {
        let info = file.info();
        match Format::of(&self.output.output) {
            Some(format) if format != info.format => {
                Ok(encode_markers(filled.take(), format, info.unit, info.first_frame)?)
            }
            _ => {
                // What was hidden and could not be filled is missing in the output.
                let (before, after) = (file.take(), filled.take());
                let lost = Mask::from_fn(before.frames(), before.marker_count(), |t, m| {
                    before.is_observed(t, m) && !after.is_observed(t, m)
                });
                let mut edits = Edit::fills(filled);
                edits.extend(Edit::hides(before, &lost));
                Ok(file.patched(&edits)?)
            }
        }
    }

    /// The account of the fill: what went in, what came out, and how.
    fn sidecar(
        &self,
        file: &MarkerFile,
        output: &[u8],
        summary: &FillSummary,
    ) -> Result<serde_json::Value> {
        let mut object = serde_json::to_value(summary)?;
        object["program"] = json!(format!("mocap {}", env!("CARGO_PKG_VERSION")));
        object["input"] = named_hash(&self.input, file.bytes());
        object["output"] = named_hash(&self.output.output, output);
        object["options"] = json!({
            "method": self.method.method, "bones": self.method.bones,
            "frame": self.method.frame.map(|f| format!("{f:?}").to_lowercase()),
            "hidden": self.method.hidden, "lambda": self.method.lambda, "published": self.method.published,
            "iterations": self.method.iterations, "seed": self.method.seed,
            "edges": format!("{:?}", self.method.edges).to_lowercase(),
            "borders": self.method.borders.map(|b| format!("{b:?}").to_lowercase()), "max_gap_s": self.max_gap,
            "max_error_mm": self.method.max_error,
        });
        Ok(object)
    }
}

/// File name and sha256 of the unpacked content.
fn named_hash(path: &Path, bytes: &[u8]) -> serde_json::Value {
    json!({"file": file_name(path), "sha256": hex(&Sha256::digest(bytes))})
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    })
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

impl MethodArgs {
    fn options(&self, take: &Take) -> Result<Options> {
        let known = self.sets.known()?;
        let bones = match self.bones.as_str() {
            "auto" => Bones::Auto(known.clone()),
            "none" => Bones::None,
            path => {
                let named = || format!("cannot use the bones of {path}");
                let bytes = std::fs::read(path).with_context(named)?;
                Bones::Given(read_bones(&bytes, take.markers()).with_context(named)?)
            }
        };
        Ok(Options {
            bones,
            known,
            coordinates: self.frame.map(|frame| match frame {
                FrameArg::World => Coordinates::World,
                FrameArg::Body => Coordinates::Body,
            }),
            hidden: self.hidden,
            lambda: self.lambda,
            iterations: self.iterations,
            published: self.published,
            start: None,
            seed: self.seed,
            edges: match self.edges {
                EdgesArg::Refuse => Edges::Refuse,
                EdgesArg::Hold => Edges::Hold,
            },
            max_error_m: self.max_error.map(|mm| mm / 1e3),
            borders: self.borders.map(|borders| match borders {
                BordersArg::Join => Borders::Join,
                BordersArg::Keep => Borders::Keep,
            }),
            ..Options::default()
        })
    }
}

/// A fill and the seconds it took.
pub(crate) struct Run {
    pub(crate) filled: Filled,
    pub(crate) seconds: f64,
}

/// Fills a take and shows progress.
pub(crate) fn fill(take: &Take, method: &str, options: &Options, quiet: bool) -> Result<Run> {
    let filler = gapfill::build(method, options)?;
    let progress = Progress::new(method, quiet);
    let start = Instant::now();
    let filled = filler.fill_observed(take, &mut |report| progress.show(report));
    let seconds = start.elapsed().as_secs_f64();
    progress.finish();
    Ok(Run { filled: filled.with_context(|| format!("cannot fill with {method}"))?, seconds })
}

/// Writes the report's files into a folder: a page to read, and its parts to use.
fn report(
    folder: &Path,
    title: &str,
    take: &TakeSummary,
    filled: &Filled,
    bones: &BoneSet,
    summary: &FillSummary,
) -> Result<()> {
    create_folder(folder)?;
    let plot = PlotInput::fill(title, filled, bones);
    let figure = render_svg(&plot)?;
    let page = html_page(title, take, Some(summary), Some(&figure));
    for (name, bytes) in [
        ("index.html", page.into_bytes()),
        ("fill.svg", figure),
        ("fill.png", render_png(&plot)?),
        ("gaps.csv", summary.gaps_csv().into_bytes()),
        ("fill.json", serde_json::to_vec_pretty(summary)?),
    ] {
        mocap_io::write_atomic(&folder.join(name), &bytes, true)?;
    }
    Ok(())
}
