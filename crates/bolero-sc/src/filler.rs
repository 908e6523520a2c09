use std::ops::ControlFlow;

use lds_kalman::filler::fill_with;
use mocap_core::{FillError, Filled, GapFiller, IterReport, Take};

use crate::{BoleroScParams, SoftBones};

/// Fills gaps with a linear dynamical system that keeps bone lengths softly.
///
/// The objective it reports is the log-likelihood of the filled take; the bones are not in it.
///
/// Implements [Li10] Algorithm 2.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BoleroSc {
    params: BoleroScParams,
}

impl BoleroSc {
    /// A filler with these parameters.
    ///
    /// # Errors
    ///
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn new(params: BoleroScParams) -> Result<Self, FillError> {
        params.validate()?;
        Ok(Self { params })
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &BoleroScParams {
        &self.params
    }
}

impl GapFiller for BoleroSc {
    fn name(&self) -> &'static str {
        "bolero-sc"
    }

    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let BoleroScParams { model, lambda, bones, untied, solver } = &self.params;
        let bones = bones.find(take)?;
        let hook = |columns: &_| {
            let hook = SoftBones::new(columns, &bones, *lambda, *solver).with_untied(*untied);
            Ok(Box::new(hook) as Box<dyn lds_kalman::MissingUpdate>)
        };
        fill_with("bolero-sc", take, model, hook, observer)
    }
}
