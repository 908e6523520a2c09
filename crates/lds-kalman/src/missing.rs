//! The one way for a hook to write: to missing entries, never to observed ones.

use ndarray::{ArrayView2, ArrayViewMut2};

use crate::observations::Observations;

/// The entries of a matrix of observations that were not observed, and what fills them at present.
#[derive(Debug)]
pub struct MissingEntries<'a> {
    observations: &'a Observations,
    filled: ArrayViewMut2<'a, f64>,
}

impl<'a> MissingEntries<'a> {
    pub(crate) fn new(observations: &'a Observations, filled: ArrayViewMut2<'a, f64>) -> Self {
        Self { observations, filled }
    }

    /// Observed values and present fills, `(T, m)`.
    #[must_use]
    pub fn values(&self) -> ArrayView2<'_, f64> {
        self.filled.view()
    }

    /// The frames that miss an entry, in order.
    #[must_use]
    pub fn frames(&self) -> &'a [usize] {
        self.observations.gap_frames()
    }

    /// The missing dimensions of a frame, in order.
    ///
    /// # Panics
    ///
    /// If there is no such frame.
    #[must_use]
    pub fn dimensions(&self, frame: usize) -> &'a [usize] {
        let pattern = self.observations.pattern_of()[frame];
        &self.observations.patterns()[pattern].missing
    }

    /// Fills an entry; an observed one stays as it is.
    ///
    /// # Panics
    ///
    /// If there is no such entry.
    pub fn set(&mut self, frame: usize, dimension: usize, value: f64) {
        if !self.observations.mask()[(frame, dimension)] {
            self.filled[(frame, dimension)] = value;
        }
    }

    /// Fills every entry from a matrix `(T, m)`.
    ///
    /// # Panics
    ///
    /// If the matrix has another shape.
    pub fn fill_from(&mut self, source: ArrayView2<'_, f64>) {
        assert_eq!(source.dim(), self.filled.dim(), "one value for each entry");
        for &t in self.frames() {
            for &j in self.dimensions(t) {
                self.filled[(t, j)] = source[(t, j)];
            }
        }
    }
}
