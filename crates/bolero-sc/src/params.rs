use lds_kalman::{EStep, filler::LdsFillerParams};
use mocap_core::{BoneSource, FillError};

use crate::solver::Solver;

/// What becomes of fills that no bone ties to a visible marker, in frames that show fewer than six
/// markers, where fills count as observed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Untied {
    /// They are missing: the states are estimated without them, and they take the prediction, as
    /// in the exact system. EM then starts from the data's subspace, because a random transition
    /// grows what it predicts through frames that show nothing.
    #[default]
    Missing,
    /// They count as observed too, as published. They then hold on to what filled the gap first.
    Observed,
}

/// How [`BoleroSc`](crate::BoleroSc) fills.
#[derive(Debug, Clone, PartialEq)]
pub struct BoleroScParams {
    /// The linear dynamical system and how it is learnt.
    pub model: LdsFillerParams,
    /// Weight of the bones, finite and 0 or more; 0 leaves the bones out. Default 1e6, as in
    /// [Li10] §4.
    ///
    /// # Units
    ///
    /// It multiplies squared differences of squared metres and stands beside squared metres over
    /// the noise variance in m², so it is measured in m⁻⁴.
    pub lambda: f64,
    /// Where the bones come from.
    pub bones: BoneSource,
    /// What becomes of fills that rest on next to nothing.
    pub untied: Untied,
    /// How the missing markers of a frame are found.
    pub solver: Solver,
}

impl Default for BoleroScParams {
    /// Exact EM from the data's own subspace, with the weight of [Li10].
    fn default() -> Self {
        Self {
            model: LdsFillerParams::default(),
            lambda: 1e6,
            bones: BoneSource::default(),
            untied: Untied::default(),
            solver: Solver::default(),
        }
    }
}

impl BoleroScParams {
    /// The settings of [Li10] §4: fills count as observed, a random start, body-local coordinates
    /// with their own origin. The solver is still the converged one, and the bones and the body
    /// frame are those of the visible samples.
    #[must_use]
    pub fn published() -> Self {
        let e_step = EStep::FilledAsObserved;
        let model = LdsFillerParams { e_step, ..LdsFillerParams::published() };
        Self { model, untied: Untied::Observed, ..Self::default() }
    }

    pub(crate) fn validate(&self) -> Result<(), FillError> {
        self.model.validate()?;
        if self.lambda.is_finite() && self.lambda >= 0.0 {
            return Ok(());
        }
        let (field, value) = ("lambda", self.lambda);
        Err(FillError::Parameter { field, value, rule: "a finite number from 0" })
    }
}
