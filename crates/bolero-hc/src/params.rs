use lds_kalman::{EStep, filler::LdsFillerParams};
use mocap_core::{BoneSource, FillError};

/// How [`BoleroHc`](crate::BoleroHc) fills.
#[derive(Debug, Clone, PartialEq)]
pub struct BoleroHcParams {
    /// The linear dynamical system and how it is learnt. At least 2 iterations where fills count
    /// as observed, since the first one then keeps the interpolation.
    pub model: LdsFillerParams,
    /// EM iteration from which the bones act, counted from 1, at least 1. Default 11, as in the
    /// authors' code: before, the model knows too little to choose between the places that the
    /// bones allow. Where EM ends earlier, the bones act in its last iteration.
    pub first_iteration: usize,
    /// Where the bones come from.
    pub bones: BoneSource,
}

impl Default for BoleroHcParams {
    /// Exact EM from the data's own subspace.
    fn default() -> Self {
        let model = LdsFillerParams::default();
        Self { model, first_iteration: 11, bones: BoneSource::default() }
    }
}

impl BoleroHcParams {
    /// The settings of [Li10] §4: fills count as observed, a random start, body-local coordinates
    /// with their own origin. The bones and the body frame are those of the visible samples.
    #[must_use]
    pub fn published() -> Self {
        let e_step = EStep::FilledAsObserved;
        let model = LdsFillerParams { e_step, ..LdsFillerParams::published() };
        Self { model, ..Self::default() }
    }

    /// The first iteration in which the bones can act.
    pub(crate) fn earliest(&self) -> usize {
        if self.model.e_step == EStep::FilledAsObserved { 2 } else { 1 }
    }

    pub(crate) fn validate(&self) -> Result<(), FillError> {
        self.model.validate()?;
        let refuse = |field, value: usize, rule| {
            Err(FillError::Parameter { field, value: value as f64, rule })
        };
        if self.model.iterations < self.earliest() {
            let rule = "at least 2 where fills count as observed";
            return refuse("iterations", self.model.iterations, rule);
        }
        if self.first_iteration == 0 {
            return refuse("first_iteration", 0, "at least 1");
        }
        Ok(())
    }
}
