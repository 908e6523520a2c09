use std::ops::Range;

use mocap_core::{Bone, Take};

use super::{PlotInput, cell::shorten};
use crate::draw::Point;

/// Millimetres in a metre.
pub(super) const MM_PER_M: f64 = 1000.0;

/// One quantity over time, and where it was measured.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub heading: String,
    /// In mm, one a frame; `None` where missing.
    pub values: Vec<Option<f64>>,
    /// One a frame: whether all that the value depends on was measured.
    pub measured: Vec<bool>,
    /// True values in mm, one a frame, `None` where unknown or measured anyway.
    pub truth: Vec<Option<f64>>,
    /// A value in mm that the quantity ought to have.
    pub nominal: Option<f64>,
    /// Height of the chart at least, in mm, so that noise does not look like motion.
    pub min_span: f64,
}

impl Curve {
    pub(super) fn coordinate(input: &PlotInput<'_>, marker: usize, axis: usize) -> Self {
        let value = |take: &Take, t: usize| take.position(t, marker).map(|p| MM_PER_M * p[axis]);
        let name = shorten(input.name(marker), 36);
        Self {
            heading: format!("{name}  {} (mm)", ["x", "y", "z"][axis]),
            min_span: 10.0,
            ..Self::of(input, |t| input.measured.contains(t, marker), value)
        }
    }

    pub(super) fn bone(input: &PlotInput<'_>, bone: &Bone) -> Self {
        let (a, b) = bone.markers();
        let value = |take: &Take, t: usize| take.distance(t, a, b).map(|d| MM_PER_M * d);
        let measured = |t| input.measured.contains(t, a) && input.measured.contains(t, b);
        let name = |m: usize| shorten(input.name(m), 19);
        Self {
            heading: format!("{} \u{2013} {} (mm)", name(a), name(b)),
            nominal: Some(MM_PER_M * bone.length_m()),
            min_span: 20.0,
            ..Self::of(input, measured, value)
        }
    }

    fn of(
        input: &PlotInput<'_>,
        measured: impl Fn(usize) -> bool,
        value: impl Fn(&Take, usize) -> Option<f64>,
    ) -> Self {
        let frames = input.take.frames();
        let measured: Vec<bool> = (0..frames).map(measured).collect();
        // One measured frame on either side ties the dashes to the curve.
        let near_gap =
            |t: usize| (t.saturating_sub(1)..(t + 2).min(frames)).any(|near| !measured[near]);
        let truth = |t: usize| input.truth.filter(|_| near_gap(t)).and_then(|take| value(take, t));
        Self {
            heading: String::new(),
            values: (0..frames).map(|t| value(input.take, t)).collect(),
            truth: (0..frames).map(truth).collect(),
            measured,
            nominal: None,
            min_span: 0.0,
        }
    }

    pub(super) fn frames(&self) -> usize {
        self.values.len()
    }

    /// All values that the chart has to show.
    pub(super) fn all_values(&self) -> impl Iterator<Item = f64> + '_ {
        self.values.iter().chain(&self.truth).copied().flatten().chain(self.nominal)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.values.iter().all(Option::is_none)
    }

    pub(super) fn measured_runs(&self) -> Vec<Range<usize>> {
        runs(self.frames(), |t| self.measured[t] && self.values[t].is_some())
    }

    pub(super) fn filled_runs(&self) -> Vec<Range<usize>> {
        runs(self.frames(), |t| !self.measured[t] && self.values[t].is_some())
    }

    pub(super) fn missing_runs(&self) -> Vec<Range<usize>> {
        runs(self.frames(), |t| self.values[t].is_none())
    }

    pub(super) fn truth_runs(&self) -> Vec<Range<usize>> {
        runs(self.frames(), |t| self.truth[t].is_some())
    }

    /// The run and the sample on either side of it, where there is one.
    pub(super) fn widen(&self, run: &Range<usize>) -> Range<usize> {
        let has = |t: usize| self.values.get(t).is_some_and(Option::is_some);
        let start = run.start - usize::from(run.start > 0 && has(run.start - 1));
        start..run.end + usize::from(has(run.end))
    }
}

/// The maximal runs of frames for which `inside` holds.
pub(super) fn runs(frames: usize, inside: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for t in (0..frames).filter(|&t| inside(t)) {
        match runs.last_mut() {
            Some(run) if run.end == t => run.end = t + 1,
            _ => runs.push(t..t + 1),
        }
    }
    runs
}

/// Drops points that no eye could tell apart, so that long takes give small files: of the points in
/// one narrow column the first, the lowest, the highest and the last stay.
pub(super) fn thin(points: &[Point]) -> Vec<Point> {
    const COLUMNS_PER_UNIT: f64 = 2.0;
    let column = |p: &Point| (p.0 * COLUMNS_PER_UNIT).floor();
    points
        .chunk_by(|p, q| (column(p) - column(q)).abs() < 0.5)
        .flat_map(|group| {
            let by_height = |i: &usize, j: &usize| group[*i].1.total_cmp(&group[*j].1);
            let low = (0..group.len()).min_by(by_height).unwrap_or(0);
            let high = (0..group.len()).max_by(by_height).unwrap_or(0);
            let mut kept = [0, low, high, group.len() - 1];
            kept.sort_unstable();
            let mut kept = kept.to_vec();
            kept.dedup();
            kept.into_iter().map(|i| group[i])
        })
        .collect()
}
