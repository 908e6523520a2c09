use mocap_core::{Filled, Gap, Mask, Take, geometry};

use crate::{
    MM_PER_M, MetricError,
    error::{check_mask, check_takes},
    gap_length_classes,
};

/// How honest a method's standard deviations are.
///
/// Takes over different cells add up with [`merge`](Self::merge).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Calibration {
    /// Hidden cells with a truth, an estimate and a standard deviation.
    pub samples: usize,
    /// Hidden cells with a truth and an estimate, but no standard deviation.
    pub without_sigma: usize,
    /// For each multiple asked for: samples whose 3-D error is at most that many standard deviations.
    pub within: Vec<Within>,
    /// Sum over the samples of the stated standard deviation in mm.
    pub sigma_sum_mm: f64,
    /// Sum over the samples of the square of error by standard deviation; without unit. Honest standard
    /// deviations give one a sample, too small ones more, and one of 0 for a wrong sample infinity.
    pub square_ratio_sum: f64,
}

/// Samples within a multiple of their standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Within {
    /// The multiple.
    pub multiple: f64,
    /// Samples.
    pub samples: usize,
}

/// How many of the hidden samples lie within multiples of the standard deviation that the fill states
/// for them.
///
/// The standard deviation of a [`Filled`] is that of the 3-D error, so the error `‖x̂ − x‖` is held
/// against it as it is. An error of 0 lies within any multiple; a standard deviation of 0 or less with
/// a larger error lies within none.
///
/// # Errors
/// [`MetricError::Shape`] and [`MetricError::Markers`] if the three are not of one take,
/// [`MetricError::NoHiddenCell`] if `hidden` holds no cell that `truth` shows.
pub fn calibration(
    truth: &Take,
    filled: &Filled,
    hidden: &Mask,
    multiples: &[f64],
) -> Result<Calibration, MetricError> {
    check(truth, filled, hidden)?;
    Ok(calibration_of(truth, filled, hidden.iter(), multiples))
}

/// [`calibration`] by length of gap, one for each class that [`by_gap_length`](crate::by_gap_length) has.
///
/// # Units
/// Seconds.
///
/// # Errors
/// As [`calibration`], and [`MetricError::Edges`] for edges that do not increase from above 0.
pub fn calibration_by_gap_length(
    truth: &Take,
    filled: &Filled,
    hidden: &Mask,
    multiples: &[f64],
    edges_s: &[f64],
) -> Result<Vec<Calibration>, MetricError> {
    check(truth, filled, hidden)?;
    let classes = gap_length_classes(hidden, truth.rate_hz(), edges_s)?;
    let of_class = |gaps: &Vec<Gap>| {
        let cells = gaps.iter().flat_map(|gap| gap.frames.clone().map(|t| (t, gap.marker)));
        calibration_of(truth, filled, cells, multiples)
    };
    Ok(classes.iter().map(of_class).collect())
}

fn check(truth: &Take, filled: &Filled, hidden: &Mask) -> Result<(), MetricError> {
    check_takes(truth, filled.take())?;
    check_mask(truth, "the hidden mask", hidden)?;
    let some = hidden.iter().any(|(t, m)| truth.is_observed(t, m));
    if some { Ok(()) } else { Err(MetricError::NoHiddenCell) }
}

/// [`calibration`] over any cells of the take, without the checks; cells outside of it panic.
fn calibration_of(
    truth: &Take,
    filled: &Filled,
    cells: impl Iterator<Item = (usize, usize)>,
    multiples: &[f64],
) -> Calibration {
    let within = multiples.iter().map(|&multiple| Within { multiple, samples: 0 });
    let mut sums = Calibration { within: within.collect(), ..Calibration::default() };
    for (t, m) in cells {
        let (Some(x), Some(estimate)) = (truth.position(t, m), filled.take().position(t, m)) else {
            continue;
        };
        let Some(sigma_m) = filled.sigma_m(t, m) else {
            sums.without_sigma += 1;
            continue;
        };
        let error_m = geometry::distance(estimate, x);
        sums.samples += 1;
        sums.sigma_sum_mm += MM_PER_M * sigma_m;
        if error_m > 0.0 {
            sums.square_ratio_sum += (error_m / sigma_m).powi(2);
        }
        for level in &mut sums.within {
            level.samples += usize::from(error_m <= level.multiple * sigma_m);
        }
    }
    sums
}

impl Calibration {
    /// Share of the samples within this multiple, if it was asked for and there are samples.
    #[must_use]
    pub fn share_within(&self, multiple: f64) -> Option<f64> {
        let level = self.within.iter().find(|level| level.multiple.total_cmp(&multiple).is_eq())?;
        (self.samples > 0).then(|| level.samples as f64 / self.samples as f64)
    }

    /// Share of a normal law within this multiple of its standard deviation: 0.683 for 1, 0.954 for 2.
    #[must_use]
    pub fn nominal_share(multiple: f64) -> f64 {
        libm::erf(multiple / std::f64::consts::SQRT_2).max(0.0)
    }

    /// Mean stated standard deviation in mm; `None` without samples.
    #[must_use]
    pub fn mean_sigma_mm(&self) -> Option<f64> {
        (self.samples > 0).then(|| self.sigma_sum_mm / self.samples as f64)
    }

    /// Root mean square of error by standard deviation: 1 if they are right on average, above if they
    /// are too small; `None` without samples.
    #[must_use]
    pub fn rms_ratio(&self) -> Option<f64> {
        (self.samples > 0).then(|| (self.square_ratio_sum / self.samples as f64).sqrt())
    }

    /// Adds the samples of other cells, or of another take.
    ///
    /// # Errors
    /// [`MetricError::Multiples`] if they were counted for other multiples.
    pub fn merge(&mut self, other: &Self) -> Result<(), MetricError> {
        if self.within.is_empty() {
            let fresh = |level: &Within| Within { samples: 0, ..*level };
            self.within = other.within.iter().map(fresh).collect();
        }
        let (ours, theirs) = (self.within.iter(), other.within.iter());
        let same = ours.len() == theirs.len()
            && ours.zip(theirs).all(|(a, b)| a.multiple.total_cmp(&b.multiple).is_eq());
        if !same {
            return Err(MetricError::Multiples);
        }
        for (level, more) in self.within.iter_mut().zip(&other.within) {
            level.samples += more.samples;
        }
        self.samples += other.samples;
        self.without_sigma += other.without_sigma;
        self.sigma_sum_mm += other.sigma_sum_mm;
        self.square_ratio_sum += other.square_ratio_sum;
        Ok(())
    }
}
