//! A take as the matrix that the model sees, and back.

use mocap_core::{Estimates, Take};
use ndarray::{Array2, Array3};

use super::Origin;
use crate::{Fit, LdsError, Observations};

/// Where the columns of the observations come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    markers: Vec<usize>,
    origin: [f64; 3],
}

impl Columns {
    /// The markers of the take that are seen at all, in order; the `k`-th has the columns
    /// `3k`, `3k + 1` and `3k + 2`.
    #[must_use]
    pub fn markers(&self) -> &[usize] {
        &self.markers
    }

    /// The place that is zero in the columns, in metres.
    #[must_use]
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }
}

/// A take as a matrix.
pub(super) struct Table {
    pub(super) columns: Columns,
    values: Array2<f64>,
    mask: Array2<bool>,
}

impl Table {
    pub(super) fn new(take: &Take, origin: Origin) -> Self {
        let seen = |m: &usize| take.observed().marker(*m).iter().any(|&seen| seen);
        let markers: Vec<usize> = (0..take.marker_count()).filter(seen).collect();
        let shape = (take.frames(), 3 * markers.len());
        let origin = match origin {
            Origin::AsRecorded => [0.0; 3],
            Origin::Centroid => centroid(take),
        };
        let mask = Array2::from_shape_fn(shape, |(t, j)| take.is_observed(t, markers[j / 3]));
        let values = Array2::from_shape_fn(shape, |(t, j)| {
            take.positions()[(t, markers[j / 3], j % 3)] - origin[j % 3]
        });
        Self { columns: Columns { markers, origin }, values, mask }
    }

    pub(super) fn observations(&self) -> Result<Observations, LdsError> {
        Observations::new(self.values.view(), self.mask.view())
    }

    pub(super) fn estimates(&self, take: &Take, fit: &Fit) -> Estimates {
        let (frames, markers) = (take.frames(), take.marker_count());
        let mut positions = Array3::from_elem((frames, markers, 3), f64::NAN);
        let mut sigma = Array2::from_elem((frames, markers), f64::NAN);
        for ((t, j), x) in fit.filled.indexed_iter() {
            positions[(t, self.columns.markers[j / 3], j % 3)] = x + self.columns.origin[j % 3];
        }
        let sigma_m = fit.deviation.as_ref().map(|deviation| {
            for (k, &m) in self.columns.markers.iter().enumerate() {
                for t in 0..frames {
                    let axes = (0..3).map(|a| deviation[(t, 3 * k + a)].powi(2));
                    sigma[(t, m)] = axes.sum::<f64>().sqrt();
                }
            }
            sigma
        });
        Estimates { positions, sigma_m }
    }
}

/// The mean of all visible samples; zero where there is none.
fn centroid(take: &Take) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (t, m) in take.observed().iter() {
        (0..3).for_each(|a| sum[a] += take.positions()[(t, m, a)]);
    }
    sum.map(|s| s / take.observed().count().max(1) as f64)
}
