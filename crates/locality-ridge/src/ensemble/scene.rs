//! The frames of a gap in one view: features of the neighbours, and the target, in a local frame.

use mocap_core::Take;
use ndarray::{Array2, Axis};

use super::{
    kernel::{Pairs, Side},
    variant::View,
};
use crate::{
    frame::{LocalFrame, Reference, is_linear},
    neighbours::point,
};

/// Features that vary by less than a nanometre are constant up to rounding, in m².
const FLOOR_M2: f64 = 1e-18;

/// What to learn from, and for which frames.
pub(super) struct Sample<'a> {
    pub take: &'a Take,
    pub target: usize,
    /// Neighbours seen in all frames below, steadiest first, with the spread of their distance in metres.
    pub neighbours: &'a [(usize, f64)],
    /// Frames that show the target and its neighbours, in ascending order.
    pub rows: &'a [usize],
    /// The row whose pose local frames refer to.
    pub reference: usize,
    /// Frames to predict.
    pub wanted: &'a [usize],
}

/// Frames and wanted frames in one view.
pub(super) struct Scene {
    /// Local frames of the rows.
    pub row_frames: Vec<LocalFrame>,
    /// Local frames of the wanted frames.
    pub wanted_frames: Vec<LocalFrame>,
    /// The target in the rows, less its mean.
    pub target: Vec<[f64; 3]>,
    pub mean: [f64; 3],
    within: Array2<f64>,
    between: Array2<f64>,
    row_squares: Vec<f64>,
    wanted_squares: Vec<f64>,
}

impl Scene {
    pub fn new(sample: &Sample<'_>, view: View) -> Self {
        let core = core(sample, view.core);
        let regressors = &sample.neighbours[..view.regressors.min(sample.neighbours.len())];
        let pose =
            |t: usize| core.iter().map(|&(m, _)| point(sample.take, t, m)).collect::<Vec<_>>();
        let weights: Vec<f64> =
            core.iter().map(|(_, spread)| (spread + 2e-3).powf(-view.steadiness)).collect();
        let reference = Reference::weighted(&pose(sample.rows[sample.reference]), &weights);
        let frames =
            |of: &[usize]| of.iter().map(|&t| reference.frame(&pose(t))).collect::<Vec<_>>();
        let (row_frames, wanted_frames) = (frames(sample.rows), frames(sample.wanted));

        let local = |of: &[usize], frames: &[LocalFrame]| {
            let mut x = Array2::zeros((of.len(), 3 * regressors.len()));
            for ((mut row, &t), frame) in x.rows_mut().into_iter().zip(of).zip(frames) {
                for (k, &(m, _)) in regressors.iter().enumerate() {
                    for (a, c) in frame.to_local(point(sample.take, t, m)).into_iter().enumerate() {
                        row[3 * k + a] = c;
                    }
                }
            }
            x
        };
        let mut x = local(sample.rows, &row_frames);
        let mut z = local(sample.wanted, &wanted_frames);
        let n = sample.rows.len() as f64;
        let origin = x.row(sample.reference).to_owned();
        x -= &origin;
        z -= &origin;
        let mean = x.sum_axis(Axis(0)) / n;
        let relevance = |k: usize| (regressors[k / 3].1 + 3e-3).powf(-view.relevance);
        for matrix in [&mut x, &mut z] {
            *matrix -= &mean;
            for (k, mut column) in matrix.columns_mut().into_iter().enumerate() {
                column *= relevance(k);
            }
        }
        let floor: f64 = (0..x.ncols()).map(|k| FLOOR_M2 * relevance(k).powi(2)).sum();
        let unit = 1.0 / (x.iter().map(|c| c * c).sum::<f64>() / n).max(floor).sqrt();
        x *= unit;
        z *= unit;

        let places: Vec<[f64; 3]> = sample
            .rows
            .iter()
            .zip(&row_frames)
            .map(|(&t, frame)| frame.to_local(point(sample.take, t, sample.target)))
            .collect();
        let first = places[sample.reference];
        let shift: [f64; 3] =
            std::array::from_fn(|a| places.iter().map(|p| p[a] - first[a]).sum::<f64>() / n);
        let target =
            places.iter().map(|p| std::array::from_fn(|a| p[a] - first[a] - shift[a])).collect();
        let squares =
            |x: &Array2<f64>| x.rows().into_iter().map(|row| row.dot(&row)).collect::<Vec<f64>>();
        Self {
            target,
            mean: std::array::from_fn(|a| first[a] + shift[a]),
            within: x.dot(&x.t()),
            between: z.dot(&x.t()),
            row_squares: squares(&x),
            wanted_squares: squares(&z),
            row_frames,
            wanted_frames,
        }
    }

    /// Pairs of rows.
    pub fn within<'a>(&'a self, rows: &'a [usize]) -> Pairs<'a> {
        let side = Side { frames: rows, squares: &self.row_squares };
        Pairs { products: self.within.as_slice().unwrap_or_default(), rows: side, columns: side }
    }

    /// Pairs of a wanted frame and a row.
    pub fn between<'a>(&'a self, wanted: &'a [usize], rows: &'a [usize]) -> Pairs<'a> {
        Pairs {
            products: self.between.as_slice().unwrap_or_default(),
            rows: Side { frames: wanted, squares: &self.wanted_squares },
            columns: Side { frames: rows, squares: &self.row_squares },
        }
    }
}

/// The first `count` neighbours, or more while they lie on a line and there are more.
fn core<'a>(sample: &Sample<'a>, count: usize) -> &'a [(usize, f64)] {
    let all = sample.neighbours.len();
    let t = sample.rows[sample.reference];
    let bent = |n: &usize| {
        let pose: Vec<_> =
            sample.neighbours[..*n].iter().map(|&(m, _)| point(sample.take, t, m)).collect();
        !is_linear(&pose)
    };
    let count = count.min(all);
    &sample.neighbours[..(count..=all).find(bent).unwrap_or(count)]
}
