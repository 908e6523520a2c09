use metrics::{Calibration, MetricError, Score};
use mocap_core::{BoneSet, Filled, Holdout};
use serde::{Deserialize, Serialize};

use crate::{
    Sureness,
    sureness::{LENGTH_EDGES_S, MULTIPLES},
};

/// What became of one cell of the matrix.
///
/// Errors are `None` where no hidden sample was filled.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Mean square error per hidden coordinate in m², over the samples that were filled.
    pub mse_m2: Option<f64>,
    /// Mean 3-D error in mm.
    pub mean_mm: Option<f64>,
    /// Median 3-D error in mm.
    pub median_mm: Option<f64>,
    /// 95 % quantile of the 3-D error in mm.
    pub p95_mm: Option<f64>,
    /// Mean deviation in mm from the true mean bone lengths, over the bones that touch a hidden sample.
    pub bone_mm: Option<f64>,
    /// Lengths that `bone_mm` is the mean of; 0 where no bone touches a hidden sample.
    pub bone_samples: usize,
    /// Mean step at the borders of the gaps in mm.
    pub border_mm: Option<f64>,
    /// Root mean square acceleration, fill by truth.
    pub acceleration_ratio: Option<f64>,
    /// Root mean square jerk, fill by truth.
    pub jerk_ratio: Option<f64>,
    /// Hidden samples.
    pub hidden: usize,
    /// Hidden samples that were left open.
    pub unfilled: usize,
    /// The figures by class of gap length; classes without gaps are left out.
    pub by_length: Vec<LengthOutcome>,
    /// Iterations done.
    pub iterations: usize,
    /// Why the method ended.
    pub termination: String,
    /// Time of the fill in seconds, on one thread.
    pub seconds: f64,
    /// Why the method could not run.
    pub error: Option<String>,
}

/// The figures of the gaps of one class of lengths.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LengthOutcome {
    /// The class: the place of its upper edge in [`LENGTH_EDGES_S`].
    pub class: usize,
    /// Mean square error per hidden coordinate in m².
    pub mse_m2: Option<f64>,
    /// Mean 3-D error in mm.
    pub mean_mm: Option<f64>,
    /// Median 3-D error in mm.
    pub median_mm: Option<f64>,
    /// 95 % quantile of the 3-D error in mm.
    pub p95_mm: Option<f64>,
    /// Hidden samples.
    pub hidden: usize,
    /// Hidden samples that were left open.
    pub unfilled: usize,
    /// Errors beside what the method said of them.
    pub sureness: Sureness,
}

impl Outcome {
    /// Whether two outcomes are the same but for the time they took.
    #[must_use]
    pub fn same_result(&self, other: &Self) -> bool {
        Self { seconds: 0.0, ..self.clone() } == Self { seconds: 0.0, ..other.clone() }
    }

    /// Errors beside what the method said of them, over gaps of all lengths.
    #[must_use]
    pub fn sureness(&self) -> Sureness {
        Sureness::sum(self.by_length.iter().map(|class| &class.sureness))
    }

    /// Scores a fill against the truth and the bones of the complete motion.
    pub(crate) fn of(
        holdout: &Holdout,
        filled: &Filled,
        bones: &BoneSet,
        seconds: f64,
    ) -> Result<Self, MetricError> {
        let (truth, take, hidden) = (holdout.truth(), filled.take(), holdout.hidden());
        let score = metrics::score(truth, take, hidden)?;
        let deviation = metrics::bone_deviation(take, bones, Some(hidden))?;
        let smoothness = metrics::smoothness(truth, take, hidden)?;
        let lengths = metrics::by_gap_length(truth, take, hidden, &LENGTH_EDGES_S)?;
        let sure =
            metrics::calibration_by_gap_length(truth, filled, hidden, &MULTIPLES, &LENGTH_EDGES_S)?;
        let by_length = lengths.iter().zip(&sure).enumerate();
        let steps: Vec<f64> =
            metrics::border_steps(filled).iter().filter_map(|(_, step)| step.max_mm()).collect();
        Ok(Self {
            mse_m2: finite(score.mse_m2),
            mean_mm: finite(score.mean_mm),
            median_mm: finite(score.median_mm),
            p95_mm: finite(score.p95_mm),
            bone_mm: finite(deviation.mean_mm),
            bone_samples: deviation.samples,
            border_mm: finite(steps.iter().sum::<f64>() / steps.len() as f64),
            acceleration_ratio: finite(smoothness.acceleration_ratio),
            jerk_ratio: finite(smoothness.jerk_ratio),
            hidden: score.hidden_cells,
            unfilled: score.unfilled_cells,
            by_length: by_length
                .filter(|(_, (length, _))| length.score.hidden_cells > 0)
                .map(|(class, (length, sure))| LengthOutcome::of(class, &length.score, sure))
                .collect(),
            iterations: filled.report().iterations,
            termination: filled.report().termination.as_str().to_owned(),
            seconds,
            error: None,
        })
    }

    /// The account of a method that could not run.
    pub(crate) fn failed(holdout: &Holdout, seconds: f64, error: &dyn std::error::Error) -> Self {
        let hidden = holdout.hidden().count();
        let mut reason = error.to_string();
        let mut source = error.source();
        while let Some(cause) = source {
            reason = format!("{reason}: {cause}");
            source = cause.source();
        }
        Self {
            hidden,
            unfilled: hidden,
            termination: "failed".to_owned(),
            seconds,
            error: Some(reason),
            ..Self::default()
        }
    }
}

impl LengthOutcome {
    fn of(class: usize, score: &Score, calibration: &Calibration) -> Self {
        Self {
            class,
            mse_m2: finite(score.mse_m2),
            mean_mm: finite(score.mean_mm),
            median_mm: finite(score.median_mm),
            p95_mm: finite(score.p95_mm),
            hidden: score.hidden_cells,
            unfilled: score.unfilled_cells,
            sureness: calibration.into(),
        }
    }

    /// The class as an outcome of its own, without what is of the whole fill.
    pub(crate) fn alone(&self, whole: &Outcome) -> Outcome {
        Outcome {
            mse_m2: self.mse_m2,
            mean_mm: self.mean_mm,
            median_mm: self.median_mm,
            p95_mm: self.p95_mm,
            hidden: self.hidden,
            unfilled: self.unfilled,
            by_length: vec![self.clone()],
            seconds: whole.seconds,
            iterations: whole.iterations,
            termination: whole.termination.clone(),
            error: whole.error.clone(),
            ..Outcome::default()
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
