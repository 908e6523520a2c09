use mocap_core::{Mask, Take};

use crate::{
    MetricError,
    error::{check_mask, check_takes},
    stats::Moments,
};

/// Accelerations and jerks of a fill beside those of the truth.
///
/// A ratio far above 1 is a fill that shakes or jumps, one far below 1 a fill that is too smooth to be
/// the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothness {
    /// Frames, counted marker by marker, over which accelerations were taken.
    pub acceleration_samples: usize,
    /// Root mean square acceleration of the fill in m/s²; NaN without samples.
    pub acceleration_rms_m_s2: f64,
    /// The same of the truth.
    pub true_acceleration_rms_m_s2: f64,
    /// Fill by truth; NaN without samples, or if the truth has no acceleration.
    pub acceleration_ratio: f64,
    /// Frames, counted marker by marker, over which jerks were taken.
    pub jerk_samples: usize,
    /// Root mean square jerk of the fill in m/s³; NaN without samples.
    pub jerk_rms_m_s3: f64,
    /// The same of the truth.
    pub true_jerk_rms_m_s3: f64,
    /// Fill by truth; NaN without samples, or if the truth has no jerk.
    pub jerk_ratio: f64,
}

/// Second differences of neighbouring frames.
const ACCELERATION: [f64; 3] = [1.0, -2.0, 1.0];
/// Third differences.
const JERK: [f64; 4] = [-1.0, 3.0, -3.0, 1.0];

/// Accelerations and jerks, as differences of neighbouring frames of one marker, wherever at least one
/// of the frames is hidden and both takes show all of them. Steps at the borders of a gap are included.
///
/// # Units
/// m/s² and m/s³ by the rate of the truth.
///
/// # Errors
/// [`MetricError::Shape`] and [`MetricError::Markers`] if the three are not of one take,
/// [`MetricError::NoHiddenCell`] if `hidden` holds no cell that `truth` shows.
pub fn smoothness(truth: &Take, filled: &Take, hidden: &Mask) -> Result<Smoothness, MetricError> {
    check_takes(truth, filled)?;
    check_mask(truth, "the hidden mask", hidden)?;
    if !hidden.iter().any(|(t, m)| truth.is_observed(t, m)) {
        return Err(MetricError::NoHiddenCell);
    }
    let rate = truth.rate_hz();
    let second = Differences::of(truth, filled, hidden, ACCELERATION).scaled(rate.powi(2));
    let third = Differences::of(truth, filled, hidden, JERK).scaled(rate.powi(3));
    Ok(Smoothness {
        acceleration_samples: second.samples,
        acceleration_rms_m_s2: second.filled,
        true_acceleration_rms_m_s2: second.truth,
        acceleration_ratio: second.ratio(),
        jerk_samples: third.samples,
        jerk_rms_m_s3: third.filled,
        true_jerk_rms_m_s3: third.truth,
        jerk_ratio: third.ratio(),
    })
}

/// Root mean squares of a difference over neighbouring frames.
struct Differences {
    samples: usize,
    truth: f64,
    filled: f64,
}

impl Differences {
    fn of<const N: usize>(truth: &Take, filled: &Take, hidden: &Mask, weights: [f64; N]) -> Self {
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for m in 0..truth.marker_count() {
            for start in 0..truth.frames().saturating_sub(N - 1) {
                if !(start..start + N).any(|t| hidden.contains(t, m)) {
                    continue;
                }
                let size = |take| difference(take, m, start, weights);
                if let (Some(a), Some(b)) = (size(truth), size(filled)) {
                    theirs.push(a);
                    ours.push(b);
                }
            }
        }
        let rms = |sizes: Vec<f64>| Moments::of(sizes).rms;
        Self { samples: ours.len(), truth: rms(theirs), filled: rms(ours) }
    }

    fn scaled(self, factor: f64) -> Self {
        Self { truth: factor * self.truth, filled: factor * self.filled, ..self }
    }

    fn ratio(&self) -> f64 {
        if self.truth > 0.0 { self.filled / self.truth } else { f64::NAN }
    }
}

/// Length of the weighted sum of positions from `start` on, if all are there.
fn difference<const N: usize>(
    take: &Take,
    marker: usize,
    start: usize,
    weights: [f64; N],
) -> Option<f64> {
    let mut sum = [0.0; 3];
    for (k, weight) in weights.into_iter().enumerate() {
        let position = take.position(start + k, marker)?;
        sum.iter_mut().zip(position).for_each(|(s, x)| *s += weight * x);
    }
    Some(mocap_core::geometry::norm(sum))
}
