//! Three-vectors, rotations and rigid transforms.

pub use crate::fit::{best_rotation, symmetric_eigen};

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

/// A rotation, held as a unit quaternion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    w: f64,
    v: [f64; 3],
}

impl Rotation {
    /// The rotation that moves nothing.
    pub const IDENTITY: Self = Self { w: 1.0, v: [0.0; 3] };

    /// Rotation about an axis through the origin; the identity for a zero axis.
    ///
    /// # Units
    /// Radians.
    #[must_use]
    pub fn about(axis: [f64; 3], radians: f64) -> Self {
        let length = norm(axis);
        if length <= f64::MIN_POSITIVE || !length.is_finite() {
            return Self::IDENTITY;
        }
        let (sin, cos) = (0.5 * radians).sin_cos();
        Self { w: cos, v: scale(sin / length, axis) }
    }

    /// The rotation of a quaternion `w + xi + yj + zk` of any non-zero length.
    #[must_use]
    pub fn from_quaternion(w: f64, v: [f64; 3]) -> Option<Self> {
        let length = (w * w + dot(v, v)).sqrt();
        (length.is_finite() && length > f64::MIN_POSITIVE)
            .then(|| Self { w: w / length, v: scale(1.0 / length, v) })
    }

    /// The unit quaternion as `(w, [x, y, z])`.
    #[must_use]
    #[inline]
    pub fn quaternion(self) -> (f64, [f64; 3]) {
        (self.w, self.v)
    }

    /// The rotation that applies `other` first and `self` second.
    #[must_use]
    #[inline]
    pub fn after(self, other: Self) -> Self {
        let w = self.w * other.w - dot(self.v, other.v);
        let v = add(add(scale(self.w, other.v), scale(other.w, self.v)), cross(self.v, other.v));
        Self { w, v }
    }

    /// The rotation that undoes this one.
    #[must_use]
    #[inline]
    pub fn inverse(self) -> Self {
        Self { w: self.w, v: scale(-1.0, self.v) }
    }

    /// Rotates a vector.
    #[must_use]
    #[inline]
    pub fn apply(self, p: [f64; 3]) -> [f64; 3] {
        let t = scale(2.0, cross(self.v, p));
        add(add(p, scale(self.w, t)), cross(self.v, t))
    }

    /// The rotation matrix, row by row.
    #[must_use]
    pub fn matrix(self) -> [[f64; 3]; 3] {
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| self.apply(e));
        std::array::from_fn(|r| std::array::from_fn(|c| columns[c][r]))
    }
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
