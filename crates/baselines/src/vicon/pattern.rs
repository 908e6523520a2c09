use std::ops::ControlFlow;

use mocap_core::{
    FillError, Filled, Gap, GapFiller, IterReport, Refusal, Take,
    geometry::{add, scale, sub},
};

use super::{Curve, borders, fill, steadiest};

/// The pattern fill of Vicon Nexus: the gap copies the shape of one donor's path.
///
/// The donor's path less the straight line between its own positions at the borders is added to the
/// straight line across the gap. The donor is the marker at the steadiest distance. If it is missing
/// anywhere from border to border, the gap stays open with [`Refusal::DonorMissing`]; at the start
/// and the end of the take, with [`Refusal::OneSided`].
///
/// Implements the pattern fill of [Nexus]. Deviates from [Nexus]: there the user names the donor.
///
/// # When not to use
/// Where the body part turns: a copy of a path knows no rotation.
///
/// # Cost
/// Linear in frames times markers for each marker that has gaps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PatternFill;

impl GapFiller for PatternFill {
    fn name(&self) -> &'static str {
        "vicon-pattern"
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let donor = |marker| steadiest(take, marker).first().copied();
        fill(take, self.name(), donor, |gap, donor| {
            copy(take, gap, donor.ok_or(Refusal::NoNeighbour)?)
        })
    }
}

fn copy(take: &Take, gap: &Gap, donor: usize) -> Curve {
    let (Some(before), Some(after)) = borders(take, gap) else { return Err(Refusal::OneSided) };
    // The borders of the marker itself are observed, so its offset to the donor is known there.
    let offset = |t: usize| Some(sub(take.position(t, gap.marker)?, take.position(t, donor)?));
    let curve = || -> Option<Vec<_>> {
        let (from, to) = (offset(before)?, offset(after)?);
        let place = |t: usize| {
            let share = (t - before) as f64 / (after - before) as f64;
            let between = add(scale(1.0 - share, from), scale(share, to));
            Some(add(take.position(t, donor)?, between))
        };
        gap.frames.clone().map(place).collect()
    };
    curve().ok_or(Refusal::DonorMissing { donor })
}
