//! Cholesky factors of matrices whose rows begin with zeros.

/// Factors `A + δ diag(w)` into `L Lᵀ`, both `(n, n)` row by row with the lower half in use; `false`
/// when it is not positive definite. Row `i` of `A`, and so of `L`, is zero before column
/// `3 · lowest[i / 3]`.
pub(crate) fn factor(
    a: &[f64],
    delta: f64,
    weight: &[f64],
    lowest: &[usize],
    factor: &mut [f64],
) -> bool {
    let n = weight.len();
    for i in 0..n {
        let begin = 3 * lowest[i / 3];
        let (head, tail) = factor.split_at_mut(i * n);
        let row = &mut tail[..n];
        for j in begin..i {
            let from = begin.max(3 * lowest[j / 3]);
            let other = &head[j * n..];
            row[j] = (a[i * n + j] - product(&row[from..j], &other[from..j])) / other[j];
        }
        let rest = a[i * n + i] + delta * weight[i] - product(&row[begin..i], &row[begin..i]);
        if !(rest > 0.0 && rest.is_finite()) {
            return false;
        }
        row[i] = rest.sqrt();
    }
    true
}

/// Solves `L Lᵀ x = b` in place.
pub(crate) fn solve(factor: &[f64], lowest: &[usize], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        let begin = 3 * lowest[i / 3];
        let row = &factor[i * n..(i + 1) * n];
        x[i] = (x[i] - product(&row[begin..i], &x[begin..i])) / row[i];
    }
    for i in (0..n).rev() {
        let begin = 3 * lowest[i / 3];
        let row = &factor[i * n..(i + 1) * n];
        x[i] /= row[i];
        let known = x[i];
        x[begin..i].iter_mut().zip(&row[begin..i]).for_each(|(x, l)| *x -= l * known);
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_with_an_envelope_is_solved() {
        // Blocks 0–1 and 1–2 are joined, 0–2 is not.
        let (n, lowest) = (9, [0, 0, 1]);
        let entry = |i: usize, j: usize| match (i / 3).abs_diff(j / 3) {
            0 => 0.2 + if i == j { 3.0 } else { 0.0 },
            1 => 0.1 * ((i + j) as f64).sin(),
            _ => 0.0,
        };
        let a: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
        let truth: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
        let weight = [1.0, 2.0, 1.0, 0.5, 1.0, 1.0, 3.0, 1.0, 1.0];
        let mut x: Vec<f64> = (0..n)
            .map(|i| product(&a[i * n..(i + 1) * n], &truth) + 0.5 * weight[i] * truth[i])
            .collect();
        let mut l = vec![f64::NAN; n * n];
        assert!(factor(&a, 0.5, &weight, &lowest, &mut l));
        solve(&l, &lowest, &mut x);
        // Rounding of a well-conditioned system of nine.
        assert!(x.iter().zip(&truth).all(|(x, t)| (x - t).abs() < 1e-14), "{x:?}");
        assert!(!factor(&a, -9.0, &weight, &lowest, &mut l));
    }
}
