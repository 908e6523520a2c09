use ndarray::{Array2, ArrayView1, ArrayView2};

use crate::CoreError;

/// A set of (frame, marker) cells, as a `(T, M)` array of booleans.
///
/// A marker is in or out as a whole: its three coordinates are never split.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    cells: Array2<bool>,
}

impl Mask {
    /// The empty set over T frames and M markers.
    #[must_use]
    pub fn none(frames: usize, markers: usize) -> Self {
        Self { cells: Array2::from_elem((frames, markers), false) }
    }

    /// The full set over T frames and M markers.
    #[must_use]
    pub fn all(frames: usize, markers: usize) -> Self {
        Self { cells: Array2::from_elem((frames, markers), true) }
    }

    /// The set of cells for which `contains(frame, marker)` is true.
    pub fn from_fn(
        frames: usize,
        markers: usize,
        mut contains: impl FnMut(usize, usize) -> bool,
    ) -> Self {
        Self { cells: Array2::from_shape_fn((frames, markers), |(t, m)| contains(t, m)) }
    }

    /// Number of frames T.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.cells.nrows()
    }

    /// Number of markers M.
    #[must_use]
    pub fn markers(&self) -> usize {
        self.cells.ncols()
    }

    /// Whether the cell is in the set.
    ///
    /// # Panics
    /// If the cell lies outside of the array.
    #[must_use]
    pub fn contains(&self, frame: usize, marker: usize) -> bool {
        self.cells[(frame, marker)]
    }

    /// Puts a cell in.
    ///
    /// # Errors
    /// [`CoreError::OutOfRange`].
    pub fn insert(&mut self, frame: usize, marker: usize) -> Result<(), CoreError> {
        let (frames, markers) = self.cells.dim();
        *self.cells.get_mut((frame, marker)).ok_or(CoreError::OutOfRange {
            frame,
            marker,
            frames,
            markers,
        })? = true;
        Ok(())
    }

    /// The cells of one frame, `(M,)`.
    ///
    /// # Panics
    /// If `frame` is not below T.
    #[must_use]
    pub fn frame(&self, frame: usize) -> ArrayView1<'_, bool> {
        self.cells.row(frame)
    }

    /// The cells of one marker, `(T,)`.
    ///
    /// # Panics
    /// If `marker` is not below M.
    #[must_use]
    pub fn marker(&self, marker: usize) -> ArrayView1<'_, bool> {
        self.cells.column(marker)
    }

    /// All cells, `(T, M)`.
    #[must_use]
    pub fn view(&self) -> ArrayView2<'_, bool> {
        self.cells.view()
    }

    /// Number of cells in the set.
    #[must_use]
    pub fn count(&self) -> usize {
        self.cells.iter().filter(|&&c| c).count()
    }

    /// The cells in the set as (frame, marker), frame by frame.
    pub fn iter(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.cells.indexed_iter().filter(|(_, c)| **c).map(|(cell, _)| cell)
    }
}
