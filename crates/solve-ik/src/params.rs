use crate::IkError;

/// How to solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IkParams {
    /// How far a marker may miss at the price of one standard deviation of a joint, in metres, above 0.
    /// Default: 0.01, soft tissue included.
    pub marker_m: f64,
    /// Distance from which a marker pulls no harder, in metres, above 0: the bend of Huber's loss.
    /// Default: 0.02.
    pub robust_m: f64,
    /// How far a joint turns in a second by itself, as a standard deviation in radians, above 0; it holds joints
    /// that no marker shows. Default: 20.
    pub turn_rad_s: f64,
    /// Steps a frame at most, at least 1. Default: 8.
    pub iterations: usize,
    /// Frames to calibrate on, at least 1. Default: 60.
    pub calibration_frames: usize,
    /// Rounds of calibration; 0 takes the body as it is. Default: 2.
    pub calibration_rounds: usize,
}

impl Default for IkParams {
    fn default() -> Self {
        Self {
            marker_m: 0.01,
            robust_m: 0.02,
            turn_rad_s: 20.0,
            iterations: 8,
            calibration_frames: 60,
            calibration_rounds: 2,
        }
    }
}

impl IkParams {
    pub(crate) fn check(&self) -> Result<(), IkError> {
        for (field, value) in [
            ("marker_m", self.marker_m),
            ("robust_m", self.robust_m),
            ("turn_rad_s", self.turn_rad_s),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(IkError::Parameter { field, value, rule: "above 0 and finite" });
            }
        }
        for (field, value) in
            [("iterations", self.iterations), ("calibration_frames", self.calibration_frames)]
        {
            if value == 0 {
                return Err(IkError::Parameter { field, value: 0.0, rule: "at least 1" });
            }
        }
        Ok(())
    }
}
