//! A small dense positive definite system.

/// The lower triangular factor of a symmetric positive definite matrix, row by row.
#[derive(Debug, Clone)]
pub(crate) struct Cholesky {
    factor: Vec<f64>,
    size: usize,
}

impl Cholesky {
    /// Factors a matrix `(size, size)` of which the lower triangle is read; `None` if it is not positive definite.
    pub(crate) fn new(mut a: Vec<f64>, size: usize) -> Option<Self> {
        let n = size;
        for j in 0..n {
            let (above, row) = a.split_at_mut(j * n);
            for k in 0..j {
                let other = &above[k * n..k * n + k];
                row[k] = (row[k] - inner(other, &row[..k])) / above[k * n + k];
            }
            let square = row[j] - inner(&row[..j], &row[..j]);
            if !(square.is_finite() && square > 0.0) {
                return None;
            }
            row[j] = square.sqrt();
        }
        Some(Self { factor: a, size })
    }

    /// Solves `A x = b` in place.
    pub(crate) fn solve(&self, b: &mut [f64]) {
        let (a, n) = (&self.factor, self.size);
        for j in 0..n {
            b[j] = (b[j] - inner(&a[j * n..j * n + j], &b[..j])) / a[j * n + j];
        }
        for j in (0..n).rev() {
            b[j] /= a[j * n + j];
            let x = b[j];
            for (b, l) in b[..j].iter_mut().zip(&a[j * n..j * n + j]) {
                *b -= l * x;
            }
        }
    }
}

/// The inner product, in four sums that do not wait for each other.
pub(crate) fn inner(x: &[f64], y: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (x4, y4) = (x.chunks_exact(4), y.chunks_exact(4));
    let rest: f64 = x4.remainder().iter().zip(y4.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in x4.zip(y4) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
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
        Cholesky::new(full, n).unwrap().solve(&mut b);
        for (x, y) in b.iter().zip(&wanted) {
            // Condition of some hundreds times a rounding.
            assert!((x - y).abs() < 1e-12);
        }
        assert!(Cholesky::new(vec![-1.0], 1).is_none());
        assert!(Cholesky::new(vec![f64::NAN], 1).is_none());
    }
}
