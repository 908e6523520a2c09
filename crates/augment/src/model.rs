use mocap_core::MarkerSet;

use crate::{AugmentError, GapHistogram, error::check};

/// What becomes of markers of the take that the model does not list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Unlisted {
    /// The take is refused.
    #[default]
    Refuse,
    /// They get the mean probability of the listed markers of the take.
    Mean,
    /// They are never hidden, and the mean rate is taken over the others.
    Spare,
}

/// How likely each marker is to be missing, and how long gaps last.
#[derive(Debug, Clone, PartialEq)]
pub struct OcclusionModel {
    markers: Vec<(String, f64)>,
    lengths: GapHistogram,
    rate_hz: f64,
}

impl OcclusionModel {
    /// Takes marker names without subject prefix, the share of frames each is missing, and the gap
    /// lengths in frames at `rate_hz`. Of a name listed twice the first counts.
    ///
    /// # Errors
    /// [`AugmentError::OutOfRange`] for a probability outside of 0 to 1 or a rate that is no rate.
    pub fn new<S: Into<String>>(
        markers: impl IntoIterator<Item = (S, f64)>,
        lengths: GapHistogram,
        rate_hz: f64,
    ) -> Result<Self, AugmentError> {
        let markers: Vec<(String, f64)> =
            markers.into_iter().map(|(name, probability)| (name.into(), probability)).collect();
        markers.iter().try_for_each(|marker| check("probability", marker.1, 0.0, 1.0))?;
        check("rate_hz", rate_hz, f64::MIN_POSITIVE, f64::MAX)?;
        Ok(Self { markers, lengths, rate_hz })
    }

    /// Names without subject prefix and the share of frames each is missing.
    #[must_use]
    pub fn markers(&self) -> &[(String, f64)] {
        &self.markers
    }

    /// Gap lengths in frames at [`rate_hz`](Self::rate_hz).
    #[must_use]
    pub fn lengths(&self) -> &GapHistogram {
        &self.lengths
    }

    /// The rate in Hz in whose frames lengths are counted.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// The model with only the gaps of `shortest` to `longest` frames, both inclusive.
    ///
    /// The authors of [Pan23] keep 1 to 199.
    ///
    /// # Errors
    /// [`AugmentError::EmptyHistogram`] if there are none.
    pub fn clipped(&self, shortest: usize, longest: usize) -> Result<Self, AugmentError> {
        Ok(Self { lengths: self.lengths.clipped(shortest, longest)?, ..self.clone() })
    }

    /// The model with gaps of the same duration in frames of another rate.
    ///
    /// # Errors
    /// [`AugmentError::OutOfRange`] for a rate that is no rate.
    pub fn at_rate(&self, rate_hz: f64) -> Result<Self, AugmentError> {
        check("rate_hz", rate_hz, f64::MIN_POSITIVE, f64::MAX)?;
        let lengths = self.lengths.scaled(rate_hz / self.rate_hz)?;
        Ok(Self { markers: self.markers.clone(), lengths, rate_hz })
    }

    /// The probability of each marker of a set, `(M,)`; `None` for the spared.
    pub(crate) fn resolve(
        &self,
        set: &MarkerSet,
        unlisted: Unlisted,
    ) -> Result<Vec<Option<f64>>, AugmentError> {
        let listed = |name: &str| self.markers.iter().find(|m| m.0 == name).map(|m| m.1);
        let mut found: Vec<_> = (0..set.len()).map(|m| listed(set.split(m).1)).collect();
        let known: Vec<f64> = found.iter().flatten().copied().collect();
        let missing = found.iter().position(Option::is_none);
        match (unlisted, missing) {
            (Unlisted::Refuse, Some(m)) => {
                let marker = set.name(m).to_owned();
                return Err(AugmentError::UnlistedMarker { marker, listed: self.markers.len() });
            }
            (Unlisted::Mean, Some(_)) if !known.is_empty() => {
                let mean = known.iter().sum::<f64>() / known.len() as f64;
                for p in &mut found {
                    p.get_or_insert(mean);
                }
            }
            _ => {}
        }
        if known.iter().all(|&p| p <= 0.0) {
            return Err(AugmentError::NeverOccluded);
        }
        Ok(found)
    }
}

/// Whether two rates mean the same frames; 119.88 and 120 Hz do.
pub(crate) fn same_rate(a: f64, b: f64) -> bool {
    (a - b).abs() <= 0.01 * a.min(b)
}
