use std::ops::Range;

use mocap_core::{CoreError, Mask, Take};

use crate::{
    AugmentError, Neighbours,
    dice::{Dice, Stream},
    error::check,
    protocol::check_segment,
};

/// How markers are swapped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SwapParams {
    /// Number of swaps. Default: 1.
    pub count: usize,
    /// Fewest frames of a swap, from 1. Default: 1.
    pub shortest_frames: usize,
    /// Most frames of a swap, from `shortest_frames`; the take sets a bound, too. Default: 120, a second at 120 Hz.
    pub longest_frames: usize,
    /// A marker is swapped with one of this many nearest markers, from 1: labels are mixed up
    /// between markers that come close. Default: 3.
    pub reach: usize,
    /// Seed. Default: 0.
    pub seed: u64,
}

impl Default for SwapParams {
    fn default() -> Self {
        Self { count: 1, shortest_frames: 1, longest_frames: 120, reach: 3, seed: 0 }
    }
}

/// Two markers that carry each other's label for a while.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Swap {
    /// The marker indices, lower one first.
    pub markers: (usize, usize),
    /// Zero-based frames, end exclusive.
    pub frames: Range<usize>,
}

/// A take with mixed-up labels.
#[derive(Debug, Clone)]
pub struct Swapped {
    /// The take as a filler or a detector would see it.
    pub take: Take,
    /// What was swapped, in the order it was drawn. No two swaps share a cell.
    pub swaps: Vec<Swap>,
}

/// Tries per swap before the take counts as full.
const TRIES: usize = 64;

/// Exchanges the labels of two markers in the frames, gaps included. Doing it again undoes it.
///
/// # Errors
/// [`AugmentError::Segment`], [`AugmentError::SelfSwap`], and [`AugmentError::Core`] for a marker that is
/// not there.
pub fn swap_pair(
    take: &Take,
    a: usize,
    b: usize,
    frames: Range<usize>,
) -> Result<Take, AugmentError> {
    check_segment(&frames, take.frames())?;
    if a == b {
        return Err(AugmentError::SelfSwap { marker: a });
    }
    if let Some(&marker) = [a, b].iter().find(|&&m| m >= take.marker_count()) {
        let (frame, markers) = (frames.start, take.marker_count());
        return Err(CoreError::OutOfRange { frame, marker, frames: take.frames(), markers }.into());
    }
    apply(take, &[Swap { markers: (a, b), frames }])
}

/// Exchanges the labels of random pairs of near markers for random runs of frames.
///
/// Each swap is of a pair of which something is observed, clear of the swaps before it. Where 64
/// tries find none, the rest is left out: `swaps` then holds fewer than asked for.
///
/// # Errors
/// [`AugmentError::OutOfRange`] and [`AugmentError::EmptyTake`];
/// [`AugmentError::MarkerCount`] for a take of one marker.
pub fn swap_markers(take: &Take, params: &SwapParams) -> Result<Swapped, AugmentError> {
    let SwapParams { count, shortest_frames: shortest, longest_frames: longest, reach, seed } =
        *params;
    let near = Neighbours::by_mean_distance(take)?;
    if take.marker_count() < 2 {
        return Err(AugmentError::MarkerCount { wanted: 2, found: take.marker_count() });
    }
    check("shortest_frames", shortest as f64, 1.0, take.frames() as f64)?;
    check("longest_frames", longest as f64, shortest as f64, f64::MAX)?;
    check("reach", reach as f64, 1.0, f64::MAX)?;
    let longest = longest.min(take.frames());
    let mut dice = Dice::new(seed, Stream::Swaps);
    let mut swaps: Vec<Swap> = Vec::new();
    for _ in 0..count {
        let mut random = || {
            let a = dice.below(take.marker_count());
            let length = shortest + dice.below(longest - shortest + 1);
            let start = dice.below(take.frames() - length + 1);
            let close = &near.of(a)[..reach.min(near.of(a).len())];
            let b = *close.get(dice.below(close.len()))?;
            Some(Swap { markers: (a.min(b), a.max(b)), frames: start..start + length })
        };
        let is_good = |swap: &Swap| {
            changes_something(take, swap) && swaps.iter().all(|other| !share_a_cell(swap, other))
        };
        let Some(found) = (0..TRIES).filter_map(|_| random()).find(is_good) else { break };
        swaps.push(found);
    }
    Ok(Swapped { take: apply(take, &swaps)?, swaps })
}

fn changes_something(take: &Take, swap: &Swap) -> bool {
    let (a, b) = swap.markers;
    swap.frames.clone().any(|t| take.is_observed(t, a) || take.is_observed(t, b))
}

fn share_a_cell(one: &Swap, other: &Swap) -> bool {
    let (a, b) = one.markers;
    let has = |m: usize| m == other.markers.0 || m == other.markers.1;
    let meet = one.frames.start < other.frames.end && other.frames.start < one.frames.end;
    meet && (has(a) || has(b))
}

fn apply(take: &Take, swaps: &[Swap]) -> Result<Take, AugmentError> {
    let mut positions = take.positions().to_owned();
    let mut seen = take.observed().view().to_owned();
    for Swap { markers: (a, b), frames } in swaps {
        for t in frames.clone() {
            (0..3).for_each(|axis| positions.swap((t, *a, axis), (t, *b, axis)));
            seen.swap((t, *a), (t, *b));
        }
    }
    let observed = Mask::from_fn(take.frames(), take.marker_count(), |t, m| seen[(t, m)]);
    Ok(Take::new(take.markers().clone(), take.rate_hz(), positions, observed)?)
}
