//! Three-vectors, rotations and rigid transforms.

pub use crate::{
    fit::{best_rotation, symmetric_eigen},
    rotation::{Rotation, exp_jacobian, log_jacobian},
};

/// `p − q`.
#[must_use]
#[inline]
pub fn sub(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|a| p[a] - q[a])
}

/// `p + q`.
#[must_use]
#[inline]
pub fn add(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|a| p[a] + q[a])
}

/// `s · p`.
#[must_use]
#[inline]
pub fn scale(s: f64, p: [f64; 3]) -> [f64; 3] {
    p.map(|c| s * c)
}

/// Inner product.
#[must_use]
#[inline]
pub fn dot(p: [f64; 3], q: [f64; 3]) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

/// Cross product.
#[must_use]
#[inline]
pub fn cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

/// Euclidean length.
#[must_use]
#[inline]
pub fn norm(p: [f64; 3]) -> f64 {
    dot(p, p).sqrt()
}

/// Euclidean distance.
#[must_use]
#[inline]
pub fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    norm(sub(p, q))
}

/// Matrix, row by row, times a column.
#[must_use]
#[inline]
pub fn times(m: &[[f64; 3]; 3], p: [f64; 3]) -> [f64; 3] {
    m.map(|row| dot(row, p))
}

/// Product of two matrices, row by row.
#[must_use]
#[inline]
pub fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let column = |c: usize| [b[0][c], b[1][c], b[2][c]];
    a.map(|row| std::array::from_fn(|c| dot(row, column(c))))
}

/// Transposed matrix.
#[must_use]
#[inline]
pub fn transposed(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|r| std::array::from_fn(|c| m[c][r]))
}

/// Cofactors of a matrix, row by row: its determinant times its transposed inverse.
#[must_use]
#[inline]
pub fn cofactors(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])]
}

/// A rotation followed by a translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidTransform {
    /// Applied first.
    pub rotation: Rotation,
    /// Applied second, in metres.
    pub translation: [f64; 3],
}

impl RigidTransform {
    /// Moves a point.
    #[must_use]
    #[inline]
    pub fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        add(self.rotation.apply(p), self.translation)
    }

    /// Moves a point back.
    #[must_use]
    #[inline]
    pub fn undo(&self, p: [f64; 3]) -> [f64; 3] {
        self.rotation.inverse().apply(sub(p, self.translation))
    }
}
