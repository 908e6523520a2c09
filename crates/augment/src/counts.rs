//! How many gaps of which length each marker gets.

use crate::{
    AugmentError, Excess, GapHistogram, GapSamplerParams, Normalisation, Rounding, dice::Dice,
};

/// The share of frames in which each marker is to be hidden, before and after the limit.
pub(crate) struct Rates {
    pub(crate) requested: Vec<f64>,
    pub(crate) planned: Vec<f64>,
}

/// The last factor of Eq. 6 for each marker, `(M,)`; spared markers get none.
pub(crate) fn rates(probabilities: &[Option<f64>], params: &GapSamplerParams) -> Rates {
    let listed: Vec<f64> = probabilities.iter().flatten().copied().collect();
    let sum: f64 = listed.iter().sum();
    let scale = match params.normalisation {
        Normalisation::Mean => params.occlusion * listed.len() as f64,
        Normalisation::Sum => params.occlusion,
    };
    let requested: Vec<f64> =
        probabilities.iter().map(|p| scale * (p.unwrap_or(0.0) / sum)).collect();
    let planned = match params.excess {
        Excess::Drop => requested.iter().map(|r| r.min(params.marker_limit)).collect(),
        Excess::Spread => spread(&requested, params.marker_limit),
    };
    Rates { requested, planned }
}

/// Cuts rates at the limit and scales up the others, until the sum is as it was.
fn spread(requested: &[f64], limit: f64) -> Vec<f64> {
    let total: f64 = requested.iter().sum();
    let mut factor = 1.0;
    // Each round cuts one more marker or is the last.
    for _ in 0..requested.len() {
        let is_cut = |rate: &&f64| factor * **rate >= limit;
        let cut = requested.iter().filter(is_cut).count();
        let free: f64 = requested.iter().filter(|rate| !is_cut(rate)).sum();
        if free <= 0.0 {
            break;
        }
        let next = (total - limit * cut as f64) / free;
        if next <= factor {
            break;
        }
        factor = next;
    }
    requested.iter().map(|rate| (factor * rate).min(limit)).collect()
}

/// The gap lengths of one marker in frames, longest first.
///
/// `hidden_frames` is the number of frames to hide: the frames of the marker times its rate.
///
/// Implements [Pan23] Eq. (6). Deviates from [Pan23] Eq. (6): only [`Rounding::Floor`] rounds down.
pub(crate) fn gap_lengths(
    lengths: &GapHistogram,
    hidden_frames: f64,
    rounding: Rounding,
    dice: &mut Dice,
) -> Vec<usize> {
    // `l ĝ_l / Σ l ĝ_l` of the frames, `l` frames a gap.
    let per_gap = hidden_frames / lengths.mean_frames();
    let bins = lengths.bins().iter().rev();
    let floor = |expected: f64| (expected.floor(), expected - expected.floor());
    let mut carried = if rounding == Rounding::Systematic { dice.unit() } else { 0.0 };
    let mut counts = Vec::with_capacity(lengths.bins().len());
    for &(frames, share) in bins {
        let (mut count, rest) = floor(per_gap * share + carried);
        match rounding {
            Rounding::Floor => {}
            Rounding::Bernoulli => count += f64::from(dice.chance(rest)),
            Rounding::Systematic => carried = rest,
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, ≥ 0")]
        counts.push((frames, count as usize));
    }
    counts.into_iter().flat_map(|(frames, n)| std::iter::repeat_n(frames, n)).collect()
}

/// The histogram with only the gaps that a marker has room for; `None` where it has none.
pub(crate) fn fitting(
    lengths: &GapHistogram,
    longest: usize,
) -> Result<Option<GapHistogram>, AugmentError> {
    match lengths.clipped(1, longest) {
        Err(AugmentError::EmptyHistogram) => Ok(None),
        other => other.map(Some),
    }
}
