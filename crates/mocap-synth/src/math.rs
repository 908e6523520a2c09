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
