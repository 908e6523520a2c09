//! Weights of sum 1 that make a quadratic form least while they stay near others.

/// Newton's steps at most; five or six are usual.
const STEPS: usize = 50;

/// Halvings of a step at most.
const HALVINGS: usize = 40;

/// Newton's method has found its way where no logarithm moves by more than this ...
const CLOSE: f64 = 1e-3;

/// ... and its end here.
const DONE: f64 = 1e-12;

/// No weight counts as smaller: there it is nothing, and its logarithm stays finite.
const NOTHING: f64 = 1e-200;

/// The weights w > 0 of sum 1 that make w′Cw + `hold` Σ w ln(w / prior) least.
///
/// `c` is `(n, n)`, symmetric and without negative eigenvalues, `prior` has sum 1, and `hold` is positive, so that there is one
/// such w. Found by Newton's method for the logarithms of the weights, which differ by tens of decades, with steps
/// halved until they help.
pub(super) fn least(c: &[f64], prior: &[f64], hold: f64) -> Vec<f64> {
    let n = prior.len();
    let prior: Vec<f64> = prior.iter().map(|p| p.max(NOTHING)).collect();
    let value = |w: &[f64]| {
        let form = |k: usize| w[k] * dot(&c[k * n..(k + 1) * n], w);
        let held = |k: usize| w[k] * (w[k] / prior[k]).ln();
        (0..n).map(|k| form(k) + hold * held(k)).sum::<f64>()
    };
    let mut weights = prior.clone();
    let mut least = value(&weights);
    for _ in 0..STEPS {
        let Some(step) = newton(c, &weights, &prior, hold) else { break };
        let moved = |share: f64| {
            let raw =
                |(w, r): (&f64, &f64)| (w * (share * r).clamp(-50.0, 50.0).exp()).max(NOTHING);
            let raw: Vec<f64> = weights.iter().zip(&step).map(raw).collect();
            let sum: f64 = raw.iter().sum();
            raw.into_iter().map(|w| w / sum).collect::<Vec<f64>>()
        };
        let largest = step.iter().fold(0.0_f64, |most, r| most.max(r.abs()));
        if largest < CLOSE {
            // Values no longer tell better from worse.
            weights = moved(1.0);
            least = value(&weights);
        } else {
            let shares = std::iter::successors(Some(1.0), |share| Some(0.5 * share));
            let tried = shares.take(HALVINGS).map(moved);
            let better = tried.map(|w| (value(&w), w)).find(|(value, _)| *value < least);
            let Some((value, w)) = better else { break };
            (least, weights) = (value, w);
        }
        if largest < DONE {
            break;
        }
    }
    weights
}

/// Newton's step of each weight's logarithm; `None` where the numbers are not finite.
fn newton(c: &[f64], w: &[f64], prior: &[f64], hold: f64) -> Option<Vec<f64>> {
    let n = w.len();
    let root: Vec<f64> = w.iter().map(|w| w.sqrt()).collect();
    let gradient: Vec<f64> = (0..n)
        .map(|k| 2.0 * dot(&c[k * n..(k + 1) * n], w) + hold * ((w[k] / prior[k]).ln() + 1.0))
        .collect();
    // With D = diag(√w) the equations are (hold + 2 D C D) D⁻¹ Δw = −D (gradient + λ), where λ keeps the sum.
    let mut matrix = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            matrix[i * n + j] = 2.0 * root[i] * c[i * n + j] * root[j];
        }
        matrix[i * n + i] += hold;
    }
    factor(&mut matrix, n)?;
    let scaled: Vec<f64> = gradient.iter().zip(&root).map(|(g, d)| g * d).collect();
    let (by_gradient, by_sum) = (solve(&matrix, scaled), solve(&matrix, root.clone()));
    let lambda = -dot(&root, &by_gradient) / dot(&root, &by_sum);
    // Weights that vanish leave no digits to divide by: their steps come from their own rows of the equations.
    let change: Vec<f64> =
        (0..n).map(|k| -root[k] * (by_gradient[k] + lambda * by_sum[k])).collect();
    let step =
        |k: usize| -(gradient[k] + lambda + 2.0 * dot(&c[k * n..(k + 1) * n], &change)) / hold;
    let step: Vec<f64> = (0..n).map(step).collect();
    step.iter().all(|r| r.is_finite()).then_some(step)
}

/// Cholesky's factor in place of the lower triangle; `None` where the matrix is not positive.
fn factor(a: &mut [f64], n: usize) -> Option<()> {
    for j in 0..n {
        for i in j..n {
            let sum = a[i * n + j] - dot(&a[i * n..i * n + j], &a[j * n..j * n + j]);
            a[i * n + j] =
                if i == j { (sum > 0.0).then(|| sum.sqrt())? } else { sum / a[j * n + j] };
        }
    }
    Some(())
}

fn solve(factor: &[f64], mut x: Vec<f64>) -> Vec<f64> {
    let n = x.len();
    for i in 0..n {
        x[i] = (x[i] - dot(&factor[i * n..i * n + i], &x[..i])) / factor[i * n + i];
    }
    for i in (0..n).rev() {
        let below: f64 = (i + 1..n).map(|k| factor[k * n + i] * x[k]).sum();
        x[i] = (x[i] - below) / factor[i * n + i];
    }
    x
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where it is least, the slope is the same along all weights.
    fn is_least(c: &[f64], prior: &[f64], hold: f64) {
        let w = least(c, prior, hold);
        let n = w.len();
        assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let slope = |k: usize| {
            2.0 * dot(&c[k * n..(k + 1) * n], &w) + hold * (w[k] / prior[k].max(NOTHING)).ln()
        };
        let kept: Vec<f64> = (0..n).filter(|&k| w[k] > 1e-150).map(slope).collect();
        let spread = kept.iter().map(|s| (s - kept[0]).abs()).fold(0.0, f64::max);
        assert!(spread < 1e-6 * (1.0 + kept[0].abs()), "{w:?} {kept:?}");
    }

    #[test]
    fn slopes_agree_where_it_is_least() {
        // Errors of one part in common and one of each candidate's own, up to a million times as large.
        for hold in [0.05, 0.3, 5.0] {
            let own = [0.1, 0.5, 3.0, 100.0, 1e6];
            let common = 0.8;
            let c: Vec<f64> =
                (0..25).map(|k| common + if k % 6 == 0 { own[k / 6] } else { 0.0 }).collect();
            is_least(&c, &[0.2; 5], hold);
            let errors: Vec<f64> = (0..5).map(|k| (common + own[k]).powi(-2)).collect();
            let sum: f64 = errors.iter().sum();
            is_least(&c, &errors.iter().map(|e| e / sum).collect::<Vec<_>>(), hold);
        }
    }

    #[test]
    fn without_a_form_the_prior_stays() {
        let w = least(&[0.0; 4], &[0.3, 0.7], 1.0);
        assert!((w[0] - 0.3).abs() < 1e-12);
        assert_eq!(least(&[2.0], &[1.0], 0.1), [1.0]);
    }
}
