//! A trained prediction of one marker from its neighbours.

use mocap_core::{Take, geometry::sub};
use ndarray::{Array2, s};

use crate::{
    LocalRidgeParams,
    frame::{LocalFrame, Reference},
    neighbours::{Neighbours, point},
    reach::Reach,
    regression::{Linear, Moments},
    spread::Spread,
};

/// Runs of training frames, each predicted without itself to see how far the regression errs.
const FOLDS: usize = 8;

/// Predicts a marker in the local frame of its neighbours.
pub(crate) struct Predictor {
    neighbours: Neighbours,
    reference: Reference,
    /// Local coordinates in the reference frame, regressors first, the target last: rows are
    /// differences to them, so that no digits are lost where markers hardly move.
    origin: Vec<f64>,
    linear: Linear,
    reach: Reach,
    spread: Spread,
}

/// The prediction for one frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Prediction {
    pub frame: LocalFrame,
    /// In local coordinates.
    pub place: [f64; 3],
}

impl Predictor {
    pub fn train(
        take: &Take,
        target: usize,
        neighbours: Neighbours,
        params: &LocalRidgeParams,
    ) -> Self {
        let pose = neighbours.reference_frame().map(|t| (t, neighbours.core_pose(take, t)));
        let (middle, pose) = pose.unwrap_or_default();
        let reference = Reference::new(&pose);
        let mut markers = neighbours.regressors.clone();
        markers.push(target);
        let local = |t: usize| {
            let frame = reference.frame(&neighbours.core_pose(take, t));
            markers.iter().flat_map(|&m| frame.to_local(point(take, t, m))).collect::<Vec<f64>>()
        };
        let origin = local(middle);
        let mut rows = Array2::zeros((neighbours.training.len(), origin.len()));
        for (mut row, &t) in rows.rows_mut().into_iter().zip(&neighbours.training) {
            for ((cell, x), o) in row.iter_mut().zip(local(t)).zip(&origin) {
                *cell = x - o;
            }
        }
        let target_of =
            |row: ndarray::ArrayView1<'_, f64>| std::array::from_fn(|a| row[origin.len() - 3 + a]);
        let reach = Reach::of(rows.rows().into_iter().map(target_of));
        let (linear, errors) = fit(&rows, &reach, params.ridge);
        let mut by_frame = vec![None; take.frames()];
        for (&t, error) in neighbours.training.iter().zip(errors) {
            by_frame[t] = Some(error);
        }
        let spread = Spread::of(&by_frame);
        Self { neighbours, reference, origin, linear, reach, spread }
    }

    /// The prediction for a frame that shows all regressors.
    pub fn predict(&self, take: &Take, t: usize) -> Prediction {
        let frame = self.reference.frame(&self.neighbours.core_pose(take, t));
        let local =
            self.neighbours.regressors.iter().flat_map(|&m| frame.to_local(point(take, t, m)));
        let x: Vec<f64> = local.zip(&self.origin).map(|(x, o)| x - o).collect();
        let change = self.reach.limit(self.linear.predict(&x));
        let place = std::array::from_fn(|a| self.origin[x.len() + a] + change[a]);
        Prediction { frame, place }
    }

    pub fn neighbours(&self) -> &Neighbours {
        &self.neighbours
    }

    pub fn spread(&self) -> &Spread {
        &self.spread
    }
}

/// The regression on all rows, and the error of each row when its fold is left out.
fn fit(rows: &Array2<f64>, reach: &Reach, ridge: f64) -> (Linear, Vec<[f64; 3]>) {
    let (n, columns) = rows.dim();
    let folds = FOLDS.min(n);
    let bounds: Vec<usize> = (0..=folds).map(|f| f * n / folds.max(1)).collect();
    let parts: Vec<_> = bounds.windows(2).map(|w| rows.slice(s![w[0]..w[1], ..])).collect();
    let moments: Vec<Moments> = parts.iter().map(|part| Moments::of(part.view())).collect();
    let empty = Moments::of(rows.slice(s![..0, ..]));
    let all = moments.iter().fold(empty, Moments::plus);
    let mut errors = Vec::with_capacity(n);
    for (part, own) in parts.iter().zip(&moments) {
        let without = Linear::ridge(&all.minus(own), ridge);
        for row in part.rows() {
            let row = row.to_slice().unwrap_or_default();
            let (x, y) = row.split_at(columns - 3);
            errors.push(sub([y[0], y[1], y[2]], reach.limit(without.predict(x))));
        }
    }
    (Linear::ridge(&all, ridge), errors)
}
