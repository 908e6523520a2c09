use crate::geometry::{add, best_rotation, cross, dot, norm, scale};

/// A rotation, held as a unit quaternion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    w: f64,
    v: [f64; 3],
}

/// How far the rows of a rotation matrix may be from orthonormal: the rounding of files, and more.
const ORTHONORMAL: f64 = 1e-6;

/// Sine of the smallest angle between two directions that span a plane.
const PARALLEL: f64 = 1e-9;

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

    /// The rotation of a rotation vector: about its direction, by its length. Any vector will do.
    ///
    /// # Units
    /// Radians.
    #[must_use]
    #[inline]
    pub fn exp(vector: [f64; 3]) -> Self {
        let half = 0.5 * norm(vector);
        // sin(x)/x without its removable singularity; the next term is below a rounding.
        let sinc = if half < 1e-4 { 1.0 - half * half / 6.0 } else { half.sin() / half };
        Self { w: half.cos(), v: scale(0.5 * sinc, vector) }
    }

    /// The shortest rotation vector; at half a turn, where two are equally short, either of them.
    ///
    /// # Units
    /// Radians; its length is at most π.
    #[must_use]
    #[inline]
    pub fn log(self) -> [f64; 3] {
        let sine = norm(self.v);
        let half = sine.atan2(self.w.abs());
        let stretch = if sine < 1e-12 { 1.0 } else { half / sine };
        scale(2.0 * stretch.copysign(self.w), self.v)
    }

    /// The angle of the rotation, from 0 to π.
    ///
    /// # Units
    /// Radians.
    #[must_use]
    pub fn angle(self) -> f64 {
        2.0 * norm(self.v).atan2(self.w.abs())
    }

    /// The rotation of a matrix, row by row; `None` unless it is orthonormal to 1e-6 and no reflection.
    #[must_use]
    pub fn from_matrix(m: &[[f64; 3]; 3]) -> Option<Self> {
        for (i, row) in m.iter().enumerate() {
            for (j, other) in m.iter().enumerate().take(i + 1) {
                let off = dot(*row, *other) - f64::from(u8::from(i == j));
                if off.is_nan() || off.abs() > ORTHONORMAL {
                    return None;
                }
            }
        }
        (dot(cross(m[0], m[1]), m[2]) > 0.0).then(|| Self::of_orthonormal(m))
    }

    /// The rotation nearest to a matrix, row by row, in the Frobenius norm: never a reflection, also where
    /// the matrix is one. `None` for entries that are not finite, and for a zero matrix.
    ///
    /// By [`best_rotation`].
    #[must_use]
    pub fn nearest(m: &[[f64; 3]; 3]) -> Option<Self> {
        let largest = m.iter().flatten().fold(0.0_f64, |a, c| a.max(c.abs()));
        let finite = m.iter().flatten().all(|c| c.is_finite());
        // The matrix maps basis vector a to column a, so its sums of products are its transpose.
        (finite && largest > 0.0).then(|| {
            best_rotation(&std::array::from_fn(|a| std::array::from_fn(|b| m[b][a] / largest)))
        })
    }

    /// The rotation whose matrix has its first column along `a` and its second in the plane of `a` and `b`, by
    /// Gram and Schmidt. The third is the cross product of the two, so that no reflection can come out.
    /// `None` where the two are parallel, zero or not finite.
    ///
    /// Implements [Zhou19] Eq. (15).
    #[must_use]
    pub fn from_six(a: [f64; 3], b: [f64; 3]) -> Option<Self> {
        let unit = |p: [f64; 3]| {
            // Scaled first, so that the squares of tiny and huge vectors are numbers.
            let largest = p.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
            let p = p.map(|c| c / largest);
            let length = norm(p);
            (length.is_finite() && length > 0.0).then(|| scale(1.0 / length, p))
        };
        let (x, b) = (unit(a)?, unit(b)?);
        let across = add(b, scale(-dot(x, b), x));
        if norm(across) <= PARALLEL {
            return None;
        }
        let y = unit(across)?;
        // Once more: what rounding left along x weighs more the closer the two directions are.
        let y = unit(add(y, scale(-dot(x, y), x)))?;
        let z = cross(x, y);
        Some(Self::of_orthonormal(&std::array::from_fn(|r| [x[r], y[r], z[r]])))
    }

    /// The first two columns of the matrix, a continuous parametrisation of rotations.
    #[must_use]
    pub fn six(self) -> [[f64; 3]; 2] {
        [self.apply([1.0, 0.0, 0.0]), self.apply([0.0, 1.0, 0.0])]
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

    /// The same rotation with the quaternion's length set to 1 again, after many products.
    #[must_use]
    #[inline]
    pub fn normalized(self) -> Self {
        Self::from_quaternion(self.w, self.v).unwrap_or(Self::IDENTITY)
    }

    /// The rotation a share of the way from this one to `other`, at constant speed along the shortest way.
    #[must_use]
    pub fn toward(self, other: Self, share: f64) -> Self {
        self.after(Self::exp(scale(share, self.inverse().after(other).log()))).normalized()
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
    #[inline]
    pub fn matrix(self) -> [[f64; 3]; 3] {
        let (w, [x, y, z]) = (self.w, self.v);
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    }

    /// The quaternion of an orthonormal matrix, from its largest component, which is at least ½: no
    /// square root of a difference of near equals.
    pub(crate) fn of_orthonormal(m: &[[f64; 3]; 3]) -> Self {
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *m;
        let trace = xx + yy + zz;
        let q = if trace >= xx.max(yy).max(zz) {
            [1.0 + trace, zy - yz, xz - zx, yx - xy]
        } else if xx >= yy.max(zz) {
            [zy - yz, 1.0 + xx - yy - zz, xy + yx, xz + zx]
        } else if yy >= zz {
            [xz - zx, xy + yx, 1.0 - xx + yy - zz, yz + zy]
        } else {
            [yx - xy, xz + zx, yz + zy, 1.0 - xx - yy + zz]
        };
        Self::from_quaternion(q[0], [q[1], q[2], q[3]]).unwrap_or(Self::IDENTITY)
    }
}

/// The matrix `J` with `exp(v + d) = exp(J d) · exp(v)` to first order in `d`, row by row.
///
/// # Units
/// Radians.
#[must_use]
pub fn exp_jacobian(v: [f64; 3]) -> [[f64; 3]; 3] {
    let square = dot(v, v);
    let angle = square.sqrt();
    // The series where the closed forms cancel; their next terms are below a rounding.
    let (a, b) = if angle < 1e-2 {
        (
            0.5 - square * (1.0 / 24.0 - square / 720.0),
            1.0 / 6.0 - square * (1.0 / 120.0 - square / 5040.0),
        )
    } else {
        ((1.0 - angle.cos()) / square, (angle - angle.sin()) / (square * angle))
    };
    second_order(v, a, b)
}

/// The matrix `J` with `log(exp(d) · exp(v)) = v + J d` to first order in `d`, row by row: the inverse of
/// [`exp_jacobian`], for rotation vectors shorter than a full turn.
///
/// # Units
/// Radians.
#[must_use]
#[inline]
pub fn log_jacobian(v: [f64; 3]) -> [[f64; 3]; 3] {
    let square = dot(v, v);
    let half = 0.5 * square.sqrt();
    let b = if half < 5e-3 {
        1.0 / 12.0 + square * (1.0 / 720.0 + square / 30240.0)
    } else {
        // (1 − x cot x) / θ² with x half the angle: finite at half a turn, where the usual form is 0/0.
        (1.0 - half * half.cos() / half.sin()) / square
    };
    second_order(v, -0.5, b)
}

/// `I + a [v] + b [v]²` with `[v]` the matrix of the cross product.
#[inline]
fn second_order(v: [f64; 3], a: f64, b: f64) -> [[f64; 3]; 3] {
    let [x, y, z] = v;
    let diagonal = 1.0 - b * dot(v, v);
    [
        [diagonal + b * x * x, b * x * y - a * z, b * x * z + a * y],
        [b * x * y + a * z, diagonal + b * y * y, b * y * z - a * x],
        [b * x * z - a * y, b * y * z + a * x, diagonal + b * z * z],
    ]
}
