//! How alike the target is taken to be in two frames.
#![allow(clippy::inline_always, reason = "a kernel must take on the vectors of its caller")]

use super::{frames_of, tile::Panel};

/// Covariance of the target's local position in two frames, as a multiple of the same unit as `noise`.
///
/// With features `x` of unit mean square length and times `t`: `linear` x·x′ + `curved` + `drift`, and
/// `noise` where the frames are the same. With `linear` alone it is ridge regression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kernel {
    pub linear: f64,
    pub curved: Curved,
    pub drift: Drift,
    pub noise: f64,
}

/// Alike in like poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Curved {
    pub variance: f64,
    /// Distance of features over which it falls.
    pub length: f64,
    pub shape: Shape,
    /// Seconds after which a like pose counts less; infinite where it never does.
    pub fade_s: f64,
}

/// Of the distance of features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// exp(−d² / 2 length²)
    Gaussian,
    /// exp(−d / length)
    Exponential,
}

/// Alike at like times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drift {
    pub variance: f64,
    pub tau_s: f64,
    pub path: Path,
}

/// What a drifting target does between two frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Path {
    /// It wanders, with covariance exp(−|t − t′| / τ).
    Rough,
    /// It glides, twice differentiable: the Matérn covariance of order 5/2, [RW06] Eq. (4.17).
    Smooth,
}

/// Features of a set of frames, as far as covariances need them.
#[derive(Clone, Copy)]
pub(super) struct Side<'a> {
    pub frames: &'a [usize],
    /// Squared lengths of the features.
    pub squares: &'a [f64],
}

/// After so many time constants a billionth is left.
const GONE: f64 = 21.0;

/// A kernel with what depends on time alone, by lag in frames; longer lags are as the last.
pub(super) struct Timed {
    kernel: Kernel,
    drift: Vec<f64>,
    /// Factor of the curved part; empty where it never fades.
    fade: Vec<f64>,
}

impl Kernel {
    /// The kernel for frames that are fewer than `lags` apart.
    pub fn timed(self, lags: usize, rate_hz: f64) -> Timed {
        let seconds = |lag: usize| lag as f64 / rate_hz;
        let fade = |lag: usize| (-seconds(lag) / self.curved.fade_s).exp();
        let fades = self.curved.fade_s.is_finite() && self.curved.variance > 0.0;
        let slowest_s =
            if fades { self.curved.fade_s.max(self.drift.tau_s) } else { self.drift.tau_s };
        let lags = lags.min(frames_of(GONE * slowest_s, rate_hz)).max(1);
        Timed {
            kernel: self,
            drift: (0..lags).map(|lag| self.drift.at(seconds(lag))).collect(),
            fade: if fades { (0..lags).map(fade).collect() } else { Vec::new() },
        }
    }
}

impl Timed {
    /// Covariances of observations in a set of frames, from inner products of their features `(n, n)`: the lower
    /// triangle, noise included.
    pub fn within(&self, products: &Panel, side: Side<'_>) -> Panel {
        pulp::Arch::new().dispatch(Within { timed: self, products, side })
    }

    /// One row of covariances with a set of frames, from inner products of the features.
    #[inline(always)]
    pub fn row(
        &self,
        products: &[f64],
        square: f64,
        frame: usize,
        side: Side<'_>,
        out: &mut [f64],
    ) {
        self.by_pose(products, square, side.squares, out);
        let last = self.drift.len() - 1;
        if self.fade.is_empty() {
            for ((out, product), at) in out.iter_mut().zip(products).zip(side.frames) {
                let lag = frame.abs_diff(*at).min(last);
                *out += self.kernel.linear * product + self.drift[lag];
            }
        } else {
            for ((out, product), at) in out.iter_mut().zip(products).zip(side.frames) {
                let lag = frame.abs_diff(*at).min(last);
                *out = self.fade[lag] * *out + self.kernel.linear * product + self.drift[lag];
            }
        }
    }

    /// The curved part.
    #[inline(always)]
    fn by_pose(&self, products: &[f64], square: f64, squares: &[f64], out: &mut [f64]) {
        let Curved { variance, length, shape, .. } = self.kernel.curved;
        if variance == 0.0 {
            out.fill(0.0);
            return;
        }
        let unit = 1.0 / (length * length);
        let cells = out.iter_mut().zip(products).zip(squares);
        match shape {
            Shape::Gaussian => {
                for ((out, product), other) in cells {
                    let apart = (square + other - 2.0 * product).max(0.0);
                    *out = variance * exp(-0.5 * unit * apart);
                }
            }
            Shape::Exponential => {
                for ((out, product), other) in cells {
                    let apart = (square + other - 2.0 * product).max(0.0);
                    *out = variance * exp(-(unit * apart).sqrt());
                }
            }
        }
    }
}

struct Within<'a> {
    timed: &'a Timed,
    products: &'a Panel,
    side: Side<'a>,
}

impl pulp::WithSimd for Within<'_> {
    type Output = Panel;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Panel {
        let Self { timed, products, side } = self;
        let n = side.frames.len();
        let mut out = Panel::zeros(n, n);
        for i in 0..n {
            let until = Side { frames: &side.frames[..=i], squares: &side.squares[..=i] };
            let (square, frame) = (side.squares[i], side.frames[i]);
            let row = &mut out.row_mut(i)[..=i];
            timed.row(&products.row(i)[..=i], square, frame, until, row);
            row[i] += timed.kernel.noise;
        }
        out
    }
}

/// The exponential of a number that is not positive, to two roundings, without a branch, so that loops over it become
/// vector instructions: 2ᵏ eʳ with |r| ≤ ln 2 / 2, by the Taylor series of degree 13.
#[inline(always)]
fn exp(x: f64) -> f64 {
    /// Adding it rounds to whole numbers, which stand in the last bits of the sum.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
    const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    const SERIES: [f64; 14] = [
        1.0,
        1.0,
        1.0 / 2.0,
        1.0 / 6.0,
        1.0 / 24.0,
        1.0 / 120.0,
        1.0 / 720.0,
        1.0 / 5_040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        1.0 / 479_001_600.0,
        1.0 / 6_227_020_800.0,
    ];
    // Smaller ones would leave the normal numbers.
    let x = x.max(-700.0);
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let k = shifted - ROUND;
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    let mut sum = SERIES[13];
    for c in SERIES[..13].iter().rev() {
        sum = sum * r + c;
    }
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(1023 << 52));
    sum * power
}

impl Curved {
    pub const NONE: Self =
        Self { variance: 0.0, length: 1.0, shape: Shape::Gaussian, fade_s: f64::INFINITY };
}

impl Drift {
    fn at(&self, seconds: f64) -> f64 {
        let lags = seconds / self.tau_s;
        self.variance
            * match self.path {
                Path::Rough => (-lags).exp(),
                Path::Smooth => {
                    let a = 5.0_f64.sqrt() * lags;
                    (1.0 + a + a * a / 3.0) * (-a).exp()
                }
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_that_of_the_library() {
        for k in 0..70_000 {
            let x = -f64::from(k) * 0.01;
            // Two roundings.
            assert!((exp(x) / x.exp() - 1.0).abs() < 5e-16, "{x}");
        }
        assert!(exp(-1e9) < 1e-300 && exp(f64::NEG_INFINITY) < 1e-300);
    }

    /// Both ways to the covariance of two frames agree, and fading and drift are in it.
    #[test]
    fn covariances_are_the_sum_of_their_parts() {
        let kernel = Kernel {
            linear: 2.0,
            curved: Curved { variance: 3.0, length: 1.5, shape: Shape::Gaussian, fade_s: 0.5 },
            drift: Drift { variance: 0.7, tau_s: 0.25, path: Path::Rough },
            noise: 0.1,
        };
        let (features, frames) = ([0.0, 0.5, 2.0], [3, 10, 40]);
        let squares = features.map(|x: f64| x * x);
        let mut products = Panel::zeros(3, 3);
        for i in 0..3 {
            for j in 0..3 {
                products.row_mut(i)[j] = features[i] * features[j];
            }
        }
        let side = Side { frames: &frames, squares: &squares };
        let timed = kernel.timed(38, 100.0);
        let within = timed.within(&products, side);
        for i in 0..3 {
            let mut row = [0.0; 3];
            timed.row(&products.row(i)[..3], squares[i], frames[i], side, &mut row);
            for j in 0..=i {
                let seconds = frames[i].abs_diff(frames[j]) as f64 / 100.0;
                let apart: f64 = features[i] - features[j];
                let expected = 2.0 * features[i] * features[j]
                    + 3.0 * (-apart * apart / 4.5).exp() * (-seconds / 0.5).exp()
                    + 0.7 * (-seconds / 0.25).exp();
                let noise = if i == j { 0.1 } else { 0.0 };
                assert!((row[j] - expected).abs() < 1e-13);
                assert!((within.row(i)[j] - expected - noise).abs() < 1e-13);
            }
        }
    }
}
