//! The frames of a gap as seen from the neighbours that carry a local frame.

use mocap_core::{
    Take,
    geometry::{add, scale, sub},
};

use super::{scene::Sample, variant::Carrier};
use crate::{
    frame::{LocalFrame, Reference, is_linear},
    neighbours::point,
};

/// Rows and wanted frames in the local frames of one core.
pub(super) struct Frames {
    /// Local frames of the rows.
    pub rows: Vec<LocalFrame>,
    /// Local frames of the wanted frames.
    pub wanted: Vec<LocalFrame>,
    /// The target in the rows, less its mean.
    pub target: Vec<[f64; 3]>,
    pub mean: [f64; 3],
    pub core: Core,
}

impl Frames {
    pub fn new(sample: &Sample<'_>, carrier: Carrier) -> Self {
        let core = Core::choose(sample, carrier);
        let take = sample.take;
        let middle = core.pose(take, sample.rows[sample.reference]);
        let reference = Reference::weighted(&middle, &core.weights);
        let frames = |of: &[usize]| {
            of.iter().map(|&t| reference.frame(&core.pose(take, t))).collect::<Vec<_>>()
        };
        let (rows, wanted) = (frames(sample.rows), frames(sample.wanted));
        let places: Vec<[f64; 3]> = sample
            .rows
            .iter()
            .zip(&rows)
            .map(|(&t, frame)| frame.to_local(point(take, t, sample.target)))
            .collect();
        let n = places.len() as f64;
        let first = places[sample.reference];
        let shift: [f64; 3] =
            std::array::from_fn(|a| places.iter().map(|p| p[a] - first[a]).sum::<f64>() / n);
        let target =
            places.iter().map(|p| std::array::from_fn(|a| p[a] - first[a] - shift[a])).collect();
        Self { rows, wanted, target, mean: std::array::from_fn(|a| first[a] + shift[a]), core }
    }
}

/// The markers that carry a local frame.
pub(super) struct Core {
    pub markers: Vec<usize>,
    /// Of sum 1.
    pub weights: Vec<f64>,
}

impl Core {
    /// The first neighbours, or more while they lie on a line and there are more.
    pub fn choose(sample: &Sample<'_>, carrier: Carrier) -> Self {
        let all = sample.neighbours.len();
        let t = sample.rows[sample.reference];
        let bent = |n: &usize| {
            let pose: Vec<_> =
                sample.neighbours[..*n].iter().map(|&(m, _)| point(sample.take, t, m)).collect();
            !is_linear(&pose)
        };
        let count = carrier.core.min(all);
        let core = &sample.neighbours[..(count..=all).find(bent).unwrap_or(count)];
        let weigh = |(_, spread): &(usize, f64)| (spread + 2e-3).powf(-carrier.steadiness);
        let sum: f64 = core.iter().map(weigh).sum();
        Self {
            markers: core.iter().map(|&(m, _)| m).collect(),
            weights: core.iter().map(|neighbour| weigh(neighbour) / sum).collect(),
        }
    }

    pub fn pose(&self, take: &Take, t: usize) -> Vec<[f64; 3]> {
        self.markers.iter().map(|&m| point(take, t, m)).collect()
    }

    fn centre(&self, take: &Take, t: usize) -> Option<[f64; 3]> {
        let mut parts = self.markers.iter().zip(&self.weights);
        parts.try_fold([0.0; 3], |sum, (&m, &w)| Some(add(sum, scale(w, take.position(t, m)?))))
    }

    /// Second difference of the centre over a stride, in metres; nought where the core is not seen before and after.
    pub fn push(&self, take: &Take, t: usize, stride: usize) -> [f64; 3] {
        let after = (t + stride < take.frames()).then_some(t + stride);
        let ends = t.checked_sub(stride).zip(after);
        let centres = ends.and_then(|(a, b)| self.centre(take, a).zip(self.centre(take, b)));
        let here = self.centre(take, t);
        let bend = |((a, b), here)| add(sub(a, here), sub(b, here));
        centres.zip(here).map_or([0.0; 3], bend)
    }
}
