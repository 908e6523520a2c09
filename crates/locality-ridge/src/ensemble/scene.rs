//! The frames of a gap in one view: features of the neighbours, and the target, in a local frame.

use std::rc::Rc;

use mocap_core::Take;

use super::{
    kernel::Side,
    tile::Panel,
    variant::{Carrier, View},
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
    /// Frames that show the target and its neighbours.
    pub rows: &'a [usize],
    /// The row whose pose local frames refer to.
    pub reference: usize,
    /// Frames to predict.
    pub wanted: &'a [usize],
}

/// Rows and wanted frames in the local frames of one core.
pub(super) struct Frames {
    /// Local frames of the rows.
    pub rows: Vec<LocalFrame>,
    /// Local frames of the wanted frames.
    pub wanted: Vec<LocalFrame>,
    /// The target in the rows, less its mean.
    pub target: Vec<[f64; 3]>,
    pub mean: [f64; 3],
}

impl Frames {
    pub fn new(sample: &Sample<'_>, carrier: Carrier) -> Self {
        let core = core(sample, carrier.core);
        let pose =
            |t: usize| core.iter().map(|&(m, _)| point(sample.take, t, m)).collect::<Vec<_>>();
        let weights: Vec<f64> =
            core.iter().map(|(_, spread)| (spread + 2e-3).powf(-carrier.steadiness)).collect();
        let reference = Reference::weighted(&pose(sample.rows[sample.reference]), &weights);
        let frames =
            |of: &[usize]| of.iter().map(|&t| reference.frame(&pose(t))).collect::<Vec<_>>();
        let (rows, wanted) = (frames(sample.rows), frames(sample.wanted));
        let places: Vec<[f64; 3]> = sample
            .rows
            .iter()
            .zip(&rows)
            .map(|(&t, frame)| frame.to_local(point(sample.take, t, sample.target)))
            .collect();
        let n = places.len() as f64;
        let first = places[sample.reference];
        let shift: [f64; 3] =
            std::array::from_fn(|a| places.iter().map(|p| p[a] - first[a]).sum::<f64>() / n);
        let target =
            places.iter().map(|p| std::array::from_fn(|a| p[a] - first[a] - shift[a])).collect();
        Self { rows, wanted, target, mean: std::array::from_fn(|a| first[a] + shift[a]) }
    }
}

/// Features of the neighbours in local frames.
pub(super) struct Scene {
    pub frames: Rc<Frames>,
    rows: Features,
    wanted: Features,
    /// Inner products of the rows' features.
    within: Panel,
    /// Those of wanted frames with rows.
    between: Panel,
}

/// Frames with the squared lengths of their features.
struct Features {
    frames: Vec<usize>,
    squares: Vec<f64>,
}

impl Features {
    fn of(frames: &[usize], x: &Panel) -> Self {
        let square = |i: usize| x.row(i).iter().map(|c| c * c).sum();
        Self { frames: frames.to_vec(), squares: (0..frames.len()).map(square).collect() }
    }

    fn side(&self) -> Side<'_> {
        Side { frames: &self.frames, squares: &self.squares }
    }
}

impl Scene {
    pub fn new(sample: &Sample<'_>, frames: Rc<Frames>, view: View) -> Self {
        let regressors = &sample.neighbours[..view.regressors.min(sample.neighbours.len())];
        let local = |of: &[usize], frames: &[LocalFrame]| {
            let mut x = Panel::zeros(of.len(), 3 * regressors.len());
            for (i, (&t, frame)) in of.iter().zip(frames).enumerate() {
                let cells = x.row_mut(i).chunks_exact_mut(3);
                for (cells, &(m, _)) in cells.zip(regressors) {
                    cells.copy_from_slice(&frame.to_local(point(sample.take, t, m)));
                }
            }
            x
        };
        let mut x = local(sample.rows, &frames.rows);
        let mut z = local(sample.wanted, &frames.wanted);
        let relevance: Vec<f64> = regressors
            .iter()
            .flat_map(|(_, spread)| [(spread + 3e-3).powf(-view.relevance); 3])
            .collect();
        standardise(&mut x, &mut z, sample.reference, &relevance);
        Self {
            within: x.products(&x, true),
            between: z.products(&x, false),
            rows: Features::of(sample.rows, &x),
            wanted: Features::of(sample.wanted, &z),
            frames,
        }
    }

    pub fn rows(&self) -> Side<'_> {
        self.rows.side()
    }

    pub fn wanted(&self) -> Side<'_> {
        self.wanted.side()
    }

    /// Inner products of rows with rows: the lower triangle.
    pub fn within(&self) -> &Panel {
        &self.within
    }

    /// Inner products of wanted frames with rows.
    pub fn between(&self) -> &Panel {
        &self.between
    }

    /// No two frames are so many frames apart.
    pub fn lags(&self) -> usize {
        let frames = || self.rows.frames.iter().chain(&self.wanted.frames);
        let (first, last) = (frames().min(), frames().max());
        first.zip(last).map_or(0, |(first, last)| last - first + 1)
    }
}

/// Centres features on the mean of the rows `x`, weighs columns by their relevance, and makes the mean square
/// length of the rows one; does the same to `z`.
fn standardise(x: &mut Panel, z: &mut Panel, reference: usize, relevance: &[f64]) {
    let n = x.rows() as f64;
    // Around one of them, so that no digits are lost where they hardly vary.
    let origin = x.row(reference)[..relevance.len()].to_vec();
    let mut mean = vec![0.0; relevance.len()];
    for i in 0..x.rows() {
        for ((sum, c), o) in mean.iter_mut().zip(x.row(i)).zip(&origin) {
            *sum += (c - o) / n;
        }
    }
    let centre = |row: &mut [f64]| {
        for (((c, o), mean), relevance) in row.iter_mut().zip(&origin).zip(&mean).zip(relevance) {
            *c = (*c - o - mean) * relevance;
        }
    };
    (0..x.rows()).for_each(|i| centre(x.row_mut(i)));
    (0..z.rows()).for_each(|i| centre(z.row_mut(i)));
    let square: f64 = (0..x.rows()).flat_map(|i| x.row(i)).map(|c| c * c).sum::<f64>() / n;
    let floor: f64 = relevance.iter().map(|r| FLOOR_M2 * r * r).sum();
    let unit = 1.0 / square.max(floor).sqrt();
    for panel in [x, z] {
        for i in 0..panel.rows() {
            panel.row_mut(i).iter_mut().for_each(|c| *c *= unit);
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
