//! Recordings with real gaps: nothing is known of what was hidden, so what counts is what each method did.

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use gapfill::{Edges, Options};
use mocap_core::{CellState, Filled, Gap, Take};
use mocap_io::{MarkerFile, ReadOptions};
use mocap_report::{Entry, Table};
use serde::Serialize;

use crate::{ReproError, Variant};

/// Folders with recordings that have gaps of their own, below the folder of all data.
const FOLDERS: [&str; 2] = ["captures", "hands"];

/// What one method did to one recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RawFill {
    /// Name of the file without its ending.
    pub recording: String,
    /// The method.
    pub method: String,
    /// Gaps of the recording.
    pub gaps: usize,
    /// Gaps that were closed.
    pub filled: usize,
    /// Gaps of which something was left open.
    pub refused: usize,
    /// Median of the larger border step of each closed gap in mm; see [`metrics::BorderStep`].
    pub border_median_mm: Option<f64>,
    /// Largest border step in mm.
    pub border_max_mm: Option<f64>,
    /// Root mean square deviation from bone length in mm where both ends were measured.
    pub bones_measured_mm: Option<f64>,
    /// The same where an end was filled.
    pub bones_filled_mm: Option<f64>,
    /// Measured samples that came back otherwise: none, or the method is broken.
    pub altered: usize,
    /// Time of the fill in seconds.
    pub seconds: f64,
    /// Why the method cannot run on the recording at all.
    pub failed: Option<String>,
}

/// Fills every recording with gaps of its own by every method, and tells `done` after each.
///
/// Gaps at the ends of a take are left to the method's own rules. `iterations` is the most that an iterative
/// method may take; `None` leaves it its own number.
///
/// # Errors
/// [`ReproError::Motion`] if there is no recording with gaps; [`ReproError::Read`] for one that cannot
/// be read; [`ReproError::Method`] for a value that a method refuses. A method that cannot run on a recording is a result.
pub fn raw_fills(
    data: &Path,
    variants: &[Variant],
    iterations: Option<usize>,
    mut done: impl FnMut(&RawFill),
) -> Result<Vec<RawFill>, ReproError> {
    let mut fills = Vec::new();
    for path in files(data) {
        let file = MarkerFile::read(&path, &ReadOptions::default())?;
        let gaps = file.take().gaps();
        if gaps.is_empty() || gaps.iter().all(|gap| gap.len() == file.take().frames()) {
            continue;
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        // The name of the repository that a file comes from stands before its own.
        let name = name.rsplit("__").next().unwrap_or(&name).to_owned();
        for variant in variants {
            let options = Options { edges: Edges::Refuse, iterations, ..variant.options() };
            let fill = fill(&name, file.take(), variant, &options)?;
            done(&fill);
            fills.push(fill);
        }
    }
    if fills.is_empty() {
        let (motion, folder) = ("with gaps".to_owned(), data.join(FOLDERS[0]));
        return Err(ReproError::Motion { motion, folder });
    }
    Ok(fills)
}

/// The recordings, in order of name.
fn files(data: &Path) -> Vec<PathBuf> {
    let folders = FOLDERS.iter().filter_map(|folder| std::fs::read_dir(data.join(folder)).ok());
    let mut files: Vec<PathBuf> =
        folders.flatten().filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| mocap_io::Format::of(path).is_some_and(mocap_io::Format::holds_markers));
    files.sort();
    files
}

fn fill(
    recording: &str,
    take: &Take,
    variant: &Variant,
    options: &Options,
) -> Result<RawFill, ReproError> {
    let text = variant.label();
    let refused = |source| ReproError::Method { text: text.to_owned(), source };
    let filler = gapfill::build(variant.id(), options).map_err(refused)?;
    let gaps = take.gaps();
    let started = Instant::now();
    let filled = filler.fill(take);
    let seconds = started.elapsed().as_secs_f64();
    let nothing = RawFill {
        recording: recording.to_owned(),
        method: text.to_owned(),
        gaps: gaps.len(),
        filled: 0,
        refused: gaps.len(),
        border_median_mm: None,
        border_max_mm: None,
        bones_measured_mm: None,
        bones_filled_mm: None,
        altered: 0,
        seconds,
        failed: None,
    };
    match filled {
        Ok(filled) => Ok(judge(take, &filled, options, nothing)),
        Err(error) => Ok(RawFill { failed: Some(error.to_string()), ..nothing }),
    }
}

fn judge(input: &Take, filled: &Filled, options: &Options, fill: RawFill) -> RawFill {
    let is_closed =
        |gap: &&Gap| gap.frames.clone().all(|t| filled.state(t, gap.marker) == CellState::Filled);
    let gaps = filled.gaps();
    let closed: Vec<&Gap> = gaps.iter().filter(is_closed).collect();
    let step = |gap: &&Gap| metrics::border_step(filled.take(), gap).max_mm();
    let mut steps: Vec<f64> = closed.iter().filter_map(step).collect();
    steps.sort_by(f64::total_cmp);
    let bits = |take: &Take, t, m| take.position(t, m).map(|p| p.map(f64::to_bits));
    let is_altered = |&(t, m): &(usize, usize)| bits(input, t, m) != bits(filled.take(), t, m);
    let bones = options.bones.resolve(input).unwrap_or_default();
    let deviation = |take: &Take, cells| {
        let found = metrics::bone_deviation(take, &bones, cells).ok()?;
        (found.samples > 0).then_some(found.rms_mm)
    };
    RawFill {
        filled: closed.len(),
        refused: gaps.len() - closed.len(),
        border_median_mm: steps.get(steps.len() / 2).copied(),
        border_max_mm: steps.last().copied(),
        bones_measured_mm: deviation(input, None),
        bones_filled_mm: deviation(filled.take(), Some(&filled.filled_cells())),
        altered: input.observed().iter().filter(is_altered).count(),
        ..fill
    }
}

/// The fills as a table, recording by recording.
#[must_use]
pub fn raw_table(fills: &[RawFill]) -> Table {
    let columns = [
        "recording",
        "method",
        "gaps",
        "filled",
        "left open",
        "border step, median (mm)",
        "largest (mm)",
        "bones measured (mm)",
        "bones filled (mm)",
        "altered",
        "seconds",
        "remark",
    ];
    let row = |fill: &RawFill| {
        vec![
            Entry::text(&fill.recording),
            Entry::text(&fill.method),
            Entry::count(fill.gaps),
            Entry::count(fill.filled),
            Entry::count(fill.refused),
            Entry::number(fill.border_median_mm, 2),
            Entry::number(fill.border_max_mm, 1),
            Entry::number(fill.bones_measured_mm, 2),
            Entry::number(fill.bones_filled_mm, 2),
            Entry::count(fill.altered),
            Entry::number(Some(fill.seconds), 3),
            Entry::text(fill.failed.as_deref().unwrap_or_default()),
        ]
    };
    Table::new(columns).with_rows(fills.iter().map(row))
}
