//! The one door to functions that are not exactly rounded.
//!
//! Everything else in this crate uses `+ − × ÷ √` alone, which IEEE 754 defines to the last bit.
//! `libm` is plain Rust without platform intrinsics, so that the bits do not depend on the
//! system's mathematics library.

use mocap_core::Rotation;

pub(crate) const PI: f64 = std::f64::consts::PI;
pub(crate) const TAU: f64 = std::f64::consts::TAU;

pub(crate) fn sin_cos(radians: f64) -> (f64, f64) {
    libm::sincos(radians)
}

pub(crate) fn sin(radians: f64) -> f64 {
    libm::sin(radians)
}

pub(crate) fn cos(radians: f64) -> f64 {
    libm::cos(radians)
}

pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// The angle in `[0, π]` with this cosine, which is clamped to `[−1, 1]`.
pub(crate) fn acos(cosine: f64) -> f64 {
    let c = cosine.clamp(-1.0, 1.0);
    libm::atan2((1.0 - c * c).sqrt(), c)
}

pub(crate) fn exp(x: f64) -> f64 {
    libm::exp(x)
}

pub(crate) fn ln(x: f64) -> f64 {
    libm::log(x)
}

pub(crate) const fn degrees(angle: f64) -> f64 {
    angle * (PI / 180.0)
}

pub(crate) fn about_x(radians: f64) -> Rotation {
    let (s, c) = sin_cos(0.5 * radians);
    unit(c, [s, 0.0, 0.0])
}

pub(crate) fn about_y(radians: f64) -> Rotation {
    let (s, c) = sin_cos(0.5 * radians);
    unit(c, [0.0, s, 0.0])
}

pub(crate) fn about_z(radians: f64) -> Rotation {
    let (s, c) = sin_cos(0.5 * radians);
    unit(c, [0.0, 0.0, s])
}

fn unit(w: f64, v: [f64; 3]) -> Rotation {
    Rotation::from_quaternion(w, v).unwrap_or(Rotation::IDENTITY)
}

/// The step of N unknowns that takes most of a residual away, given how it changes with each of them:
/// `−Jᵀ (J Jᵀ + λ I)⁻¹ r`, three equations whatever the number of unknowns.
pub(crate) fn damped<const N: usize>(
    columns: &[[f64; 3]; N],
    residual: [f64; 3],
    damping: f64,
) -> [f64; N] {
    let mut normal = [[0.0; 3]; 3];
    for column in columns {
        for (a, row) in normal.iter_mut().enumerate() {
            for (b, entry) in row.iter_mut().enumerate() {
                *entry += column[a] * column[b];
            }
        }
    }
    for (a, row) in normal.iter_mut().enumerate() {
        row[a] += damping;
    }
    let weights = solve(normal, residual);
    columns.map(|column| -(0..3).map(|a| column[a] * weights[a]).sum::<f64>())
}

/// Cramer's rule for a symmetric positive definite system.
pub(crate) fn solve(m: [[f64; 3]; 3], r: [f64; 3]) -> [f64; 3] {
    let det = |c: [[f64; 3]; 3]| {
        c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1])
            - c[0][1] * (c[1][0] * c[2][2] - c[1][2] * c[2][0])
            + c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0])
    };
    let whole = det(m);
    std::array::from_fn(|k| {
        let mut replaced = m;
        for (row, value) in replaced.iter_mut().zip(r) {
            row[k] = value;
        }
        det(replaced) / whole
    })
}
