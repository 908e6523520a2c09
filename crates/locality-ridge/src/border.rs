//! The error of the regression at the borders, carried across a gap.

use crate::Residual;

/// Weight of each border's error at one frame, with the distance to the border in frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    pub left: Option<(f64, usize)>,
    pub right: Option<(f64, usize)>,
}

/// Weights at a frame `before` frames after the left border and `after` frames before the right one.
pub(crate) fn weights(
    residual: Residual,
    rate_hz: f64,
    before: Option<usize>,
    after: Option<usize>,
) -> Weights {
    let (left, right) = match (before, after) {
        (None, None) => (0.0, 0.0),
        (Some(a), None) => (alone(residual, rate_hz, a), 0.0),
        (None, Some(b)) => (0.0, alone(residual, rate_hz, b)),
        (Some(a), Some(b)) => (between(residual, rate_hz, a, b), between(residual, rate_hz, b, a)),
    };
    Weights { left: before.map(|a| (left, a)), right: after.map(|b| (right, b)) }
}

fn alone(residual: Residual, rate_hz: f64, near: usize) -> f64 {
    match residual {
        Residual::Ramp => 1.0,
        Residual::Exponential { tau_s } => (-(near as f64) / (tau_s * rate_hz)).exp(),
    }
}

/// Weight of the border `near` frames away, with another one `far` frames away on the other side.
///
/// For the exponential kernel this is sinh(far / τ) / sinh((near + far) / τ), the closed form of the
/// two kriging equations.
fn between(residual: Residual, rate_hz: f64, near: usize, far: usize) -> f64 {
    let (near, far) = (near as f64, far as f64);
    match residual {
        Residual::Ramp => far / (near + far).max(1.0),
        Residual::Exponential { tau_s } => {
            let tau = tau_s * rate_hz;
            let rise = |frames: f64| -(-2.0 * frames / tau).exp_m1();
            let share = rise(far) / rise(near + far);
            // A kernel so long that both vanish is a ramp.
            let share = if share.is_finite() { share } else { far / (near + far).max(1.0) };
            (-near / tau).exp() * share
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FADES: Residual = Residual::Exponential { tau_s: 0.1 };

    #[test]
    fn borders_are_met_exactly() {
        for residual in [Residual::Ramp, FADES] {
            let at_left = weights(residual, 120.0, Some(0), Some(30));
            assert_eq!((at_left.left, at_left.right), (Some((1.0, 0)), Some((0.0, 30))));
            assert_eq!(weights(residual, 120.0, None, Some(0)).right, Some((1.0, 0)));
        }
    }

    /// The weights solve the two kriging equations.
    #[test]
    fn kriging_equations_hold() {
        let kernel = |frames: usize| (-(frames as f64) / 12.0).exp();
        for (a, b) in [(3, 20), (11, 1), (200, 300)] {
            let w = weights(FADES, 120.0, Some(a), Some(b));
            let (left, right) = (w.left.unwrap().0, w.right.unwrap().0);
            assert!((left + right * kernel(a + b) - kernel(a)).abs() < 1e-14);
            assert!((left * kernel(a + b) + right - kernel(b)).abs() < 1e-14);
        }
    }

    #[test]
    fn a_long_kernel_is_a_ramp() {
        let long = Residual::Exponential { tau_s: 1e6 };
        for (a, b) in [(1, 9), (5, 5), (40, 2)] {
            let (ramp, fades) = (
                weights(Residual::Ramp, 100.0, Some(a), Some(b)),
                weights(long, 100.0, Some(a), Some(b)),
            );
            // The kernel falls by one part in a million over these frames.
            assert!((ramp.left.unwrap().0 - fades.left.unwrap().0).abs() < 1e-6);
        }
    }
}
