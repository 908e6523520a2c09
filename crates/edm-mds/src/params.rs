use mocap_core::FillError;

/// Most neighbours that [`EdmParams::neighbours`] may ask for.
pub(crate) const MAX_NEIGHBOURS: usize = 16;

/// How a position is found from distances to the neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum EdmSolver {
    /// Classical scaling of the interpolated distance matrix, then orthogonal Procrustes to the
    /// neighbours ([Pan23] Eq. (2)).
    #[default]
    Scaling,
    /// Least squares of the distances to the neighbours where they are, by Gauss–Newton.
    Trilateration,
}

/// Parameters of [`Edm`](crate::Edm).
///
/// ```
/// use edm_mds::{Edm, EdmParams};
///
/// let error = Edm::new(EdmParams { neighbours: 2, ..EdmParams::default() }).unwrap_err();
/// assert_eq!(error.to_string(), "parameter `neighbours` is 2; it must be from 3 to 16");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdmParams {
    /// Neighbours K to use, from 3 to 16; 6 by default, as in the program of [Pan23].
    pub neighbours: usize,
    /// How a position is found from the distances; scaling by default.
    pub solver: EdmSolver,
    /// Largest standard deviation of a neighbour's distance to the marker, positive; three
    /// neighbours are kept whatever theirs. 0.03 m by default.
    ///
    /// # Units
    /// Metres.
    pub max_spread_m: f64,
    /// Frames that must show marker and neighbour together, at least 2; 10 by default.
    pub min_shared: usize,
}

impl Default for EdmParams {
    fn default() -> Self {
        Self { neighbours: 6, solver: EdmSolver::default(), max_spread_m: 0.03, min_shared: 10 }
    }
}

impl EdmParams {
    pub(crate) fn validate(&self) -> Result<(), FillError> {
        let refuse = |field, value, rule| Err(FillError::Parameter { field, value, rule });
        if !(3..=MAX_NEIGHBOURS).contains(&self.neighbours) {
            return refuse("neighbours", self.neighbours as f64, "from 3 to 16");
        }
        if self.max_spread_m.is_nan() || self.max_spread_m <= 0.0 {
            return refuse("max_spread_m", self.max_spread_m, "positive");
        }
        if self.min_shared < 2 {
            return refuse("min_shared", self.min_shared as f64, "at least 2");
        }
        Ok(())
    }
}
