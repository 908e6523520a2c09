use std::ops::{ControlFlow, Range};

use mocap_core::{FillError, Filled, Gap, GapFiller, IterReport, Refusal, Take};

use super::{Curve, borders, fill};
use crate::quintic::Quintic;

/// Fewest samples in a row on either side.
const LEAST: usize = 5;

/// The spline fill of Vicon Nexus: a quintic spline through the samples right beside a gap.
///
/// A gap of N frames takes up to N / 2 + 5 samples in a row on each side as seeds. With fewer than 5 on
/// one of them it stays open, with [`Refusal::ShortSeed`]; at the start and the end of the take, with
/// [`Refusal::OneSided`].
///
/// Implements the Woltring fill of [Nexus], as its pipeline runs it, with the spline of [Woltring86].
/// Deviates from [Nexus]: seeds are the samples next to the gap, never a run farther away.
///
/// # When not to use
/// In gaps of more than a few tenths of a second: the curve overshoots, more than a cubic does.
///
/// # Cost
/// Linear in the frames of the gaps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct QuinticSpline;

impl GapFiller for QuinticSpline {
    fn name(&self) -> &'static str {
        "vicon-spline"
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        fill(take, self.name(), |_| (), |gap, ()| interpolate(take, gap))
    }
}

fn interpolate(take: &Take, gap: &Gap) -> Curve {
    if !matches!(borders(take, gap), (Some(_), Some(_))) {
        return Err(Refusal::OneSided);
    }
    let seeds: Vec<usize> = run_before(take, gap).chain(run_after(take, gap)).collect();
    let shorter = run_before(take, gap).len().min(run_after(take, gap).len());
    if shorter < LEAST {
        return Err(Refusal::ShortSeed { found: shorter, needed: LEAST });
    }
    let curves: [Quintic; 3] = std::array::from_fn(|axis| {
        let value = |&t: &usize| take.positions()[(t, gap.marker, axis)];
        Quintic::through(
            seeds.iter().map(|&t| t as f64).collect(),
            seeds.iter().map(value).collect(),
        )
    });
    let place = |t: usize| std::array::from_fn(|axis| curves[axis].at(t as f64));
    Ok(gap.frames.clone().map(place).collect())
}

/// As many samples as a gap may take on one side.
fn wanted(gap: &Gap) -> usize {
    gap.len() / 2 + LEAST
}

fn run_before(take: &Take, gap: &Gap) -> Range<usize> {
    let end = gap.frames.start;
    let first = (end.saturating_sub(wanted(gap))..end)
        .rev()
        .take_while(|&t| take.is_observed(t, gap.marker))
        .last();
    first.unwrap_or(end)..end
}

fn run_after(take: &Take, gap: &Gap) -> Range<usize> {
    let start = gap.frames.end;
    let last = (start..take.frames().min(start + wanted(gap)))
        .take_while(|&t| take.is_observed(t, gap.marker))
        .last();
    start..last.map_or(start, |t| t + 1)
}
