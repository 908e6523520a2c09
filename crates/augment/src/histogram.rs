use std::collections::BTreeMap;

use crate::AugmentError;

/// How often gaps of each length occur: positive weights over lengths in frames.
#[derive(Debug, Clone, PartialEq)]
pub struct GapHistogram {
    /// Sorted by length, weights positive and of sum 1.
    bins: Vec<(usize, f64)>,
}

impl GapHistogram {
    /// Takes lengths in frames with their weights, such as counts; equal lengths add up.
    ///
    /// # Errors
    /// [`AugmentError::ZeroLength`], [`AugmentError::Weight`] and [`AugmentError::EmptyHistogram`].
    ///
    /// ```
    /// let gaps = augment::GapHistogram::new([(1, 3.0), (10, 1.0)])?;
    /// assert_eq!(gaps.probability(10), 0.25);
    /// assert_eq!(gaps.mean_frames(), 3.25);
    /// # Ok::<(), augment::AugmentError>(())
    /// ```
    pub fn new(weights: impl IntoIterator<Item = (usize, f64)>) -> Result<Self, AugmentError> {
        let mut bins = BTreeMap::<usize, f64>::new();
        for (frames, weight) in weights {
            if frames == 0 {
                return Err(AugmentError::ZeroLength);
            }
            if !(weight.is_finite() && weight >= 0.0) {
                return Err(AugmentError::Weight { frames, weight });
            }
            *bins.entry(frames).or_default() += weight;
        }
        Self::normalised(bins.into_iter().filter(|bin| bin.1 > 0.0).collect())
    }

    fn normalised(mut bins: Vec<(usize, f64)>) -> Result<Self, AugmentError> {
        // Dividing by the largest weight first keeps sums of huge weights finite.
        let largest = bins.iter().map(|bin| bin.1).fold(0.0, f64::max);
        for bin in &mut bins {
            bin.1 /= largest;
        }
        let total: f64 = bins.iter().map(|bin| bin.1).sum();
        if bins.is_empty() || total <= 0.0 {
            return Err(AugmentError::EmptyHistogram);
        }
        for bin in &mut bins {
            bin.1 /= total;
        }
        Ok(Self { bins })
    }

    /// The gaps of `shortest` to `longest` frames, both inclusive, as a histogram of their own.
    ///
    /// # Errors
    /// [`AugmentError::EmptyHistogram`] if there are none.
    pub fn clipped(&self, shortest: usize, longest: usize) -> Result<Self, AugmentError> {
        let inside = |bin: &&(usize, f64)| (shortest..=longest).contains(&bin.0);
        Self::normalised(self.bins.iter().filter(inside).copied().collect())
    }

    /// The same gaps with lengths times `factor`, rounded, and at least one frame.
    pub(crate) fn scaled(&self, factor: f64) -> Result<Self, AugmentError> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let length = |frames: usize| (frames as f64 * factor).round().max(1.0) as usize;
        Self::new(self.bins.iter().map(|&(frames, weight)| (length(frames), weight)))
    }

    /// Lengths in frames with their share of all gaps, shortest first.
    #[must_use]
    pub fn bins(&self) -> &[(usize, f64)] {
        &self.bins
    }

    /// Share of the gaps that have this length.
    #[must_use]
    pub fn probability(&self, frames: usize) -> f64 {
        self.bins.binary_search_by_key(&frames, |bin| bin.0).map_or(0.0, |at| self.bins[at].1)
    }

    /// Mean length in frames.
    #[must_use]
    pub fn mean_frames(&self) -> f64 {
        self.bins.iter().map(|&(frames, weight)| frames as f64 * weight).sum()
    }

    /// Length of the longest gap in frames.
    #[must_use]
    pub fn longest_frames(&self) -> usize {
        self.bins.last().map_or(0, |bin| bin.0)
    }
}
