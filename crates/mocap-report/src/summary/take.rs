use mocap_core::Take;
use serde::Serialize;

use super::{counted, file_frame};
use crate::table::{Entry, Table};

/// What a take holds and lacks.
///
/// Frames carry the numbers of their file. `Serialize` gives the object of `mocap inspect --json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TakeSummary {
    /// Number of markers.
    pub markers: usize,
    /// Number of frames.
    pub frames: usize,
    /// Sampling rate in Hz.
    pub rate_hz: f64,
    /// Length in seconds: frames over rate.
    pub duration_s: f64,
    /// Number of the first frame.
    pub first_frame: i64,
    /// Number of the last frame, one below the first in a take without frames.
    pub last_frame: i64,
    /// Share of cells that are observed, in percent; 100 where there is no cell.
    pub labelled_percent: f64,
    /// Number of gaps.
    pub gap_count: usize,
    /// Markers that no frame shows.
    pub unused_markers: Vec<String>,
    /// Marker by marker, in the order of the take.
    pub per_marker: Vec<MarkerSummary>,
    /// All gaps, marker by marker and in time order.
    pub gaps: Vec<GapSummary>,
}

/// What one marker shows and lacks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MarkerSummary {
    /// Name of the marker.
    pub marker: String,
    /// Share of frames without it, in percent.
    pub missing_percent: f64,
    /// Number of gaps.
    pub gaps: usize,
    /// Its longest gap, in frames.
    pub longest_gap_frames: usize,
    /// Its longest gap, in seconds.
    pub longest_gap_s: f64,
    /// First frame that shows it.
    pub first_frame: Option<i64>,
    /// Last frame that shows it.
    pub last_frame: Option<i64>,
}

/// One gap.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GapSummary {
    /// Name of the marker.
    pub marker: String,
    /// First frame without it.
    pub first_frame: i64,
    /// Last frame without it.
    pub last_frame: i64,
    /// Length in frames.
    pub frames: usize,
    /// Length in seconds.
    pub seconds: f64,
}

impl TakeSummary {
    /// Sums up a take whose first frame has the given number in its file.
    #[must_use]
    pub fn new(take: &Take, first_frame: i64) -> Self {
        let (frames, markers) = (take.frames(), take.marker_count());
        let per_marker: Vec<MarkerSummary> =
            (0..markers).map(|m| MarkerSummary::new(take, m, first_frame)).collect();
        let gaps = GapSummary::all(take, first_frame);
        let unused = per_marker.iter().filter(|m| m.first_frame.is_none());
        Self {
            markers,
            frames,
            rate_hz: take.rate_hz(),
            duration_s: frames as f64 / take.rate_hz(),
            first_frame,
            last_frame: file_frame(first_frame, frames).saturating_sub(1),
            labelled_percent: 100.0
                - percent(frames * markers - take.observed().count(), frames * markers),
            gap_count: gaps.len(),
            unused_markers: unused.map(|m| m.marker.clone()).collect(),
            per_marker,
            gaps,
        }
    }

    /// The summary as aligned text for a terminal: one line on the take, a table of the markers with
    /// gaps, the unused markers.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = self.headline() + "\n";
        let table = self.marker_table(|m| m.gaps > 0);
        if !table.is_empty() {
            text = text + "\n" + &table.to_text();
        }
        if !self.unused_markers.is_empty() {
            let names = crate::draw::printable(&self.unused_markers.join(", "));
            text = text + "\nunused markers: " + &names + "\n";
        }
        text
    }

    /// The first `limit` gaps as aligned text, and how many more there are; empty without gaps.
    #[must_use]
    pub fn gaps_text(&self, limit: usize) -> String {
        let mut table = self.gap_table();
        let more = table.rows().len().saturating_sub(limit);
        table.truncate(limit);
        match (table.is_empty(), more) {
            (true, _) => String::new(),
            (false, 0) => table.to_text(),
            (false, more) => format!("{}… and {}\n", table.to_text(), counted(more, "more gap")),
        }
    }

    /// Two lines on the take as a whole.
    pub(crate) fn headline(&self) -> String {
        format!(
            "{}, {} at {} Hz ({:.2} s), frames {} to {}\n{:.2} % labelled, {}",
            counted(self.markers, "marker"),
            counted(self.frames, "frame"),
            self.rate_hz,
            self.duration_s,
            self.first_frame,
            self.last_frame,
            self.labelled_percent,
            counted(self.gap_count, "gap"),
        )
    }

    /// The gaps as CSV: `marker,first_frame,last_frame,frames,seconds`.
    #[must_use]
    pub fn gaps_csv(&self) -> String {
        self.gap_table().to_csv()
    }

    pub(crate) fn marker_table(&self, keep: impl Fn(&MarkerSummary) -> bool) -> Table {
        let row = |m: &MarkerSummary| {
            vec![
                Entry::Text(m.marker.clone()),
                Entry::Number(m.missing_percent, 2),
                Entry::count(m.gaps),
                Entry::count(m.longest_gap_frames),
                Entry::Number(m.longest_gap_s, 3),
                Entry::integer(m.first_frame),
                Entry::integer(m.last_frame),
            ]
        };
        Table::new([
            "marker",
            "missing %",
            "gaps",
            "longest frames",
            "longest s",
            "first seen",
            "last seen",
        ])
        .with_rows(self.per_marker.iter().filter(|m| keep(m)).map(row))
    }

    pub(crate) fn gap_table(&self) -> Table {
        let row = |gap: &GapSummary| {
            vec![
                Entry::Text(gap.marker.clone()),
                Entry::Integer(gap.first_frame),
                Entry::Integer(gap.last_frame),
                Entry::count(gap.frames),
                Entry::Number(gap.seconds, 3),
            ]
        };
        Table::new(["marker", "first frame", "last frame", "frames", "seconds"])
            .with_rows(self.gaps.iter().map(row))
    }
}

impl MarkerSummary {
    fn new(take: &Take, marker: usize, first_frame: i64) -> Self {
        let gaps = take.gaps_of(marker);
        let longest = gaps.iter().map(mocap_core::Gap::len).max().unwrap_or(0);
        let mut seen = (0..take.frames()).filter(|&t| take.is_observed(t, marker));
        let first = seen.next();
        Self {
            marker: take.markers().name(marker).to_owned(),
            missing_percent: percent(gaps.iter().map(mocap_core::Gap::len).sum(), take.frames()),
            gaps: gaps.len(),
            longest_gap_frames: longest,
            longest_gap_s: longest as f64 / take.rate_hz(),
            first_frame: first.map(|t| file_frame(first_frame, t)),
            last_frame: seen.next_back().or(first).map(|t| file_frame(first_frame, t)),
        }
    }
}

impl GapSummary {
    fn all(take: &Take, first_frame: i64) -> Vec<Self> {
        let one = |gap: mocap_core::Gap| Self {
            marker: take.markers().name(gap.marker).to_owned(),
            first_frame: file_frame(first_frame, gap.frames.start),
            last_frame: file_frame(first_frame, gap.frames.end).saturating_sub(1),
            frames: gap.len(),
            seconds: gap.seconds(take.rate_hz()),
        };
        take.gaps().into_iter().map(one).collect()
    }
}

/// `part` of `whole` in percent; 0 of nothing.
fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}
