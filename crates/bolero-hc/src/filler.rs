use std::ops::ControlFlow;

use lds_kalman::filler::fill_with;
use mocap_core::{BoneSet, FillError, Filled, GapFiller, IterReport, Take, Termination};

use crate::{BoleroHcParams, HardBones};

/// Fills gaps with a linear dynamical system whose fills keep bone lengths exactly.
///
/// The objective it reports is the log-likelihood of the filled take. Frames in which the bones could not
/// be kept are listed in [`FillReport::bones`](mocap_core::FillReport::bones), measured on the finished take.
///
/// Implements [Li10] Algorithm 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BoleroHc {
    params: BoleroHcParams,
}

impl BoleroHc {
    /// A filler with these parameters.
    ///
    /// # Errors
    ///
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn new(params: BoleroHcParams) -> Result<Self, FillError> {
        params.validate()?;
        Ok(Self { params })
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &BoleroHcParams {
        &self.params
    }

    fn fill_from(
        &self,
        take: &Take,
        bones: &BoneSet,
        first_iteration: usize,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let hook = |columns: &_| {
            let hook = HardBones::new(columns, bones, first_iteration);
            Ok(Box::new(hook) as Box<dyn lds_kalman::MissingUpdate>)
        };
        fill_with("bolero-hc", take, &self.params.model, hook, observer)
    }
}

impl GapFiller for BoleroHc {
    fn name(&self) -> &'static str {
        "bolero-hc"
    }

    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let bones = self.params.bones.find(take)?;
        let first = self.params.first_iteration;
        let mut filled = self.fill_from(take, &bones, first, observer)?;
        let done = filled.report().iterations;
        if (1..first).contains(&done) {
            // EM ended before the bones came in: they act on its last iterations instead.
            let stopped = filled.report().termination == Termination::Stopped;
            let last = done.max(self.params.earliest());
            filled = self.fill_from(take, &bones, last, &mut |report| match report.iteration {
                i if i >= last && stopped => ControlFlow::Break(()),
                i if i <= done => ControlFlow::Continue(()),
                _ => observer(report),
            })?;
        }
        Ok(filled.measure_bones(&bones))
    }
}
