//! Other takes of the same markers on the same body.

use std::sync::Arc;

use mocap_core::{FillError, Take};
use ndarray::{Array3, s};

/// Takes are joined with so much of nothing between them, longer than any difference of frames that is looked at.
const APART_S: f64 = 1.0;

/// For what fades with time they are so far apart that nothing is left.
const FORGOTTEN_S: f64 = 3600.0;

/// A take and others of its session, to learn from: the same person who wears the same markers.
///
/// What a marker does beside its neighbours is a matter of skin, muscle and of where it is stuck, and so the same in
/// all takes until somebody moves it.
#[derive(Debug, Clone)]
pub struct Session {
    /// The take, and then the others with its markers.
    joined: Take,
    /// First frames of the others in `joined`.
    starts: Vec<usize>,
}

impl Session {
    /// The session of a take. Markers of the others go by their names, as [`mocap_core::MarkerSet::find`] has it; those
    /// that only the others have are left out.
    ///
    /// # Errors
    /// [`FillError::Parameter`] for a take with another sampling rate.
    pub fn new(take: &Take, others: &[Arc<Take>]) -> Result<Self, FillError> {
        let rate_hz = take.rate_hz();
        let differs = |other: &&Arc<Take>| (other.rate_hz() / rate_hz - 1.0).abs() > 1e-6;
        if let Some(other) = others.iter().find(differs) {
            let (field, value) = ("session", other.rate_hz());
            let rule = "of takes with the sampling rate of the one that is filled, in Hz";
            return Err(FillError::Parameter { field, value, rule });
        }
        let apart = super::frames_of(APART_S, rate_hz).max(1);
        let frames = take.frames() + others.iter().map(|o| apart + o.frames()).sum::<usize>();
        let mut positions = Array3::from_elem((frames, take.marker_count(), 3), f64::NAN);
        positions.slice_mut(s![..take.frames(), .., ..]).assign(&take.positions());
        let mut starts = Vec::with_capacity(others.len());
        let mut end = take.frames();
        for other in others {
            let start = end + apart;
            end = start + other.frames();
            starts.push(start);
            for m in 0..take.marker_count() {
                let names = [take.markers().name(m), take.markers().split(m).1];
                let Some(of) = names.iter().find_map(|name| other.markers().find(name).ok()) else {
                    continue;
                };
                let column = other.positions();
                positions.slice_mut(s![start..end, m, ..]).assign(&column.slice(s![.., of, ..]));
            }
        }
        let joined = Take::from_positions(Arc::clone(take.markers()), rate_hz, positions)?;
        Ok(Self { joined, starts })
    }

    /// The take and the others, one after the other.
    pub(super) fn joined(&self) -> &Take {
        &self.joined
    }

    /// Frames of the other takes that show all of these markers.
    pub(super) fn frames_with(&self, markers: &[usize]) -> Vec<usize> {
        let first = self.starts.first().copied().unwrap_or(self.joined.frames());
        let seen = |t: &usize| markers.iter().all(|&m| self.joined.is_observed(*t, m));
        (first..self.joined.frames()).filter(seen).collect()
    }

    /// When a frame of the joined takes is, in frames: an hour lies between takes.
    pub(super) fn clock(&self, t: usize) -> usize {
        let before = self.starts.partition_point(|&start| start <= t);
        t + before * super::frames_of(FORGOTTEN_S, self.joined.rate_hz())
    }
}

#[cfg(test)]
mod tests {
    use mocap_core::MarkerSet;

    use super::*;

    fn take(names: [&str; 2], rate_hz: f64, first: f64) -> Arc<Take> {
        let positions = Array3::from_shape_fn((3, 2, 3), |(t, m, _)| first + (10 * m + t) as f64);
        Arc::new(Take::from_positions(MarkerSet::new(names).unwrap(), rate_hz, positions).unwrap())
    }

    #[test]
    fn others_follow_with_the_markers_they_share() {
        let own = take(["Ann:A", "Ann:B"], 4.0, 0.0);
        let session = Session::new(&own, &[take(["B", "C"], 4.0, 100.0)]).unwrap();
        let joined = session.joined();
        // A second of nothing lies between.
        assert_eq!((joined.frames(), session.starts.clone()), (10, vec![7]));
        assert_eq!(joined.position(2, 1), Some([12.0; 3]));
        assert!((3..7).all(|t| joined.position(t, 1).is_none()));
        assert_eq!(joined.position(8, 1), Some([101.0; 3]));
        assert_eq!(joined.position(8, 0), None);
        assert_eq!(session.frames_with(&[1]), [7, 8, 9]);
        assert!(session.frames_with(&[0, 1]).is_empty());
        assert_eq!((session.clock(2), session.clock(7)), (2, 7 + 4 * 3600));
    }

    #[test]
    fn another_sampling_rate_is_refused() {
        let (own, other) = (take(["A", "B"], 100.0, 0.0), take(["A", "B"], 120.0, 0.0));
        let error = Session::new(&own, &[other]).unwrap_err().to_string();
        assert!(error.contains("`session` is 120"), "{error}");
    }
}
