use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use marker_faults::{Fault, FaultDetector, FaultKind, FaultParams, Faults};
use mocap_core::Take;
use mocap_io::{Edit, MarkerFile};
use mocap_report::{FigureFormat, MAX_SPOTS, Spot, plot_spots};
use serde::Serialize;
use serde_json::json;

use crate::{
    files::{OutputArgs, ReadArgs},
    say::say,
};

const SIDECAR: &str = ".detect.json";

/// List samples that no body can have made: spikes, jumps, swapped labels, ghosts, junk beside gaps
///
/// Nothing is altered. With --apply the listed samples become missing in OUT, which a filler can then fill; everything
/// else stays byte for byte, and OUT.detect.json lists what was hidden.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  mocap detect walk.c3d
  mocap detect walk.c3d --plot faults.svg
  mocap detect walk.c3d --kind swap --kind ghost --json
  mocap detect walk.c3d --apply -o cleaned.c3d

Look at the plot before you apply: a fault of a centimetre in a fast movement may be real. Of two markers with
swapped labels both are listed; exchanging the labels keeps what --apply would hide.")]
pub(crate) struct Detect {
    /// Recording
    input: PathBuf,
    /// Hide the listed samples in OUT
    #[arg(long, requires = "output")]
    apply: bool,
    /// File to write with --apply; the same format as the input
    #[arg(short, long, value_name = "OUT", requires = "apply")]
    output: Option<PathBuf>,
    /// Figure with a close-up of each fault, as .svg or .png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Replace outputs that exist (an input is never replaced)
    #[arg(long)]
    force: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    limits: LimitArgs,
    #[command(flatten)]
    read: ReadArgs,
}

/// What counts as a fault.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Limits")]
pub(crate) struct LimitArgs {
    /// Kind of fault to look at; may be repeated [default: all]
    #[arg(long, value_enum, value_name = "KIND")]
    kind: Vec<KindArg>,
    /// Smallest step away from the path [default: 25]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    step: Option<f64>,
    /// Acceleration in m/s² that a marker may have beyond that of the markers around it [default: 100]
    #[arg(long, value_name = "M/S2", allow_negative_numbers = true)]
    acceleration: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum KindArg {
    /// One to three frames off the path
    Spike,
    /// Up to half a second away from the path and back
    Jump,
    /// Two markers with each other's label
    Swap,
    /// Samples beside a gap that do not continue the path
    GapEdge,
    /// A run between gaps that belongs to something else
    Misplaced,
    /// A point that stands still while the body moves
    Ghost,
}

impl KindArg {
    fn is(self, kind: FaultKind) -> bool {
        self.to_possible_value().is_some_and(|value| value.get_name() == kind.as_str())
    }
}

impl LimitArgs {
    /// The faults of a take.
    pub(crate) fn detect(&self, take: &Take) -> Result<Faults> {
        let defaults = FaultParams::default();
        let detector = FaultDetector::new(FaultParams {
            step_m: self.step.map_or(defaults.step_m, |mm| mm / 1000.0),
            acceleration: self.acceleration.unwrap_or(defaults.acceleration),
            ..defaults
        })?;
        let asked = |fault: &Fault| {
            self.kind.is_empty() || self.kind.iter().any(|kind| kind.is(fault.kind))
        };
        Ok(detector.detect(take).only(take, asked))
    }
}

impl Detect {
    pub(crate) fn run(self) -> Result<()> {
        let output = self.output.clone().map(|path| OutputArgs::new(path, self.force));
        let plot = self.plot.clone().map(|path| OutputArgs::new(path, self.force));
        for file in output.iter().chain(&plot) {
            file.check(&[&self.input])?;
        }
        if let Some(output) = &output {
            output.check_beside(SIDECAR)?;
        }
        if let Some(plot) = &self.plot {
            FigureFormat::from_path(plot)?;
        }
        let file = self.read.read(&self.input)?;
        if let Some(output) = &self.output
            && mocap_io::Format::of(output) != Some(file.info().format)
        {
            bail!("{}: hiding keeps the format; use the extension of the input", output.display());
        }
        let faults = self.limits.detect(file.take())?;
        let report = Report::new(&file, &self.input, &faults);
        if self.json {
            say!("{}", serde_json::to_string(&report)?);
        } else {
            report.print();
        }
        if let Some(plot) = &plot {
            plot.write(&figure(&self.input, file.take(), &faults, &plot.output)?)?;
            self.tell(&plot.output);
        }
        if let Some(output) = &output {
            output.write(&file.patched(&Edit::hides(file.take(), faults.mask()))?)?;
            output.write_beside(SIDECAR, &serde_json::to_vec_pretty(&report)?)?;
            self.tell(&output.output);
        }
        Ok(())
    }

    fn tell(&self, path: &Path) {
        if !self.json {
            say!("wrote {}", path.display());
        }
    }
}

/// The faults as a close-up each, the largest first where not all fit.
fn figure(input: &Path, take: &Take, faults: &Faults, path: &Path) -> Result<Vec<u8>> {
    let mut list: Vec<&Fault> = faults.list().iter().collect();
    if list.len() > MAX_SPOTS {
        list.sort_by(|a, b| b.size_m.total_cmp(&a.size_m));
    }
    let spot = |fault: &Fault| Spot {
        marker: fault.marker,
        frames: fault.frames.clone(),
        note: format!("{}, {:.0} mm", fault.kind, 1000.0 * fault.size_m),
    };
    let spots: Vec<Spot> = list.into_iter().map(spot).collect();
    let title = input.file_name().unwrap_or_default().to_string_lossy();
    Ok(plot_spots(&title, take, faults.mask(), &spots, path)?)
}

/// What was found, with the file's own frame numbers.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    file: String,
    marker_seconds: f64,
    faulty_samples: usize,
    faults: Vec<Line>,
}

#[derive(Debug, Serialize)]
struct Line {
    marker: String,
    kind: &'static str,
    /// The other marker of a swap.
    #[serde(skip_serializing_if = "Option::is_none")]
    with: Option<String>,
    first_frame: i64,
    last_frame: i64,
    start_s: f64,
    size_mm: f64,
    limit_mm: f64,
}

impl Report {
    pub(crate) fn new(file: &MarkerFile, path: &Path, faults: &Faults) -> Self {
        let take = file.take();
        let frame = |t: usize| file.info().first_frame.saturating_add_unsigned(t as u64);
        let name = |m: usize| take.markers().name(m).to_owned();
        let line = |fault: &Fault| Line {
            marker: name(fault.marker),
            kind: fault.kind.as_str(),
            with: match fault.kind {
                FaultKind::Swap { with } => Some(name(with)),
                _ => None,
            },
            first_frame: frame(fault.frames.start),
            last_frame: frame(fault.frames.end.saturating_sub(1)),
            start_s: fault.frames.start as f64 / take.rate_hz(),
            size_mm: 1000.0 * fault.size_m,
            limit_mm: 1000.0 * fault.limit_m,
        };
        Self {
            file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            marker_seconds: take.observed().count() as f64 / take.rate_hz(),
            faulty_samples: faults.mask().count(),
            faults: faults.list().iter().map(line).collect(),
        }
    }

    pub(crate) fn print(&self) {
        let widest = self.faults.iter().map(|line| line.marker.chars().count()).max().unwrap_or(0);
        let width = widest.max("marker".len());
        if !self.faults.is_empty() {
            say!(
                "{:<width$}  {:<9} {:>8} {:>8} {:>8} {:>8}",
                "marker",
                "kind",
                "first",
                "last",
                "second",
                "off"
            );
        }
        for line in &self.faults {
            let with =
                line.with.as_ref().map_or_else(String::new, |other| format!("  with {other}"));
            say!(
                "{:<width$}  {:<9} {:>8} {:>8} {:>8.2} {:>5.0} mm{with}",
                line.marker,
                line.kind,
                line.first_frame,
                line.last_frame,
                line.start_s,
                line.size_mm
            );
        }
        say!(
            "{} faults, {} samples, in {:.0} marker-seconds",
            self.faults.len(),
            self.faulty_samples,
            self.marker_seconds
        );
    }

    /// The list as a sidecar holds it.
    pub(crate) fn to_json(&self, applied: bool) -> serde_json::Value {
        json!({"applied": applied, "faulty_samples": self.faulty_samples, "faults": self.faults})
    }
}
