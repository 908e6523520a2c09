//! How far a regression errs, and for how long it errs alike.

use mocap_core::geometry::{dot, sub};

use crate::border::Weights;

/// Second-order statistics of a regression's errors over time.
#[derive(Debug, Clone)]
pub(crate) struct Spread {
    /// Mean square error in m².
    variance: f64,
    /// Mean square change of the error in m² by its lag in frames, in ascending order of lag.
    structure: Vec<(usize, f64)>,
}

impl Spread {
    /// Statistics of errors `(T,)`, `None` in frames that have none.
    pub fn of(errors: &[Option<[f64; 3]>]) -> Self {
        let known = || errors.iter().flatten();
        let variance = known().map(|&e| dot(e, e)).sum::<f64>() / known().count().max(1) as f64;
        let mut structure = Vec::new();
        let mut lag = 1;
        while lag <= errors.len() / 2 {
            let (mut pairs, mut sum) = (0_usize, 0.0);
            for (e, f) in errors.iter().zip(&errors[lag..]) {
                if let (Some(e), Some(f)) = (e, f) {
                    let change = sub(*e, *f);
                    pairs += 1;
                    sum += dot(change, change);
                }
            }
            if pairs > 0 {
                structure.push((lag, sum / pairs as f64));
            }
            lag += lag.div_ceil(3);
        }
        Self { variance, structure }
    }

    /// Root mean square of the 3-D error in metres where border errors were carried with `weights`.
    pub fn sigma_m(&self, weights: &Weights) -> f64 {
        let covariance = |lag: usize| self.variance - 0.5 * self.change(lag);
        let Weights { left, right } = *weights;
        let mut square = self.variance;
        for (weight, lag) in [left, right].into_iter().flatten() {
            square += weight * weight * self.variance - 2.0 * weight * covariance(lag);
        }
        if let (Some((a, before)), Some((b, after))) = (left, right) {
            square += 2.0 * a * b * covariance(before + after);
        }
        square.max(0.0).sqrt()
    }

    /// Mean square change of the error over a lag; errors further apart than known are independent.
    fn change(&self, lag: usize) -> f64 {
        let after = self.structure.partition_point(|&(known, _)| known < lag);
        let Some(&(high, above)) = self.structure.get(after) else { return 2.0 * self.variance };
        let (low, below) = after.checked_sub(1).map_or((0, 0.0), |before| self.structure[before]);
        below + (above - below) * (lag - low) as f64 / (high - low).max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors that never change are known everywhere once they are known at a border.
    #[test]
    fn a_constant_error_is_carried_whole() {
        let spread = Spread::of(&[Some([0.003, 0.0, 0.004]); 50]);
        let alone = Weights { left: None, right: None };
        assert!((spread.sigma_m(&alone) - 0.005).abs() < 1e-12);
        let ramp = Weights { left: Some((0.75, 5)), right: Some((0.25, 15)) };
        assert!(spread.sigma_m(&ramp) < 1e-9);
    }

    /// Errors of independent frames add up in square.
    #[test]
    fn independent_errors_add() {
        let errors: Vec<_> = (0..4000_u32)
            .map(|t| {
                let bits = t.wrapping_mul(0x9E37_79B1);
                let bits = (bits ^ bits >> 15).wrapping_mul(0x85EB_CA6B);
                Some([if bits & 0x8000 == 0 { 0.001 } else { -0.001 }, 0.0, 0.0])
            })
            .collect();
        let one_sided = Weights { left: Some((1.0, 40)), right: None };
        let sigma = Spread::of(&errors).sigma_m(&one_sided);
        // Four thousand signs determine the covariance to 2 %.
        assert!((sigma / 0.001 - 2.0_f64.sqrt()).abs() < 0.1, "{sigma}");
    }
}
