//! Covariances and the structure they are restricted to.

use ndarray::{Array1, Array2, ArrayView2};
use ndarray_linalg::{Eigh, UPLO};

use crate::{error::LdsError, kernel};

/// The form a covariance is restricted to while it is learnt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CovarianceStructure {
    /// One variance for all dimensions.
    #[default]
    Isotropic,
    /// One variance per dimension, no correlations.
    Diagonal,
    /// Any symmetric positive definite matrix.
    Full,
}

/// A covariance of known structure.
#[derive(Debug, Clone, PartialEq)]
pub enum Covariance {
    /// This variance times the identity.
    Isotropic(f64),
    /// The variances on the diagonal, `(n)`.
    Diagonal(Array1<f64>),
    /// The matrix, `(n, n)`.
    Full(Array2<f64>),
}

impl Covariance {
    /// The structure this covariance has.
    #[must_use]
    pub fn structure(&self) -> CovarianceStructure {
        match self {
            Self::Isotropic(_) => CovarianceStructure::Isotropic,
            Self::Diagonal(_) => CovarianceStructure::Diagonal,
            Self::Full(_) => CovarianceStructure::Full,
        }
    }

    /// The variances, `(n)`, for the dimension `n` of the space it lives in.
    #[must_use]
    pub fn variances(&self, dimension: usize) -> Array1<f64> {
        match self {
            Self::Isotropic(variance) => Array1::from_elem(dimension, *variance),
            Self::Diagonal(variances) => variances.clone(),
            Self::Full(matrix) => matrix.diag().to_owned(),
        }
    }

    /// The matrix, `(n, n)`, for the dimension `n` of the space it lives in.
    #[must_use]
    pub fn to_matrix(&self, dimension: usize) -> Array2<f64> {
        match self {
            Self::Full(matrix) => matrix.clone(),
            _ => Array2::from_diag(&self.variances(dimension)),
        }
    }

    /// Checks dimension, symmetry and definiteness.
    pub(crate) fn validate(&self, what: &'static str, dimension: usize) -> Result<(), LdsError> {
        let (rows, columns) = match self {
            Self::Isotropic(_) => (dimension, dimension),
            Self::Diagonal(variances) => (variances.len(), variances.len()),
            Self::Full(matrix) => matrix.dim(),
        };
        if (rows, columns) != (dimension, dimension) {
            return Err(LdsError::Shape {
                what,
                rows: dimension,
                columns: dimension,
                found_rows: rows,
                found_columns: columns,
            });
        }
        let definite = match self {
            Self::Isotropic(variance) => is_variance(*variance),
            Self::Diagonal(variances) => variances.iter().copied().all(is_variance),
            Self::Full(matrix) => is_symmetric(matrix.view()) && factor(matrix).is_some(),
        };
        if definite { Ok(()) } else { Err(LdsError::NotPositiveDefinite { what }) }
    }

    /// The lower Cholesky factor, `(n, n)`.
    pub(crate) fn factor(&self, dimension: usize) -> Option<Array2<f64>> {
        factor(&self.to_matrix(dimension))
    }

    /// The covariance of the given structure that fits a second-moment matrix best in likelihood
    /// while no variance (in any direction) is below `floor`; nothing when it is not finite.
    pub(crate) fn fit(
        structure: CovarianceStructure,
        moment: &Array2<f64>,
        floor: f64,
    ) -> Option<Self> {
        let variances = moment.diag();
        if !moment.iter().all(|x| x.is_finite()) {
            return None;
        }
        Some(match structure {
            CovarianceStructure::Isotropic => {
                Self::Isotropic((variances.sum() / variances.len() as f64).max(floor))
            }
            CovarianceStructure::Diagonal => Self::Diagonal(variances.mapv(|x| x.max(floor))),
            CovarianceStructure::Full => Self::Full(raise_eigenvalues(moment, floor)?),
        })
    }
}

fn is_variance(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

/// Symmetric up to rounding.
fn is_symmetric(matrix: ArrayView2<'_, f64>) -> bool {
    let size = matrix.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    let tolerance = 8.0 * f64::EPSILON * size * matrix.nrows() as f64;
    matrix.indexed_iter().all(|((i, j), x)| (x - matrix[(j, i)]).abs() <= tolerance)
}

fn factor(matrix: &Array2<f64>) -> Option<Array2<f64>> {
    let n = matrix.nrows();
    let flat: Vec<f64> = matrix.iter().copied().collect();
    let mut upper = vec![0.0; n * n];
    kernel::cholesky(&flat, &mut upper, n).then_some(())?;
    Some(Array2::from_shape_vec((n, n), upper).ok()?.reversed_axes())
}

/// The symmetric matrix with every eigenvalue raised to at least `floor`.
fn raise_eigenvalues(moment: &Array2<f64>, floor: f64) -> Option<Array2<f64>> {
    let n = moment.nrows();
    let symmetric = (moment + &moment.t()) * 0.5;
    if factor(&(&symmetric - &(Array2::<f64>::eye(n) * floor))).is_some() {
        return Some(symmetric);
    }
    let (values, vectors) = symmetric.eigh(UPLO::Lower).ok()?;
    let scaled = &vectors * &values.mapv(|x| x.max(floor));
    let mut raised: Vec<f64> = scaled.dot(&vectors.t()).iter().copied().collect();
    kernel::symmetrize(&mut raised, n);
    Array2::from_shape_vec((n, n), raised).ok()
}
