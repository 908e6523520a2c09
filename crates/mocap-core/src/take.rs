use std::sync::Arc;

use ndarray::{Array3, ArrayView3};

use crate::{
    CoreError, Gap, MarkerSet, Mask,
    gap::{gaps, gaps_of},
};

/// A recording: T frames of M labelled markers, each observed or missing.
///
/// The mask is the only authority on what was observed. Coordinates of missing cells are NaN, so
/// nothing that was hidden can be read back.
///
/// # Units
/// Metres and seconds.
#[derive(Debug, Clone)]
pub struct Take {
    markers: Arc<MarkerSet>,
    rate_hz: f64,
    positions: Array3<f64>,
    observed: Mask,
}

impl Take {
    /// Builds a take from positions `(T, M, 3)` in metres and the `(T, M)` set of observed cells.
    ///
    /// Coordinates outside of `observed` are dropped.
    ///
    /// # Errors
    /// [`CoreError::Shape`], [`CoreError::Rate`], and [`CoreError::NotFinite`] for an observed cell
    /// with NaN or infinity.
    pub fn new(
        markers: impl Into<Arc<MarkerSet>>,
        rate_hz: f64,
        positions: Array3<f64>,
        observed: Mask,
    ) -> Result<Self, CoreError> {
        let markers = markers.into();
        if !(rate_hz.is_finite() && rate_hz > 0.0) {
            return Err(CoreError::Rate { rate_hz });
        }
        let frames = positions.dim().0;
        check_shape("positions", &[frames, markers.len(), 3], positions.shape())?;
        check_shape("observed mask", &[frames, markers.len()], observed.view().shape())?;
        let mut positions = if positions.is_standard_layout() {
            positions
        } else {
            positions.as_standard_layout().into_owned()
        };
        let cells = positions.rows_mut().into_iter().zip(observed.view());
        for (cell, (mut p, &seen)) in cells.enumerate() {
            if !seen {
                p.fill(f64::NAN);
            } else if !p.iter().all(|c| c.is_finite()) {
                let (frame, marker) = (cell / markers.len(), cell % markers.len());
                return Err(CoreError::NotFinite {
                    frame,
                    marker: markers.name(marker).to_owned(),
                });
            }
        }
        Ok(Self { markers, rate_hz, positions, observed })
    }

    /// Builds a take in which a cell is observed exactly where its three coordinates are finite.
    ///
    /// # Errors
    /// [`CoreError::Shape`] and [`CoreError::Rate`].
    ///
    /// ```
    /// use mocap_core::{MarkerSet, Take};
    /// let mut xyz = ndarray::Array3::zeros((2, 1, 3));
    /// xyz[(1, 0, 2)] = f64::NAN;
    /// let take = Take::from_positions(MarkerSet::new(["C7"])?, 120.0, xyz)?;
    /// assert_eq!(take.position(0, 0), Some([0.0; 3]));
    /// assert_eq!(take.position(1, 0), None);
    /// # Ok::<(), mocap_core::CoreError>(())
    /// ```
    pub fn from_positions(
        markers: impl Into<Arc<MarkerSet>>,
        rate_hz: f64,
        positions: Array3<f64>,
    ) -> Result<Self, CoreError> {
        let (frames, columns, axes) = positions.dim();
        let observed = Mask::from_fn(frames, columns, |t, m| {
            (0..axes).all(|a| positions[(t, m, a)].is_finite())
        });
        Self::new(markers, rate_hz, positions, observed)
    }

    /// The marker names.
    #[must_use]
    pub fn markers(&self) -> &Arc<MarkerSet> {
        &self.markers
    }

    /// Number of frames T.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.positions.dim().0
    }

    /// Number of markers M.
    #[must_use]
    pub fn marker_count(&self) -> usize {
        self.markers.len()
    }

    /// Sampling rate in Hz.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Positions `(T, M, 3)` in metres, contiguous, NaN where missing.
    #[must_use]
    pub fn positions(&self) -> ArrayView3<'_, f64> {
        self.positions.view()
    }

    /// The observed cells, `(T, M)`.
    #[must_use]
    pub fn observed(&self) -> &Mask {
        &self.observed
    }

    /// Whether the marker was seen in the frame.
    ///
    /// # Panics
    /// If the cell lies outside of the take.
    #[must_use]
    pub fn is_observed(&self, frame: usize, marker: usize) -> bool {
        self.observed.contains(frame, marker)
    }

    /// The position in metres, where observed.
    ///
    /// # Panics
    /// If the cell lies outside of the take.
    #[must_use]
    pub fn position(&self, frame: usize, marker: usize) -> Option<[f64; 3]> {
        let p = |a| self.positions[(frame, marker, a)];
        self.is_observed(frame, marker).then(|| [p(0), p(1), p(2)])
    }

    /// Distance in metres between two markers, where both are observed.
    ///
    /// # Panics
    /// If a cell lies outside of the take.
    #[must_use]
    pub fn distance(&self, frame: usize, a: usize, b: usize) -> Option<f64> {
        let (p, q) = (self.position(frame, a)?, self.position(frame, b)?);
        Some(crate::geometry::distance(p, q))
    }

    /// All gaps, marker by marker and in time order.
    #[must_use]
    pub fn gaps(&self) -> Vec<Gap> {
        gaps(&self.observed)
    }

    /// The gaps of one marker, in time order.
    ///
    /// # Panics
    /// If `marker` is not below M.
    #[must_use]
    pub fn gaps_of(&self, marker: usize) -> Vec<Gap> {
        gaps_of(&self.observed.marker(marker), marker)
    }

    /// The same take without the cells of `hidden` `(T, M)`: what a filler may see.
    ///
    /// # Errors
    /// [`CoreError::Shape`].
    pub fn hide(&self, hidden: &Mask) -> Result<Self, CoreError> {
        check_shape("hidden mask", self.observed.view().shape(), hidden.view().shape())?;
        let seen = Mask::from_fn(self.frames(), self.marker_count(), |t, m| {
            self.is_observed(t, m) && !hidden.contains(t, m)
        });
        Self::new(Arc::clone(&self.markers), self.rate_hz, self.positions.clone(), seen)
    }

    /// The same take with each observed position mapped by `f(frame, marker, position)`.
    ///
    /// # Errors
    /// [`CoreError::NotFinite`] if `f` returns a coordinate that is not finite.
    pub fn map_positions(
        &self,
        mut f: impl FnMut(usize, usize, [f64; 3]) -> [f64; 3],
    ) -> Result<Self, CoreError> {
        let mut positions = self.positions.clone();
        for (t, m) in self.observed.iter() {
            let p = std::array::from_fn(|a| positions[(t, m, a)]);
            for (a, c) in f(t, m, p).into_iter().enumerate() {
                positions[(t, m, a)] = c;
            }
        }
        Self::new(Arc::clone(&self.markers), self.rate_hz, positions, self.observed.clone())
    }

    /// The take with only the listed markers, in the listed order.
    ///
    /// # Errors
    /// [`CoreError::OutOfRange`] for an index that is not below M, and
    /// [`CoreError::DuplicateMarkerName`] for an index listed twice.
    pub fn select(&self, markers: &[usize]) -> Result<Self, CoreError> {
        if let Some(&marker) = markers.iter().find(|&&m| m >= self.marker_count()) {
            let (frames, markers) = (self.frames(), self.marker_count());
            return Err(CoreError::OutOfRange { frame: 0, marker, frames, markers });
        }
        let names = MarkerSet::new(markers.iter().map(|&m| self.markers.name(m)))?;
        let positions = self.positions.select(ndarray::Axis(1), markers);
        let observed =
            Mask::from_fn(self.frames(), markers.len(), |t, m| self.is_observed(t, markers[m]));
        Self::new(names, self.rate_hz, positions, observed)
    }

    /// Whether two takes agree to the last bit: names, rate, mask and observed coordinates.
    #[must_use]
    pub fn bit_eq(&self, other: &Self) -> bool {
        self.markers == other.markers
            && self.rate_hz.to_bits() == other.rate_hz.to_bits()
            && self.observed == other.observed
            && self.observed.iter().all(|(t, m)| {
                (0..3).all(|a| {
                    let cell = (t, m, a);
                    self.positions[cell].to_bits() == other.positions[cell].to_bits()
                })
            })
    }
}

pub(crate) fn check_shape(
    what: &'static str,
    expected: &[usize],
    found: &[usize],
) -> Result<(), CoreError> {
    if expected == found {
        return Ok(());
    }
    Err(CoreError::Shape { what, expected: expected.to_vec(), found: found.to_vec() })
}
