//! Candidates mixed by their errors in pseudo-gaps.

use std::ops::Range;

use locality_ridge::ensemble::{Candidate, PseudoGap, Sides};
use mocap_core::geometry::{add, dot, scale, sub};

use super::{
    sigma::{Errors, Spread},
    stack,
};

/// A run of filled frames.
#[derive(Debug, Clone)]
pub(super) struct Mixture {
    pub positions: Vec<[f64; 3]>,
    /// NaN where nothing is known of the errors.
    pub sigma_m: Vec<f64>,
    /// Mean square error in pseudo-gaps in m²; `None` without any.
    pub square_m2: Option<f64>,
    /// Names and weights, of sum 1.
    pub shares: Vec<(&'static str, f64)>,
    /// So many methods it is worth beforehand, see [`Rival::credit`](super::rival::Rival::credit).
    pub credit: f64,
}

/// Candidates that were mixed, to be mixed again with others.
#[derive(Debug, Clone)]
pub(super) struct Stock {
    pub candidates: Vec<Candidate>,
    pub pseudo_gaps: Vec<PseudoGap>,
    /// Frames of each that errors are known in.
    pub scored: Vec<Vec<usize>>,
}

/// Where candidates were tried.
#[derive(Clone, Copy)]
pub(super) struct Tried<'a> {
    pub pseudo_gaps: &'a [PseudoGap],
    /// Frames of each that errors are known in.
    pub scored: &'a [Vec<usize>],
    /// How much each counts.
    pub likeness: &'a [f64],
}

impl Mixture {
    /// Mixes at least one candidate for the given frames.
    pub fn of(
        candidates: &[Candidate],
        tried: Tried<'_>,
        frames: &Range<usize>,
        sides: Sides,
        rate_hz: f64,
    ) -> Self {
        Self::weighted(
            candidates,
            stack::weights(candidates, tried.likeness),
            tried,
            frames,
            sides,
            rate_hz,
        )
    }

    /// Mixes with these weights.
    pub fn weighted(
        candidates: &[Candidate],
        weights: Vec<f64>,
        tried: Tried<'_>,
        frames: &Range<usize>,
        sides: Sides,
        rate_hz: f64,
    ) -> Self {
        let mixed = |of: &dyn Fn(&Candidate) -> [f64; 3]| {
            let parts = candidates.iter().zip(&weights);
            parts.fold([0.0; 3], |sum, (candidate, &w)| add(sum, scale(w, of(candidate))))
        };
        let of_gap = |(g, frames): (usize, &Vec<usize>)| -> Vec<[f64; 3]> {
            (0..frames.len()).map(|k| mixed(&|c| c.errors[g][k])).collect()
        };
        let errors: Vec<Vec<[f64; 3]>> = tried.scored.iter().enumerate().map(of_gap).collect();
        let likeness = tried.likeness;
        let tried: Vec<Errors<'_>> = tried
            .pseudo_gaps
            .iter()
            .zip(tried.scored)
            .zip(errors.iter().zip(likeness))
            .map(|((gap, frames), (values, &counts))| Errors { gap, frames, values, counts })
            .collect();
        let dissent = dissent(candidates, &weights, frames.len(), &tried);
        let spread = Spread::of(&tried, rate_hz).map(|spread| spread.in_dissent(dissent));
        let sigma = |t: usize| spread.map_or(f64::NAN, |s| s.sigma_m(t, frames, sides));
        Self {
            positions: (0..frames.len()).map(|k| mixed(&|c| c.positions[k])).collect(),
            sigma_m: frames.clone().map(sigma).collect(),
            square_m2: mean_square(&errors, likeness),
            shares: shares(candidates, &weights),
            credit: 1.0,
        }
    }

    /// Whether it is expected to err by more than `limit_m`, root mean square, or nobody knows.
    pub fn is_poor(&self, limit_m: f64) -> bool {
        self.square_m2.is_none_or(|square| square > limit_m * limit_m)
    }

    /// Two fills of the same frames, weighed by their credit and by their errors in pseudo-gaps as if these errors had
    /// nothing in common.
    pub fn with(&self, other: &Self) -> Self {
        let weight = match (self.square_m2, other.square_m2) {
            (Some(a), Some(b)) if a + b > 0.0 => {
                let weigh = |square: f64, credit| credit * square.powf(-stack::SHARPNESS);
                let (a, b) = (weigh(a, self.credit), weigh(b, other.credit));
                if a.is_infinite() { 1.0 } else { a / (a + b) }
            }
            (None, Some(_)) => 0.0,
            _ => 1.0,
        };
        let rest = 1.0 - weight;
        let blend =
            |a: f64, b: f64| if rest == 0.0 { a } else { (weight * a * a + rest * b * b).sqrt() };
        Self {
            positions: self
                .positions
                .iter()
                .zip(&other.positions)
                .map(|(&p, &q)| add(scale(weight, p), scale(rest, q)))
                .collect(),
            sigma_m: self.sigma_m.iter().zip(&other.sigma_m).map(|(&a, &b)| blend(a, b)).collect(),
            square_m2: self.square_m2.map_or(other.square_m2, |a| {
                Some(weight * a + other.square_m2.map_or(0.0, |b| rest * b))
            }),
            shares: self
                .shares
                .iter()
                .map(|&(name, w)| (name, w * weight))
                .chain(other.shares.iter().map(|&(name, w)| (name, w * rest)))
                .collect(),
            credit: weight * self.credit + rest * other.credit,
        }
    }
}

fn mean_square(errors: &[Vec<[f64; 3]>], likeness: &[f64]) -> Option<f64> {
    let of_gap = |errors: &Vec<[f64; 3]>| {
        errors.iter().map(|&e| dot(e, e)).sum::<f64>() / errors.len() as f64
    };
    stack::weighted_mean(errors.iter().map(of_gap), errors, likeness)
}

/// Mean square distance of the candidates from their mixture in the gap, as a multiple of that in pseudo-gaps: the more
/// they differ, the less its poses are like those seen.
fn dissent(candidates: &[Candidate], weights: &[f64], frames: usize, tried: &[Errors<'_>]) -> f64 {
    let at = |of: &dyn Fn(&Candidate) -> [f64; 3]| {
        let parts = || candidates.iter().map(of).zip(weights);
        let mean = parts().fold([0.0; 3], |sum, (p, &w)| add(sum, scale(w, p)));
        parts().map(|(p, w)| w * dot(sub(p, mean), sub(p, mean))).sum::<f64>()
    };
    let mean = |n: usize, of: &dyn Fn(usize) -> f64| (0..n).map(of).sum::<f64>() / n.max(1) as f64;
    let here = mean(frames, &|k| at(&|c| c.positions[k]));
    let there = mean(tried.len(), &|g| mean(tried[g].values.len(), &|k| at(&|c| c.errors[g][k])));
    // Differences at the level of rounding are all the same.
    (here + 1e-18) / (there + 1e-18)
}

/// Weights by name, in the order in which names come.
fn shares(candidates: &[Candidate], weights: &[f64]) -> Vec<(&'static str, f64)> {
    let mut shares: Vec<(&'static str, f64)> = Vec::new();
    for (candidate, weight) in candidates.iter().zip(weights) {
        match shares.iter_mut().find(|(name, _)| *name == candidate.name) {
            Some((_, sum)) => *sum += weight,
            None => shares.push((candidate.name, *weight)),
        }
    }
    shares
}
