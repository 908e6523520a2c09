use std::ops::ControlFlow;

use mocap_core::{
    Estimates, FillError, Filled, GapFiller, IterReport, Take,
    geometry::{dot, sub, symmetric_eigen},
};
use ndarray::{Array2, Array3};

/// A filler that sees the take along its own axes: those along which its samples spread most and least.
///
/// Methods that treat the three coordinates apart depend on where the axes of a recording point. Along axes that turn
/// with the take their fill turns with it as well.
#[derive(Debug, Clone)]
pub(crate) struct OwnAxes<F> {
    inner: F,
}

impl<F: GapFiller> OwnAxes<F> {
    pub fn new(inner: F) -> Self {
        Self { inner }
    }
}

impl<F: GapFiller> GapFiller for OwnAxes<F> {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let axes = Axes::of(take);
        let turned = take.map_positions(|_, _, p| axes.turn_in(p))?;
        let filled = self.inner.fill_observed(&turned, observer)?;
        let shape = (take.frames(), take.marker_count());
        let mut positions = Array3::from_elem((shape.0, shape.1, 3), f64::NAN);
        for (t, m) in filled.take().observed().iter() {
            // Samples that were there before come from the take itself.
            let place = filled.take().position(t, m).map(|p| axes.turn_out(p));
            for (a, c) in place.into_iter().flatten().enumerate() {
                positions[(t, m, a)] = c;
            }
        }
        let sigma = |(t, m)| filled.sigma_m(t, m).unwrap_or(f64::NAN);
        let sigma_m = Some(Array2::from_shape_fn(shape, sigma));
        let report = filled.report().clone();
        Ok(Filled::merge(take, Estimates { positions, sigma_m }, report)?)
    }
}

/// Three axes at right angles, in world coordinates, through the centre of a take.
struct Axes {
    axes: [[f64; 3]; 3],
    centre: [f64; 3],
}

impl Axes {
    fn of(take: &Take) -> Self {
        let seen = || take.observed().iter().filter_map(|(t, m)| take.position(t, m));
        let n = seen().count().max(1) as f64;
        let mut centre = [0.0; 3];
        for p in seen() {
            centre.iter_mut().zip(p).for_each(|(sum, c)| *sum += c / n);
        }
        let mut scatter = [[0.0; 3]; 3];
        for p in seen().map(|p| sub(p, centre)) {
            for (row, x) in scatter.iter_mut().zip(p) {
                row.iter_mut().zip(p).for_each(|(entry, y)| *entry += x * y);
            }
        }
        let (_, columns) = symmetric_eigen(scatter);
        Self { axes: std::array::from_fn(|k| columns.map(|row| row[k])), centre }
    }

    fn turn_in(&self, p: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, sub(p, self.centre)))
    }

    fn turn_out(&self, q: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| {
            self.centre[a] + self.axes.iter().zip(q).map(|(axis, c)| axis[a] * c).sum::<f64>()
        })
    }
}
