use thiserror::Error;

/// Thresholds of [`FaultDetector`](crate::FaultDetector), in metres and seconds whatever the rate.
///
/// ```
/// use marker_faults::{FaultDetector, FaultParams};
///
/// assert!(FaultDetector::new(FaultParams { size_m: 0.02, ..FaultParams::default() }).is_ok());
/// let error = FaultDetector::new(FaultParams { size_m: 0.0, ..FaultParams::default() }).unwrap_err();
/// assert_eq!(error.to_string(), "parameter `size_m` is 0; it must be positive and finite");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaultParams {
    /// Smallest deviation of a spike from the path through the samples on either side, in metres. Two
    /// or three equal ones in a row show a third of their size. Default: 0.008.
    pub size_m: f64,
    /// Smallest step onto a spike, a jump, a swap or junk beside a gap, in metres. Default: 0.025.
    pub step_m: f64,
    /// Acceleration that a marker may have beyond that of the markers around it, in m/s². Deviations
    /// that it can explain within a frame are none: at 30 Hz a blow looks like a spike. Default: 100.
    pub acceleration: f64,
    /// Longest jump away from the path and back, in seconds. Default: 0.5.
    pub longest_jump_s: f64,
    /// How far from a gap junk may reach, in seconds. Default: 0.05.
    pub edge_s: f64,
    /// A ghost moves by no more than this, in metres. Default: 0.003.
    pub still_m: f64,
    /// A ghost's distance to every moving marker changes by at least this, in metres. Default: 0.3.
    pub strange_m: f64,
    /// Distances may leave the range in which nine tenths of them lie by this share of it. Default: 0.5.
    pub delta: f64,
    /// And by this much in any case, in metres. Default: 0.03.
    pub slack_m: f64,
}

impl Default for FaultParams {
    fn default() -> Self {
        Self {
            size_m: 0.008,
            step_m: 0.025,
            acceleration: 100.0,
            longest_jump_s: 0.5,
            edge_s: 0.05,
            still_m: 0.003,
            strange_m: 0.3,
            delta: 0.5,
            slack_m: 0.03,
        }
    }
}

/// A threshold out of its range.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("parameter `{field}` is {value}; it must be positive and finite")]
pub struct ParameterError {
    /// Name of the parameter.
    pub field: &'static str,
    /// The value as given.
    pub value: f64,
}

impl FaultParams {
    pub(crate) fn validate(&self) -> Result<(), ParameterError> {
        let fields = [
            ("size_m", self.size_m),
            ("step_m", self.step_m),
            ("acceleration", self.acceleration),
            ("longest_jump_s", self.longest_jump_s),
            ("edge_s", self.edge_s),
            ("still_m", self.still_m),
            ("strange_m", self.strange_m),
            ("delta", self.delta),
            ("slack_m", self.slack_m),
        ];
        match fields.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            Some((field, value)) => Err(ParameterError { field, value }),
            None => Ok(()),
        }
    }

    /// The share of the smallest step that the allowed acceleration makes within a frame, at most 1.
    pub(crate) fn allowance(&self, rate_hz: f64) -> f64 {
        (self.acceleration / (rate_hz * rate_hz * self.step_m)).min(1.0)
    }

    /// The limit in metres for a deviation that may be as small as `least_m`, at this rate.
    pub(crate) fn limit_m(&self, least_m: f64, rate_hz: f64) -> f64 {
        least_m.max(self.acceleration / (rate_hz * rate_hz))
    }
}
