use mocap_core::geometry::{add, distance, norm, scale, sub};

/// Where a marker can be in local coordinates, judged by where it was.
///
/// A regression from few or similar frames may answer with metres to a pose it has not seen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach {
    centre: [f64; 3],
    radius_m: f64,
}

impl Reach {
    /// So many times as far as the training frames go: out of the way of sound extrapolation.
    const MARGIN: f64 = 3.0;

    /// Soft tissue and joints give so much anyway.
    const LEAST_M: f64 = 0.05;

    /// The reach of a marker that was in these places.
    pub fn of(places: impl ExactSizeIterator<Item = [f64; 3]> + Clone) -> Self {
        let share = 1.0 / places.len().max(1) as f64;
        let centre = scale(share, places.clone().fold([0.0; 3], add));
        let farthest = places.map(|p| distance(p, centre)).fold(0.0, f64::max);
        Self { centre, radius_m: (Self::MARGIN * farthest).max(Self::LEAST_M) }
    }

    pub fn limit(&self, p: [f64; 3]) -> [f64; 3] {
        let away = sub(p, self.centre);
        let share = self.radius_m / norm(away);
        if share < 1.0 { add(self.centre, scale(share, away)) } else { p }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two places, half a metre on either side of (1, 0, 0).
    #[test]
    fn a_prediction_out_of_reach_is_drawn_back() {
        let reach = Reach::of([[0.5, 0.0, 0.0], [1.5, 0.0, 0.0]].into_iter());
        assert!(distance(reach.limit([1.0, 0.6, 0.0]), [1.0, 0.6, 0.0]) < 1e-15);
        assert!(distance(reach.limit([1.0, 0.0, 80.0]), [1.0, 0.0, 1.5]) < 1e-15);
    }

    /// A marker that never moved in its frame may move by five centimetres.
    #[test]
    fn a_marker_that_never_moved_has_some_reach() {
        let reach = Reach::of([[2.0; 3], [2.0; 3]].into_iter());
        assert!(distance(reach.limit([2.04, 2.0, 2.0]), [2.04, 2.0, 2.0]) < 1e-15);
        assert!(distance(reach.limit([9.0, 2.0, 2.0]), [2.05, 2.0, 2.0]) < 1e-15);
        assert!(distance(reach.limit([2.0; 3]), [2.0; 3]) < 1e-15);
    }
}
