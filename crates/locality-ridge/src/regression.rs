//! Ridge regression from second moments, so that folds are left out by subtraction.

use ndarray::{Array1, Array2, ArrayView2, Axis, s};

/// Variance below which a regressor counts as constant, in m²: one nanometre squared.
const FLOOR: f64 = 1e-18;

/// Sums over rows `[x | y]`, where `y` holds the last three columns.
#[derive(Debug, Clone)]
pub(crate) struct Moments {
    rows: f64,
    sum: Array1<f64>,
    products: Array2<f64>,
}

impl Moments {
    /// Moments of the rows `(n, d + 3)`.
    pub fn of(rows: ArrayView2<'_, f64>) -> Self {
        Self {
            rows: rows.nrows() as f64,
            sum: rows.sum_axis(Axis(0)),
            products: rows.t().dot(&rows),
        }
    }

    pub fn plus(mut self, other: &Self) -> Self {
        self.rows += other.rows;
        self.sum += &other.sum;
        self.products += &other.products;
        self
    }

    pub fn minus(&self, other: &Self) -> Self {
        Self {
            rows: self.rows - other.rows,
            sum: &self.sum - &other.sum,
            products: &self.products - &other.products,
        }
    }
}

/// A linear map with an offset from `d` coordinates to three.
#[derive(Debug, Clone)]
pub(crate) struct Linear {
    /// `(3, d)`.
    weights: Array2<f64>,
    offset: [f64; 3],
}

impl Linear {
    /// The minimiser of Σ ‖y − (W x + w)‖² + λ ‖W‖² with λ = `ridge` · rows · (mean variance of x).
    pub fn ridge(moments: &Moments, ridge: f64) -> Self {
        let d = moments.sum.len() - 3;
        let mean = &moments.sum / moments.rows;
        let mut centred = moments.products.clone();
        for (i, mut row) in centred.axis_iter_mut(Axis(0)).enumerate() {
            row.scaled_add(-moments.sum[i], &mean);
        }
        let trace: f64 = (0..d).map(|i| centred[(i, i)]).sum();
        let variance = (trace / (moments.rows * d.max(1) as f64)).max(0.0);
        let penalty = ridge * moments.rows * (variance + FLOOR);
        for i in 0..d {
            centred[(i, i)] += penalty;
        }
        let mut weights = centred.slice(s![d.., ..d]).to_owned();
        let factor = cholesky(centred.slice(s![..d, ..d]).to_owned());
        for mut row in weights.rows_mut() {
            if let Some(row) = row.as_slice_mut() {
                solve(&factor, row);
            }
        }
        let shift = weights.dot(&mean.slice(s![..d]));
        Self { offset: std::array::from_fn(|a| mean[d + a] - shift[a]), weights }
    }

    pub fn predict(&self, x: &[f64]) -> [f64; 3] {
        std::array::from_fn(|a| {
            let row = self.weights.row(a);
            self.offset[a] + row.as_slice().map_or(f64::NAN, |row| dot(row, x))
        })
    }
}

/// The lower factor `L` of `L Lᵀ`, in the lower triangle; NaN where the matrix is not positive.
fn cholesky(mut matrix: Array2<f64>) -> Array2<f64> {
    let n = matrix.nrows();
    let Some(a) = matrix.as_slice_mut() else { return matrix };
    for i in 0..n {
        let (above, row) = a.split_at_mut(i * n);
        for j in 0..i {
            let other = &above[j * n..=j * n + j];
            row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        row[i] = (row[i] - dot(&row[..i], &row[..i])).sqrt();
    }
    matrix
}

/// Solves `L Lᵀ x = b` in place.
fn solve(factor: &Array2<f64>, b: &mut [f64]) {
    let n = b.len();
    let Some(l) = factor.as_slice() else { return };
    for i in 0..n {
        let row = &l[i * n..=i * n + i];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
    for i in (0..n).rev() {
        let row = &l[i * n..=i * n + i];
        b[i] /= row[i];
        let x = b[i];
        for (b, l) in b[..i].iter_mut().zip(row) {
            *b -= l * x;
        }
    }
}

/// Inner product over eight running sums, which the compiler turns into vector instructions.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let mut sums = [0.0; LANES];
    let (heads, tails) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f64 = heads.remainder().iter().zip(tails.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in heads.zip(tails) {
        for k in 0..LANES {
            sums[k] += x[k] * y[k];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten features from a fixed pseudo-random sequence, and three targets.
    fn rows(n: usize) -> Array2<f64> {
        Array2::from_shape_fn((n, 13), |(t, j)| ((t * 37 + j * 101 + t * t * j) % 97) as f64 / 97.0)
    }

    /// The gradient of the penalised sum of squares vanishes at the solution.
    #[test]
    fn the_gradient_vanishes() {
        let rows = rows(60);
        let (ridge, d) = (0.02, 10);
        let model = Linear::ridge(&Moments::of(rows.view()), ridge);
        let mean = rows.mean_axis(Axis(0)).unwrap();
        let variance = rows.slice(s![.., ..d]).var_axis(Axis(0), 0.0).mean().unwrap();
        let lambda = ridge * 60.0 * (variance + FLOOR);
        for a in 0..3 {
            let mut gradient = model.weights.row(a).to_owned() * lambda;
            for row in rows.rows() {
                let x: Vec<f64> = row.iter().take(d).copied().collect();
                let error = model.predict(&x)[a] - row[d + a];
                for j in 0..d {
                    gradient[j] += error * (x[j] - mean[j]);
                }
            }
            // Sixty terms of order one.
            assert!(gradient.iter().all(|g| g.abs() < 1e-12), "{gradient}");
        }
    }

    #[test]
    fn leaving_out_is_never_having_had() {
        let rows = rows(60);
        let all = Moments::of(rows.view());
        let (tail, head) = (rows.slice(s![40.., ..]), rows.slice(s![..40, ..]));
        let left = Linear::ridge(&all.minus(&Moments::of(tail)), 1e-2);
        let direct = Linear::ridge(&Moments::of(head), 1e-2);
        // The condition of the normal equations is below 1e4.
        assert!((&left.weights - &direct.weights).iter().all(|x| x.abs() < 1e-11));
        let joined = Linear::ridge(&Moments::of(head).plus(&Moments::of(tail)), 1e-2);
        let whole = Linear::ridge(&all, 1e-2);
        assert!((&joined.weights - &whole.weights).iter().all(|x| x.abs() < 1e-11));
    }

    /// Constant regressors carry nothing, and the mean of the target is the answer.
    #[test]
    fn constants_give_the_mean() {
        let rows = Array2::from_shape_fn((8, 6), |(t, j)| if j < 3 { 0.0 } else { (t + j) as f64 });
        let model = Linear::ridge(&Moments::of(rows.view()), 1e-3);
        let mean = model.predict(&[0.0; 3]);
        assert!(mean.iter().zip([6.5, 7.5, 8.5]).all(|(x, y)| (x - y).abs() < 1e-14));
    }
}
