use mocap_core::{Gap, Holdout, Mask, Take, geometry};

use crate::{
    MM_PER_M, MetricError,
    error::{check_mask, check_takes},
    quantile,
    stats::Moments,
};

/// Mean square error over the hidden coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mse {
    /// Squared error per hidden coordinate in m², over the hidden cells that have an estimate; NaN if
    /// none has.
    pub mse_m2: f64,
    /// Hidden cells, filled or not.
    pub hidden_cells: usize,
    /// Hidden cells that were left open and so have no part in the error.
    pub unfilled_cells: usize,
}

/// Errors of a fill over the hidden cells, 3-D distances unless said otherwise.
///
/// Each figure is taken over the hidden cells that have an estimate, and is NaN if none has: read it
/// together with `unfilled_cells`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// Mean square error per coordinate in m².
    pub mse_m2: f64,
    /// Mean distance in mm.
    pub mean_mm: f64,
    /// Root mean square distance in mm: `1000 √(3 mse_m2)`.
    pub rms_mm: f64,
    /// Median distance in mm.
    pub median_mm: f64,
    /// 95 % quantile of the distances in mm.
    pub p95_mm: f64,
    /// Largest distance in mm.
    pub max_mm: f64,
    /// Hidden cells with a known truth, filled or not.
    pub hidden_cells: usize,
    /// Hidden cells with a known truth that were left open.
    pub unfilled_cells: usize,
    /// Hidden cells whose truth is unknown: they cannot be scored and are in no other count.
    pub truthless_cells: usize,
}

/// The score of one hidden gap.
#[derive(Debug, Clone, PartialEq)]
pub struct GapScore {
    /// A maximal run of hidden cells of one marker.
    pub gap: Gap,
    /// Its score.
    pub score: Score,
}

/// Mean square error of a fill over the coordinates that a holdout hides.
///
/// Hidden cells without an estimate are left out of both sums and counted in
/// [`Mse::unfilled_cells`].
///
/// # Units
/// m².
///
/// # Errors
/// [`MetricError::Shape`] and [`MetricError::Markers`] if the fill is of another take,
/// [`MetricError::NoHiddenCell`] if the holdout hides nothing.
///
/// Implements [Li10] Eq. (13).
pub fn mse(holdout: &Holdout, filled: &Take) -> Result<Mse, MetricError> {
    let Score { mse_m2, hidden_cells, unfilled_cells, .. } =
        score(holdout.truth(), filled, holdout.hidden())?;
    Ok(Mse { mse_m2, hidden_cells, unfilled_cells })
}

/// Errors of a fill over the cells of `hidden`, `(T, M)`.
///
/// # Errors
/// [`MetricError::Shape`] and [`MetricError::Markers`] if the three are not of one take,
/// [`MetricError::NoHiddenCell`] if `hidden` holds no cell that `truth` shows.
pub fn score(truth: &Take, filled: &Take, hidden: &Mask) -> Result<Score, MetricError> {
    check_takes(truth, filled)?;
    check_mask(truth, "the hidden mask", hidden)?;
    let score = score_cells(truth, filled, hidden.iter());
    if score.hidden_cells == 0 { Err(MetricError::NoHiddenCell) } else { Ok(score) }
}

/// The score of each hidden gap, marker by marker and in time order.
///
/// A gap none of whose cells has a truth is listed with `hidden_cells` 0 and NaN errors.
///
/// # Errors
/// As [`score`].
pub fn per_gap(truth: &Take, filled: &Take, hidden: &Mask) -> Result<Vec<GapScore>, MetricError> {
    score(truth, filled, hidden)?;
    let scored = |gap: Gap| {
        let cells = gap.frames.clone().map(|t| (t, gap.marker));
        GapScore { score: score_cells(truth, filled, cells), gap }
    };
    Ok(runs(hidden).into_iter().map(scored).collect())
}

pub(crate) fn score_cells(
    truth: &Take,
    filled: &Take,
    cells: impl Iterator<Item = (usize, usize)>,
) -> Score {
    let (mut hidden_cells, mut truthless_cells) = (0, 0);
    let mut errors_m = Vec::new();
    for (t, m) in cells {
        let Some(x) = truth.position(t, m) else {
            truthless_cells += 1;
            continue;
        };
        hidden_cells += 1;
        errors_m.extend(filled.position(t, m).map(|estimate| geometry::distance(estimate, x)));
    }
    errors_m.sort_by(f64::total_cmp);
    let Moments { count, mean, rms, max } = Moments::of(errors_m.iter().copied());
    let quantile_mm = |p| quantile(&errors_m, p).map_or(f64::NAN, |q| MM_PER_M * q);
    Score {
        mse_m2: rms * rms / 3.0,
        mean_mm: MM_PER_M * mean,
        rms_mm: MM_PER_M * rms,
        median_mm: quantile_mm(0.5),
        p95_mm: quantile_mm(0.95),
        max_mm: MM_PER_M * max,
        hidden_cells,
        unfilled_cells: hidden_cells - count,
        truthless_cells,
    }
}

/// The maximal runs of cells in the set, marker by marker and in time order.
pub(crate) fn runs(cells: &Mask) -> Vec<Gap> {
    let mut runs: Vec<Gap> = Vec::new();
    for marker in 0..cells.markers() {
        for t in (0..cells.frames()).filter(|&t| cells.contains(t, marker)) {
            match runs.last_mut() {
                Some(run) if run.marker == marker && run.frames.end == t => run.frames.end = t + 1,
                _ => runs.push(Gap { marker, frames: t..t + 1 }),
            }
        }
    }
    runs
}
