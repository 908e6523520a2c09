//! How postures are compared.

use crate::dense::{Cholesky, inner};

/// Weight of the ridge that finds the part of a posture on which the lost joints depend, over the mean variance.
const RIDGE: f64 = 0.01;

/// What of a raw posture counts: all of it, and once more the part on which the lost turns depend linearly.
#[derive(Debug, Clone, Default)]
pub(super) struct Aspects {
    /// Rows of the linear part, one a coordinate of the lost turns.
    linear: Vec<Vec<f64>>,
    /// Scales that make each of the two half of a mean square of one.
    scales: [f64; 2],
}

impl Aspects {
    pub(super) fn new(raw: &[Vec<f64>], targets: &[Vec<f64>]) -> Option<Self> {
        let (n, d) = (raw.len(), raw[0].len());
        let columns: Vec<Vec<f64>> =
            (0..d).map(|c| raw.iter().map(|row| row[c]).collect()).collect();
        let mut matrix = vec![0.0; d * d];
        for i in 0..d {
            for j in 0..=i {
                matrix[i * d + j] = inner(&columns[i], &columns[j]);
            }
        }
        let trace: f64 = (0..d).map(|i| matrix[i * d + i]).sum();
        (0..d).for_each(|i| matrix[i * d + i] += RIDGE * trace / d as f64);
        let factor = Cholesky::new(matrix, d)?;
        let linear: Vec<Vec<f64>> = targets
            .iter()
            .map(|target| {
                let mut row: Vec<f64> = columns.iter().map(|c| inner(c, target)).collect();
                factor.solve(&mut row);
                row
            })
            .collect();
        let mut aspects = Self { linear, scales: [1.0; 2] };
        let fitted: f64 =
            raw.iter().flat_map(|row| aspects.fitted(row)).map(|z| z * z).sum::<f64>();
        let half = |square: f64| if square > 0.0 { (0.5 * n as f64 / square).sqrt() } else { 0.0 };
        aspects.scales = [half(trace), half(fitted)];
        Some(aspects)
    }

    fn fitted<'a>(&'a self, raw: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.linear.iter().map(move |row| inner(row, raw))
    }

    pub(super) fn posture(&self, raw: &[f64]) -> Vec<f64> {
        let whole = raw.iter().map(|x| self.scales[0] * x);
        whole.chain(self.fitted(raw).map(|z| self.scales[1] * z)).collect()
    }
}
