//! Weights of candidates from their errors in pseudo-gaps.

use locality_ridge::ensemble::Candidate;
use mocap_core::geometry::{dot, sub};

use super::simplex;

/// Before they are adjusted, weights go with the mean square error to the power of minus this,
/// with [`ENOUGH`] pseudo-gaps; the fewer there are, the less they tell.
pub(super) const SHARPNESS: f64 = 2.0;

/// How strongly the adjusted weights are held to those, as a share of the expected square error, with [`ENOUGH`]
/// pseudo-gaps.
const HOLD: f64 = 0.3;

/// Pseudo-gaps that are not few.
const ENOUGH: f64 = 8.0;

/// How much the errors of markers that are missing together count beside a marker's own.
const TOGETHER: f64 = 5.0;

/// A candidate strays that is farther from the best one than in pseudo-gaps by more than this, in mean square.
const STRAYS: f64 = 2.0;

/// Weights of sum 1, none of them negative: those that make the mean square error of the mixture in the
/// pseudo-gaps least, held by their relative entropy to weights from each candidate's own error.
///
/// The errors of candidates are alike, so that the mixture gains most from those that differ; a few
/// pseudo-gaps do not tell much about thirty candidates, so that the weights must be held.
pub(super) fn weights(candidates: &[Candidate], likeness: &[f64]) -> Vec<f64> {
    let credit = vec![1.0; candidates.len()];
    of_products(&products(candidates, likeness), &credit, tried(candidates))
}

/// Weights for each of some markers that are missing together and have the same candidates: what one of them tells
/// of the candidates counts for the others too, each marker's errors in units of its best candidate's.
///
/// `likeness` says by marker how much each pseudo-gap counts, and `credit` what speaks for a candidate beforehand.
pub(super) fn weights_together(
    markers: &[Vec<Candidate>],
    likeness: &[Vec<f64>],
    credit: &[f64],
) -> Vec<Vec<f64>> {
    let n = markers.first().map_or(0, Vec::len);
    let scaled: Vec<Vec<f64>> = markers
        .iter()
        .zip(likeness)
        .map(|(candidates, likeness)| {
            let products = strayed(candidates, products(candidates, likeness), likeness);
            let least = (0..n).map(|k| products[k * n + k]).fold(f64::INFINITY, f64::min);
            products.iter().map(|p| p / (least + 1e-18)).collect()
        })
        .collect();
    let share = TOGETHER / markers.len() as f64;
    let shared: Vec<f64> =
        (0..n * n).map(|k| share * scaled.iter().map(|s| s[k]).sum::<f64>()).collect();
    let least_tried = markers.iter().map(|candidates| tried(candidates)).min().unwrap_or(1);
    let own = |own: &Vec<f64>| {
        let sum: Vec<f64> = own.iter().zip(&shared).map(|(a, b)| a + b).collect();
        of_products(&sum, credit, least_tried)
    };
    scaled.iter().map(own).collect()
}

/// How many pseudo-gaps errors are known in.
fn tried(candidates: &[Candidate]) -> usize {
    candidates.first().map_or(0, |c| c.errors.iter().filter(|errors| !errors.is_empty()).count())
}

fn of_products(products: &[f64], credit: &[f64], tried: usize) -> Vec<f64> {
    let few = (ENOUGH / tried.max(1) as f64).max(1.0);
    let n = credit.len();
    let own: Vec<f64> = (0..n).map(|k| products[k * n + k]).collect();
    let prior = prior(&own, credit, SHARPNESS / few.sqrt());
    let scale: f64 = prior.iter().zip(&own).map(|(w, e)| w * e).sum();
    if !(scale > 0.0 && scale.is_finite()) {
        return prior;
    }
    let scaled: Vec<f64> = products.iter().map(|p| p / scale).collect();
    simplex::least(&scaled, &prior, few * HOLD)
}

/// Products of errors, larger for candidates that are farther from the best one in the gap than in pseudo-gaps: a curve
/// that overshoots in a long gap must not be judged by shorter ones.
fn strayed(candidates: &[Candidate], mut products: Vec<f64>, likeness: &[f64]) -> Vec<f64> {
    let n = candidates.len();
    let by_error = |a: &usize, b: &usize| products[a * n + a].total_cmp(&products[b * n + b]);
    let Some(best) = (0..n).min_by(by_error) else { return products };
    let factor = |k: usize| {
        // From the differences themselves: those of products would be lost in rounding where candidates are alike.
        let apart = |(a, b): (&Vec<[f64; 3]>, &Vec<[f64; 3]>)| mean_square_distance(a, b);
        let errors = candidates[k].errors.iter().zip(&candidates[best].errors).map(apart);
        let there = weighted_mean(errors, &candidates[best].errors, likeness).unwrap_or(0.0);
        let here = mean_square_distance(&candidates[k].positions, &candidates[best].positions);
        (here / (there + 1e-18) / STRAYS).sqrt().max(1.0)
    };
    let factors: Vec<f64> = (0..n).map(|k| if k == best { 1.0 } else { factor(k) }).collect();
    for (k, product) in products.iter_mut().enumerate() {
        *product *= factors[k / n] * factors[k % n];
    }
    products
}

/// Mean products of the errors of two candidates, `(n, n)` in m².
fn products(candidates: &[Candidate], likeness: &[f64]) -> Vec<f64> {
    let n = candidates.len();
    let mut products = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let (a, b) = (&candidates[i].errors, &candidates[j].errors);
            let of_gaps = a.iter().zip(b).map(|(a, b)| mean_product(a, b));
            let mean = weighted_mean(of_gaps, a, likeness).unwrap_or(0.0);
            products[i * n + j] = mean;
            products[j * n + i] = mean;
        }
    }
    products
}

/// Of values by pseudo-gap, those without any errors left out; `None` where that leaves none.
pub(super) fn weighted_mean(
    values: impl Iterator<Item = f64>,
    errors: &[Vec<[f64; 3]>],
    likeness: &[f64],
) -> Option<f64> {
    let known = values.zip(errors).zip(likeness).filter(|((_, errors), _)| !errors.is_empty());
    let (sum, counted) = known.fold((0.0, 0.0), |(sum, counted), ((value, _), counts)| {
        (sum + counts * value, counted + counts)
    });
    (counted > 0.0).then(|| sum / counted)
}

fn mean_square_distance(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let square = |(&p, &q): (&[f64; 3], &[f64; 3])| dot(sub(p, q), sub(p, q));
    a.iter().zip(b).map(square).sum::<f64>() / a.len().max(1) as f64
}

fn mean_product(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let sum: f64 = a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| x * y).sum();
    sum / a.len().max(1) as f64
}

fn prior(own: &[f64], credit: &[f64], sharpness: f64) -> Vec<f64> {
    let least = own.iter().copied().fold(f64::INFINITY, f64::min);
    // Errors at the level of rounding are all the same.
    let weigh =
        |(e, credit): (&f64, &f64)| credit * ((least + 1e-18) / (e + 1e-18)).powf(sharpness);
    let raw: Vec<f64> = own.iter().zip(credit).map(weigh).collect();
    let sum: f64 = raw.iter().sum();
    raw.iter().map(|w| w / sum).collect()
}
