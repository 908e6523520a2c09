use mocap_core::Take;

use crate::{AugmentError, error::check_cells};

/// The other markers of each marker, nearest first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Neighbours {
    nearest: Vec<Vec<usize>>,
}

/// Frames looked at: a mean over these tells neighbours apart as well as one over all.
const FRAMES: usize = 512;

impl Neighbours {
    /// Sorts by the mean distance over frames that show both markers.
    ///
    /// Of a long take 512 frames count, evenly spaced. Markers that are never seen together are no
    /// neighbours.
    ///
    /// # Errors
    /// [`AugmentError::EmptyTake`].
    pub fn by_mean_distance(take: &Take) -> Result<Self, AugmentError> {
        let (frames, markers) = (take.frames(), take.marker_count());
        check_cells(frames, markers)?;
        let looked_at = frames.min(FRAMES);
        let sample: Vec<usize> = (0..looked_at).map(|k| k * frames / looked_at).collect();
        let mean = |a: usize, b: usize| {
            let (mut sum, mut count) = (0.0, 0_u32);
            for distance in sample.iter().filter_map(|&t| take.distance(t, a, b)) {
                sum += distance;
                count += 1;
            }
            (count > 0).then(|| sum / f64::from(count))
        };
        let nearest = (0..markers).map(|a| {
            let others = (0..markers).filter(|&b| b != a);
            let mut others: Vec<_> = others.filter_map(|b| Some((mean(a, b)?, b))).collect();
            others.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            others.into_iter().map(|other| other.1).collect()
        });
        Ok(Self { nearest: nearest.collect() })
    }

    /// The other markers, nearest first.
    ///
    /// # Panics
    /// If `marker` is not one of the take's.
    #[must_use]
    pub fn of(&self, marker: usize) -> &[usize] {
        &self.nearest[marker]
    }

    /// Number of markers M.
    #[must_use]
    pub fn markers(&self) -> usize {
        self.nearest.len()
    }
}
