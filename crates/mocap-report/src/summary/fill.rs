use metrics::border_step;
use mocap_core::{CellState, Filled, Gap};
use serde::Serialize;

use super::{counted, file_frame};
use crate::table::{Entry, Table};

/// What a fill did, gap by gap.
///
/// Frames carry the numbers of their file. `Serialize` gives the object of `mocap fill --json`; what
/// is unknown is `null`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FillSummary {
    /// Name of the method.
    pub method: String,
    /// Why it ended, as [`mocap_core::Termination::as_str`] names it.
    pub termination: String,
    /// Iterations done; 0 for a closed form.
    pub iterations: usize,
    /// Time the fill took, in seconds.
    pub seconds: f64,
    /// Time per iteration in seconds, where there were iterations.
    pub seconds_per_iteration: Option<f64>,
    /// All gaps of the input, marker by marker and in time order.
    pub gaps: Vec<GapFill>,
    /// Frames in which a method that promises exact bone lengths could not keep them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub broken_bones: Vec<BrokenBones>,
}

/// A frame in which not all bones have their length.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BrokenBones {
    /// Number of the frame.
    pub frame: i64,
    /// Largest difference between a distance and the length of its bone in mm.
    pub residual_mm: f64,
}

/// What a fill did to one gap.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GapFill {
    /// Name of the marker.
    pub marker: String,
    /// First frame of the gap.
    pub first_frame: i64,
    /// Last frame of the gap.
    pub last_frame: i64,
    /// Method that was asked to fill it.
    pub method: String,
    /// What it mixed, for a method that chooses, the largest share first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub mixture: Vec<Share>,
    /// Root mean square, over its filled samples, of their standard deviations in mm.
    pub sigma_mm: Option<f64>,
    /// The larger of its two border steps in mm, as [`metrics::BorderStep`] defines them.
    pub border_step_mm: Option<f64>,
    /// Why it, or part of it, was left open; `None` for a gap that is closed.
    pub refused: Option<String>,
}

/// A method's share in a mixture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Share {
    /// Name of the method.
    pub method: String,
    /// From 0 to 1.
    pub share: f64,
}

fn mixture(filled: &Filled, gap: &Gap) -> Vec<Share> {
    let choice = filled.report().choices.iter().find(|choice| choice.gap == *gap);
    let shares = choice.into_iter().flat_map(|choice| &choice.shares);
    shares.map(|(method, share)| Share { method: method.clone(), share: *share }).collect()
}

fn broken_bones(filled: &Filled, first_frame: i64) -> Vec<BrokenBones> {
    let infeasible = filled.report().bones.iter().flat_map(|bones| &bones.infeasible);
    infeasible
        .map(|broken| BrokenBones {
            frame: file_frame(first_frame, broken.frame),
            residual_mm: 1e3 * broken.residual_m,
        })
        .collect()
}

impl FillSummary {
    /// Sums up a fill that took `seconds`, of a take whose first frame has the given number in its
    /// file.
    #[must_use]
    pub fn new(filled: &Filled, first_frame: i64, seconds: f64) -> Self {
        let report = filled.report();
        let per_iteration = seconds / report.iterations as f64;
        let gap = |gap: Gap| GapFill::new(filled, &gap, first_frame);
        Self {
            method: report.method.clone(),
            termination: report.termination.as_str().to_owned(),
            iterations: report.iterations,
            seconds,
            seconds_per_iteration: (report.iterations > 0).then_some(per_iteration),
            gaps: filled.gaps().into_iter().map(gap).collect(),
            broken_bones: broken_bones(filled, first_frame),
        }
    }

    /// The summary as aligned text for a terminal: one line on the run, a table of the gaps, the
    /// reasons of those left open.
    #[must_use]
    pub fn to_text(&self) -> String {
        let closed = self.gaps.iter().filter(|gap| gap.refused.is_none()).count();
        let mut text = format!(
            "{}\n{closed} of {} filled\n",
            self.headline(),
            counted(self.gaps.len(), "gap")
        );
        if !self.gaps.is_empty() {
            text = text + "\n" + &self.gap_table().to_text();
        }
        let worst = self.broken_bones.iter().map(|b| b.residual_mm).reduce(f64::max);
        if let Some(worst) = worst {
            let frames = counted(self.broken_bones.len(), "frame");
            let line = format!("\nbones could not be kept in {frames}, by up to {worst:.2} mm\n");
            text.push_str(&line);
        }
        text
    }

    /// The gaps as CSV:
    /// `marker,first_frame,last_frame,method,sigma_mm,border_step_mm,refused`.
    #[must_use]
    pub fn gaps_csv(&self) -> String {
        self.gap_table().to_csv()
    }

    pub(crate) fn headline(&self) -> String {
        let head = format!("{}: {} in {:.2} s", self.method, self.termination, self.seconds);
        match self.seconds_per_iteration {
            Some(each) => {
                let iterations = counted(self.iterations, "iteration");
                format!("{head}, {iterations} of {:.2} ms", 1e3 * each)
            }
            None => head,
        }
    }

    pub(crate) fn gap_table(&self) -> Table {
        let row = |gap: &GapFill| {
            vec![
                Entry::Text(gap.marker.clone()),
                Entry::Integer(gap.first_frame),
                Entry::Integer(gap.last_frame),
                Entry::Text(gap.method_text()),
                Entry::number(gap.sigma_mm, 2),
                Entry::number(gap.border_step_mm, 2),
                gap.refused.clone().map_or(Entry::Empty, Entry::Text),
            ]
        };
        Table::new([
            "marker",
            "first frame",
            "last frame",
            "method",
            "sigma mm",
            "border step mm",
            "refused",
        ])
        .with_rows(self.gaps.iter().map(row))
    }
}

impl GapFill {
    fn new(filled: &Filled, gap: &Gap, first_frame: i64) -> Self {
        Self {
            marker: filled.take().markers().name(gap.marker).to_owned(),
            first_frame: file_frame(first_frame, gap.frames.start),
            last_frame: file_frame(first_frame, gap.frames.end).saturating_sub(1),
            method: filled.report().method.clone(),
            mixture: mixture(filled, gap),
            sigma_mm: sigma_mm(filled, gap),
            border_step_mm: border_step(filled.take(), gap).max_mm(),
            refused: refused(filled, gap),
        }
    }
}

impl GapFill {
    /// The method, or the two largest shares of a mixture: `auto: steady 40 %, near 30 %`.
    fn method_text(&self) -> String {
        let part = |s: &Share| format!("{} {:.0} %", s.method, 100.0 * s.share);
        let largest: Vec<String> = self.mixture.iter().take(2).map(part).collect();
        if largest.is_empty() {
            return self.method.clone();
        }
        format!("{}: {}", self.method, largest.join(", "))
    }
}

fn sigma_mm(filled: &Filled, gap: &Gap) -> Option<f64> {
    let sigmas: Vec<f64> =
        gap.frames.clone().filter_map(|t| filled.sigma_m(t, gap.marker)).collect();
    let squares: f64 = sigmas.iter().map(|s| s * s).sum();
    (!sigmas.is_empty()).then(|| 1e3 * (squares / sigmas.len() as f64).sqrt())
}

/// The reason that the method gave, or the bare fact where it gave none: an open cell is never silent.
fn refused(filled: &Filled, gap: &Gap) -> Option<String> {
    let is_open = |t: &usize| filled.state(*t, gap.marker) == CellState::Missing;
    let open = gap.frames.clone().filter(is_open).count();
    let overlaps = |other: &Gap| {
        other.marker == gap.marker
            && other.frames.start < gap.frames.end
            && gap.frames.start < other.frames.end
    };
    let listed = filled.report().refusals.iter().find(|refused| overlaps(&refused.gap));
    match listed {
        Some(refused) => Some(refused.reason.to_string()),
        None if open > 0 => Some(format!("{open} of {} frames have no estimate", gap.len())),
        None => None,
    }
}
