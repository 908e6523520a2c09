use std::ops::ControlFlow;

use mocap_core::{
    Estimates, FillError, FillReport, Filled, Gap, GapContext, GapFiller, IterReport, Refusal,
    Refused, Take, Termination,
};

use crate::{EdmParams, gap::MarkerFiller};

/// Fills gaps from distances to steady neighbours, interpolated between the borders of the gap.
///
/// Neighbours are the K markers that are seen throughout the gap and at its borders and whose
/// distance to the missing marker varies least. In each frame the squared distances are interpolated
/// between the borders, and the marker is placed so as to fit them ([`EdmSolver`](crate::EdmSolver)).
/// Steadier neighbours weigh more. The fill meets the observed samples by construction.
///
/// - With fewer than three neighbours throughout, each frame takes those that it shows.
/// - Gaps at the start or the end of the take keep the distances of their one border.
/// - The side of a plane of neighbours is that of the borders' positions carried rigidly along; where
///   the plane is so flat that the height is ill-determined, those positions take over.
/// - With one or two neighbours, or neighbours on a line, the distances are kept and the direction is
///   interpolated.
/// - Without any neighbour the gap stays open.
///
/// Deviates from [Pan23] §3.1: handedness, degenerate neighbours and one-sided gaps, of which the
/// paper says nothing, and weights.
///
/// # Cost
/// Linear in the frames: distances to all markers for each marker that has gaps, then a few
/// thousand operations a missing sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edm {
    params: EdmParams,
}

impl Edm {
    /// A filler with these parameters.
    ///
    /// # Errors
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn new(params: EdmParams) -> Result<Self, FillError> {
        params.validate()?;
        Ok(Self { params })
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &EdmParams {
        &self.params
    }
}

impl GapFiller for Edm {
    fn name(&self) -> &'static str {
        "edm"
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
        for of_marker in gaps.chunk_by(|g, h| g.marker == h.marker) {
            for (gap, filled) in fill_marker(take, &self.params, of_marker) {
                match filled {
                    Err(reason) => report.refusals.push(Refused { gap: gap.clone(), reason }),
                    Ok(filled) => {
                        for (t, p) in gap.frames.clone().zip(filled) {
                            for (axis, c) in p.into_iter().enumerate() {
                                positions[(t, gap.marker, axis)] = c;
                            }
                        }
                    }
                }
            }
        }
        Ok(Filled::merge(take, Estimates { positions, sigma_m: None }, report)?)
    }
}

type Outcome = Result<Vec<[f64; 3]>, Refusal>;

fn fill_marker<'a>(take: &Take, params: &EdmParams, gaps: &'a [Gap]) -> Vec<(&'a Gap, Outcome)> {
    if gaps[0].context(take.frames()) == GapContext::Whole {
        return vec![(&gaps[0], Err(Refusal::NeverSeen))];
    }
    let filler = MarkerFiller::new(take, params, gaps[0].marker);
    gaps.iter().map(|gap| (gap, filler.fill(gap))).collect()
}
