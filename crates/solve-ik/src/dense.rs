//! A small dense positive definite system.

/// Solves `A x = b` in place for a symmetric positive definite matrix, row by row, of which the lower
/// triangle is read; `false` if it is not positive definite.
pub(crate) fn solve(a: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    for j in 0..n {
        let (above, row) = a.split_at_mut(j * n);
        for k in 0..j {
            let other = &above[k * n..k * n + k];
            let sum: f64 = other.iter().zip(&row[..k]).map(|(x, y)| x * y).sum();
            row[k] = (row[k] - sum) / above[k * n + k];
        }
        let square = row[j] - row[..j].iter().map(|x| x * x).sum::<f64>();
        if !(square.is_finite() && square > 0.0) {
            return false;
        }
        row[j] = square.sqrt();
    }
    for j in 0..n {
        let sum: f64 = a[j * n..j * n + j].iter().zip(&b[..j]).map(|(x, y)| x * y).sum();
        b[j] = (b[j] - sum) / a[j * n + j];
    }
    for j in (0..n).rev() {
        b[j] /= a[j * n + j];
        for k in 0..j {
            b[k] -= a[j * n + k] * b[j];
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_solves() {
        let n = 7;
        let entry = |i: usize, j: usize| ((i * j + i + j) % 5) as f64 - 2.0;
        let full: Vec<f64> = (0..n * n)
            .map(|at| {
                let (i, j) = (at / n, at % n);
                (0..n).map(|k| entry(i, k) * entry(j, k)).sum::<f64>() + f64::from(u8::from(i == j))
            })
            .collect();
        let wanted: Vec<f64> = (0..n).map(|i| i as f64 - 2.5).collect();
        let product = |i: usize| (0..n).map(|j| full[i * n + j] * wanted[j]).sum::<f64>();
        let mut b: Vec<f64> = (0..n).map(product).collect();
        assert!(solve(&mut full.clone(), &mut b));
        for (x, y) in b.iter().zip(&wanted) {
            // Condition of some hundreds times a rounding.
            assert!((x - y).abs() < 1e-12);
        }
        assert!(!solve(&mut [-1.0], &mut [1.0]));
        assert!(!solve(&mut [f64::NAN], &mut [1.0]));
    }
}
