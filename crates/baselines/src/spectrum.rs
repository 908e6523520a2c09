//! Principal directions of a symmetric matrix.

use mocap_core::FillError;
use ndarray::{Array1, Array2, ArrayView2, s};
use ndarray_linalg::{Eigh, UPLO};

/// Singular values and directions of a data matrix, from its Gram matrix.
pub(crate) struct Spectrum {
    /// Largest first, `(n,)`.
    pub values: Array1<f64>,
    /// One direction a column, `(n, n)`, in the order of the values.
    directions: Array2<f64>,
}

impl Spectrum {
    /// Of the data matrix `X` with the Gram matrix `Xᵀ X`, `(n, n)`. Values below the rounding of the
    /// largest square come out as up to 1e-8 of the largest value.
    ///
    /// # Errors
    /// [`FillError::Method`] if LAPACK does not converge, which takes entries that are not finite.
    pub fn of_gram(method: &'static str, gram: &Array2<f64>) -> Result<Self, FillError> {
        if gram.is_empty() {
            return Ok(Self { values: Array1::zeros(0), directions: Array2::zeros((0, 0)) });
        }
        let (squares, vectors) = gram
            .eigh(UPLO::Lower)
            .map_err(|source| FillError::Method { method, source: Box::new(source) })?;
        let values = squares.iter().rev().map(|square| square.max(0.0).sqrt()).collect();
        Ok(Self { values, directions: vectors.slice_move(s![.., ..;-1]) })
    }

    /// The first `rank` directions, `(n, rank)`; all of them if there are fewer.
    pub fn leading(&self, rank: usize) -> ArrayView2<'_, f64> {
        self.directions.slice(s![.., ..rank.min(self.values.len())])
    }

    /// How many values it takes until their sum reaches the `share` of the whole.
    pub fn rank_of_share(&self, share: f64) -> usize {
        let enough = share * self.values.sum();
        let mut sum = 0.0;
        let reached = self.values.iter().position(|value| {
            sum += value;
            sum >= enough
        });
        reached.map_or(self.values.len(), |last| last + 1)
    }
}
