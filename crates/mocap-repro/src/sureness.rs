use metrics::Calibration;
use serde::{Deserialize, Serialize};

/// Multiples of sigma at which samples are counted.
pub const MULTIPLES: [f64; 12] = [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0];
/// Upper edges in seconds of the classes by which gaps are told apart; one more class holds the rest.
pub const LENGTH_EDGES_S: [f64; 5] = [0.1, 0.25, 0.5, 1.0, 2.0];

/// What a class of gap lengths is called.
pub(crate) fn length_class(class: usize) -> String {
    let upper = LENGTH_EDGES_S.get(class);
    match (class.checked_sub(1).and_then(|lower| LENGTH_EDGES_S.get(lower)), upper) {
        (None, Some(upper)) => format!("gaps up to {upper} s"),
        (Some(lower), Some(upper)) => format!("gaps of {lower}\u{2013}{upper} s"),
        (Some(lower), None) => format!("gaps over {lower} s"),
        (None, None) => "no class".to_owned(),
    }
}

/// How many samples lie within multiples of the sigma that a method states, as [`Calibration`] counts
/// them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sureness {
    /// Filled samples with a sigma.
    pub samples: usize,
    /// Filled samples without one.
    pub without_sigma: usize,
    /// Samples within each of [`MULTIPLES`].
    pub within: [usize; MULTIPLES.len()],
    /// Sum of sigma in mm.
    pub sigma_sum_mm: f64,
    /// Sum of the squares of error by sigma; `None` if it is infinite, as a wrong sample with a sigma of 0
    /// makes it.
    pub square_ratio_sum: Option<f64>,
}

impl Default for Sureness {
    fn default() -> Self {
        Self {
            samples: 0,
            without_sigma: 0,
            within: [0; MULTIPLES.len()],
            sigma_sum_mm: 0.0,
            square_ratio_sum: Some(0.0),
        }
    }
}

impl Sureness {
    /// Takes counts together.
    #[must_use]
    pub fn sum<'a>(all: impl IntoIterator<Item = &'a Self>) -> Self {
        all.into_iter().fold(Self::default(), |mut sum, one| {
            sum.samples += one.samples;
            sum.without_sigma += one.without_sigma;
            sum.within.iter_mut().zip(one.within).for_each(|(a, b)| *a += b);
            sum.sigma_sum_mm += one.sigma_sum_mm;
            sum.square_ratio_sum =
                sum.square_ratio_sum.zip(one.square_ratio_sum).map(|(a, b)| a + b);
            sum
        })
    }

    /// Share of the samples within one of [`MULTIPLES`], if there are any.
    #[must_use]
    pub fn share_within(&self, multiple: f64) -> Option<f64> {
        let place = MULTIPLES.iter().position(|m| m.total_cmp(&multiple).is_eq())?;
        (self.samples > 0).then(|| self.within[place] as f64 / self.samples as f64)
    }

    /// Root mean square of error by sigma: above 1 where sigma is too small; `None` without samples and
    /// where it is infinite.
    #[must_use]
    pub fn rms_ratio(&self) -> Option<f64> {
        let sum = self.square_ratio_sum.filter(|_| self.samples > 0)?;
        Some((sum / self.samples as f64).sqrt())
    }
}

impl From<&Calibration> for Sureness {
    fn from(calibration: &Calibration) -> Self {
        let mut within = [0; MULTIPLES.len()];
        within.iter_mut().zip(&calibration.within).for_each(|(to, from)| *to = from.samples);
        Self {
            samples: calibration.samples,
            without_sigma: calibration.without_sigma,
            within,
            sigma_sum_mm: calibration.sigma_sum_mm,
            square_ratio_sum: Some(calibration.square_ratio_sum).filter(|sum| sum.is_finite()),
        }
    }
}
