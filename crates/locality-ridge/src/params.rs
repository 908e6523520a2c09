use mocap_core::FillError;

/// How the regression's error at the borders of a gap is carried across it.
///
/// At both borders the truth is known, and so is the error of the regression there. Subtracting it
/// makes the fill meet the observed samples; in between it is the guess of one of these models.
/// Where a gap has one border only, that border's error is carried alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Residual {
    /// From one border's error to the other's in a straight line; one border's error stays constant.
    #[default]
    Ramp,
    /// Kriging with the kernel exp(−|Δt| / τ): the error fades away from the borders.
    Exponential {
        /// The length τ of the kernel, positive and finite.
        ///
        /// # Units
        /// Seconds.
        tau_s: f64,
    },
}

/// Parameters of [`LocalRidge`](crate::LocalRidge).
///
/// ```
/// use locality_ridge::{LocalRidge, LocalRidgeParams, Residual};
///
/// let fades = LocalRidgeParams {
///     residual: Residual::Exponential { tau_s: 0.25 },
///     ..LocalRidgeParams::default()
/// };
/// assert!(LocalRidge::new(fades).is_ok());
///
/// let error = LocalRidge::new(LocalRidgeParams { core: 2, ..fades }).unwrap_err();
/// assert_eq!(error.to_string(), "parameter `core` is 2; it must be at least 3");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalRidgeParams {
    /// Neighbours whose rigid fit defines the local frame, at least 3; 6 by default.
    pub core: usize,
    /// Neighbours to regress on, the core among them, at least `core`; 6 by default.
    pub regressors: usize,
    /// Strength ρ of the penalty, positive and finite; 1e-3 by default. The penalty is
    /// λ = ρ · (training frames) · (mean variance of a regressor's coordinate), so ρ has no unit and
    /// does not depend on the length of the take.
    pub ridge: f64,
    /// How the error at the borders is carried across a gap; a ramp by default.
    pub residual: Residual,
    /// Largest standard deviation of a neighbour's distance to the marker, positive; 0.5 m by default.
    /// Markers beyond it belong to another body.
    ///
    /// # Units
    /// Metres.
    pub max_spread_m: f64,
    /// Frames that must show the marker and its neighbours together, at least 2; 10 by default.
    pub min_training: usize,
}

impl Default for LocalRidgeParams {
    fn default() -> Self {
        Self {
            core: 6,
            regressors: 6,
            ridge: 1e-3,
            residual: Residual::Ramp,
            max_spread_m: 0.5,
            min_training: 10,
        }
    }
}

impl LocalRidgeParams {
    pub(crate) fn validate(&self) -> Result<(), FillError> {
        at_least("core", self.core, 3, "at least 3")?;
        at_least("regressors", self.regressors, self.core, "at least `core`")?;
        at_least("min_training", self.min_training, 2, "at least 2")?;
        positive("ridge", self.ridge)?;
        positive("max_spread_m", self.max_spread_m)?;
        match self.residual {
            Residual::Ramp => Ok(()),
            Residual::Exponential { tau_s } => positive("tau_s", tau_s),
        }
    }
}

fn at_least(
    field: &'static str,
    value: usize,
    least: usize,
    rule: &'static str,
) -> Result<(), FillError> {
    if value >= least {
        return Ok(());
    }
    Err(FillError::Parameter { field, value: value as f64, rule })
}

fn positive(field: &'static str, value: f64) -> Result<(), FillError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(FillError::Parameter { field, value, rule: "positive and finite" })
}
