use std::ops::ControlFlow;

use mocap_core::{
    Estimates, FillError, FillReport, Filled, Gap, GapContext, GapFiller, IterReport, Refusal,
    Refused, Take, Termination,
};
use ndarray::Array2;

use crate::{
    LocalRidgeParams,
    gap::{Bridge, MarkerFiller},
};

/// Fills each gap by a ridge regression of the marker on its steadiest neighbours.
///
/// For one gap:
/// 1. Candidates are the markers that are seen in all of its frames and at its borders, ranked by
///    the variance of their distance to the missing marker. The first `core` carry a local frame,
///    the first `regressors` are regressed on.
/// 2. Frames that show the marker and all regressors train the regression of its local coordinates
///    on theirs. Predictions lie at most three times as far from the mean as they do, or 5 cm.
/// 3. The regression's error at the borders is carried across the gap ([`Residual`](crate::Residual)),
///    so the fill meets the observed samples.
///
/// Where fewer than four near candidates are seen throughout, the gap is cut into segments with
/// constant neighbours; the step between two segments is spread over 0.1 s on either side. With
/// fewer than three neighbours, or neighbours on a line, the local frame is their centre and does
/// not turn. Frames that show no neighbour at all are bridged by a straight line for up to 0.1 s;
/// gaps with a longer black-out stay open.
///
/// Each filled sample has a standard deviation: the root mean square of the 3-D error that the
/// regression makes on eight runs of training frames predicted without themselves, less what is
/// known of it from the borders. It grows from zero at a border at the rate at which those errors
/// change over time. In gaps that are cut it leaves out what the joints add, and is too small where few
/// frames are left to learn from.
///
/// # Cost
/// Linear in the frames of the take for each set of neighbours; memory too.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LocalRidge {
    params: LocalRidgeParams,
}

impl LocalRidge {
    /// A filler with these parameters.
    ///
    /// # Errors
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn new(params: LocalRidgeParams) -> Result<Self, FillError> {
        params.validate()?;
        Ok(Self { params })
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &LocalRidgeParams {
        &self.params
    }
}

impl GapFiller for LocalRidge {
    fn name(&self) -> &'static str {
        "ridge"
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let gaps = take.gaps();
        if gaps.is_empty() {
            let report = FillReport::new(self.name(), Termination::NothingToFill);
            return Ok(Filled::unchanged(take, report)?);
        }
        if take.observed().count() == 0 {
            return Err(FillError::NothingObserved);
        }
        let mut report = FillReport::new(self.name(), Termination::ClosedForm);
        let mut positions = take.positions().to_owned();
        let mut sigma_m = Array2::from_elem((take.frames(), take.marker_count()), f64::NAN);
        for of_marker in gaps.chunk_by(|g, h| g.marker == h.marker) {
            for (gap, bridge) in fill_marker(take, &self.params, of_marker) {
                match bridge {
                    Err(reason) => report.refusals.push(Refused { gap: gap.clone(), reason }),
                    Ok(bridge) => {
                        let filled = bridge.positions.iter().zip(&bridge.sigma_m);
                        for (t, (p, sigma)) in gap.frames.clone().zip(filled) {
                            sigma_m[(t, gap.marker)] = *sigma;
                            for (axis, c) in p.iter().enumerate() {
                                positions[(t, gap.marker, axis)] = *c;
                            }
                        }
                    }
                }
            }
        }
        Ok(Filled::merge(take, Estimates { positions, sigma_m: Some(sigma_m) }, report)?)
    }
}

fn fill_marker<'a>(
    take: &Take,
    params: &LocalRidgeParams,
    gaps: &'a [Gap],
) -> Vec<(&'a Gap, Result<Bridge, Refusal>)> {
    if gaps[0].context(take.frames()) == GapContext::Whole {
        return vec![(&gaps[0], Err(Refusal::NeverSeen))];
    }
    let mut filler = MarkerFiller::new(take, params, gaps[0].marker);
    gaps.iter().map(|gap| (gap, filler.fill(gap))).collect()
}
