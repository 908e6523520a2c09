mod model;

use std::ops::ControlFlow;

use mocap_core::{
    Estimates, FillError, FillReport, Filled, Gap, GapContext, GapFiller, IterReport, Refusal,
    Refused, Take, Termination,
    geometry::{add, scale, sub},
};

use model::{Columns, Model};

/// How [`Pca`] fills.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PcaParams {
    /// Distance over which a marker's weight falls off, as the standard deviation of a bell curve;
    /// positive. Default: 0.2 m, as published.
    pub sigma_m: f64,
    /// Weight of the missing marker itself, positive. Default: 0.02, as published.
    pub missing_weight: f64,
    /// A marker with gaps is left out if it is farther away than this share of the mean distance of all
    /// markers; 0 or more. Default: 0.5, as published.
    pub distal: f64,
    /// Share of the sum of singular values that the kept components reach, above 0 and at most 1.
    /// Default: 0.99, as published.
    pub cumulative: f64,
    /// Whether the error at the borders is carried linearly across the gap, so that the fill meets
    /// the samples beside it. Default: true; published without, by [Tits18] with.
    pub ramp: bool,
}

impl Default for PcaParams {
    fn default() -> Self {
        Self { sigma_m: 0.2, missing_weight: 0.02, distal: 0.5, cumulative: 0.99, ramp: true }
    }
}

impl PcaParams {
    fn validate(&self) -> Result<(), FillError> {
        let refuse = |field, value, rule| Err(FillError::Parameter { field, value, rule });
        for (field, value) in [("sigma_m", self.sigma_m), ("missing_weight", self.missing_weight)] {
            if !(value.is_finite() && value > 0.0) {
                return refuse(field, value, "positive and finite");
            }
        }
        if self.distal.is_nan() || self.distal < 0.0 {
            return refuse("distal", self.distal, "a number from 0");
        }
        if !(self.cumulative > 0.0 && self.cumulative <= 1.0) {
            return refuse("cumulative", self.cumulative, "above 0 and at most 1");
        }
        Ok(())
    }
}

/// Fills each marker from the principal components that it shares with the others.
///
/// Markers are seen from the mean of those that are never missing. For a gap of one marker, the others
/// that are seen throughout it count with a weight that falls off with their mean distance from the
/// missing one; far ones that have gaps themselves are left out. The frames that show all of them give
/// two sets of principal directions, with the missing marker and without. The frames of the gap are
/// projected on the second, then on the first, and the missing marker is read off.
///
/// Implements [Gloersen16] Eqs. (1)–(5), strategy R2. Deviates from [Gloersen16]: gaps of one marker are learnt one by one,
/// not together, so that a neighbour missing in one gap may help in another; neighbours with gaps never cost more than half of
/// the marker's frames; where no marker is complete, the neighbours' mean is the origin; the change
/// of basis is the orthogonal projection, which does not depend on the signs of the directions.
///
/// # When not to use
/// In a black-out. Where a marker was seen only in poses unlike those of the gap, the fill stays near its mean.
///
/// # Cost
/// For each set of neighbours of a marker one product of T frames and two decompositions of a
/// `(3M, 3M)` matrix; 3M operations a filled coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pca {
    params: PcaParams,
}

const NAME: &str = "pca";

impl Pca {
    /// A filler with these parameters.
    ///
    /// # Errors
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn new(params: PcaParams) -> Result<Self, FillError> {
        params.validate()?;
        Ok(Self { params })
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &PcaParams {
        &self.params
    }
}

impl GapFiller for Pca {
    fn name(&self) -> &'static str {
        NAME
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let gaps = take.gaps();
        if gaps.is_empty() {
            let report = FillReport::new(NAME, Termination::NothingToFill);
            return Ok(Filled::unchanged(take, report)?);
        }
        if take.observed().count() == 0 {
            return Err(FillError::NothingObserved);
        }
        let mut report = FillReport::new(NAME, Termination::ClosedForm);
        let mut positions = take.positions().to_owned();
        for of_marker in gaps.chunk_by(|g, h| g.marker == h.marker) {
            let columns = Columns::around(take, of_marker[0].marker, &self.params);
            let mut models: Vec<Model> = Vec::new();
            for gap in of_marker {
                match self.fill_gap(take, gap, &columns, &mut models)? {
                    Err(reason) => report.refusals.push(Refused { gap: gap.clone(), reason }),
                    Ok(curve) => {
                        for (t, p) in gap.frames.clone().zip(curve) {
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

impl Pca {
    /// One position a frame of the gap. `models` are those of the marker's gaps before this one.
    fn fill_gap(
        &self,
        take: &Take,
        gap: &Gap,
        columns: &Columns,
        models: &mut Vec<Model>,
    ) -> Result<Result<Vec<[f64; 3]>, Refusal>, FillError> {
        if gap.context(take.frames()) == GapContext::Whole {
            return Ok(Err(Refusal::NeverSeen));
        }
        let (neighbours, training) = match columns.choose(take, gap) {
            Err(refusal) => return Ok(Err(refusal)),
            Ok(chosen) => chosen,
        };
        let known = models.iter().position(|model| model.neighbours() == neighbours);
        let at = known.unwrap_or(models.len());
        if known.is_none() {
            models.push(Model::learn(take, columns, neighbours, &training, &self.params)?);
        }
        let model = &models[at];
        let curve: Option<Vec<_>> = gap.frames.clone().map(|t| model.predict(take, t)).collect();
        let Some(mut curve) = curve.filter(|c| c.iter().flatten().all(|x| x.is_finite())) else {
            return Ok(Err(Refusal::NotFinite));
        };
        if self.params.ramp {
            let error = |t: Option<usize>| {
                let t = t.filter(|&t| t < take.frames())?;
                Some(sub(take.position(t, gap.marker)?, model.predict(take, t)?))
            };
            let (before, after) =
                (error(gap.frames.start.checked_sub(1)), error(Some(gap.frames.end)));
            ramp(&mut curve, before, after);
        }
        Ok(Ok(curve))
    }
}

/// Adds the errors at the two borders, each fading linearly towards the other; a single one is carried as it is.
fn ramp(curve: &mut [[f64; 3]], before: Option<[f64; 3]>, after: Option<[f64; 3]>) {
    let (Some(before), Some(after)) = (before.or(after), after.or(before)) else { return };
    let steps = (curve.len() + 1) as f64;
    for (k, p) in (1_u32..).zip(curve) {
        let share = f64::from(k) / steps;
        *p = add(*p, add(scale(1.0 - share, before), scale(share, after)));
    }
}
