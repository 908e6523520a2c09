use mocap_core::{Gap, Mask, Take};

use crate::{
    MetricError, Score,
    error::{check_mask, check_takes},
    fill::{runs, score_cells},
};

/// Errors over the hidden gaps of one class of lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthScore {
    /// The gaps last longer than this many seconds …
    pub longer_than_s: f64,
    /// … and at most this many; infinite for the last class.
    pub at_most_s: f64,
    /// Hidden gaps of the class.
    pub gaps: usize,
    /// Errors over all their cells together; NaN without any.
    pub score: Score,
}

/// Errors by length of gap. The mean distance of a class is the occluded-marker position error (OMPE)
/// of [Pan23] over its gaps.
///
/// A gap is a maximal run of hidden cells of one marker. The classes are `(0, e₀]`, `(e₀, e₁]`, …,
/// `(e_last, ∞)` for the edges `edges_s`, and each is listed, with or without gaps.
///
/// # Units
/// Seconds.
///
/// # Errors
/// As [`score`](crate::score), and [`MetricError::Edges`] for edges that do not increase from above 0.
pub fn by_gap_length(
    truth: &Take,
    filled: &Take,
    hidden: &Mask,
    edges_s: &[f64],
) -> Result<Vec<LengthScore>, MetricError> {
    check_takes(truth, filled)?;
    check_mask(truth, "the hidden mask", hidden)?;
    let classes = gap_length_classes(hidden, truth.rate_hz(), edges_s)?;
    let limits = limits(edges_s);
    let scored: Vec<LengthScore> = classes
        .iter()
        .zip(limits)
        .map(|(gaps, (longer_than_s, at_most_s))| {
            let cells = gaps.iter().flat_map(|gap| gap.frames.clone().map(|t| (t, gap.marker)));
            let score = score_cells(truth, filled, cells);
            LengthScore { longer_than_s, at_most_s, gaps: gaps.len(), score }
        })
        .collect();
    if scored.iter().all(|class| class.score.hidden_cells == 0) {
        return Err(MetricError::NoHiddenCell);
    }
    Ok(scored)
}

/// The maximal runs of hidden cells by class of length, as [`by_gap_length`] sorts them.
///
/// # Units
/// Seconds; a gap of n frames lasts n / `rate_hz`.
///
/// # Errors
/// [`MetricError::Edges`].
pub fn gap_length_classes(
    hidden: &Mask,
    rate_hz: f64,
    edges_s: &[f64],
) -> Result<Vec<Vec<Gap>>, MetricError> {
    let increase = limits(edges_s).all(|(low, high)| low < high);
    if !increase || edges_s.iter().any(|edge| !edge.is_finite()) {
        return Err(MetricError::Edges);
    }
    let mut classes = vec![Vec::new(); edges_s.len() + 1];
    for gap in runs(hidden) {
        // A frame more or less never hangs on the rounding of an edge.
        let seconds = gap.seconds(rate_hz) * (1.0 - 1e-9);
        let class = edges_s.iter().take_while(|edge| seconds > **edge).count();
        classes[class].push(gap);
    }
    Ok(classes)
}

/// Both ends of each class in seconds.
fn limits(edges_s: &[f64]) -> impl Iterator<Item = (f64, f64)> + '_ {
    let lows = std::iter::once(0.0).chain(edges_s.iter().copied());
    lows.zip(edges_s.iter().copied().chain([f64::INFINITY]))
}
