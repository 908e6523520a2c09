//! What a regression sees of a frame: groups of features, each as large as its view wants it.

use std::ops::Range;

use mocap_core::Take;

use super::{frames::Core, tile::Panel, variant::View};
use crate::{frame::LocalFrame, neighbours::point};

/// Features that vary by less than a nanometre are constant up to rounding, in m².
const FLOOR_M2: f64 = 1e-18;

/// Accelerations are taken over twice this: longer than a jitter of the markers, shorter than a step.
const STRIDE_S: f64 = 0.04;

/// Features that are made to vary as much as one another, times their size.
pub(super) struct Group {
    pub what: What,
    pub columns: Range<usize>,
    /// How much each column counts in the group.
    relevance: Vec<f64>,
    /// Root mean square length over the rows.
    size: f64,
}

/// Three columns of features and again three.
pub(super) enum What {
    /// Each regressor in the local frame.
    Pose,
    /// The acceleration of the local frame, seen from it.
    Acceleration,
    /// The axes of the world, seen from the local frame: turned with the take, all their inner products stay.
    Attitude,
}

/// Those of a view, in order of their columns.
pub(super) fn groups(regressors: &[(usize, f64)], view: View) -> Vec<Group> {
    let by_spread = |(_, spread): &(usize, f64)| [(spread + 3e-3).powf(-view.relevance); 3];
    let all = [
        (What::Pose, regressors.iter().flat_map(by_spread).collect(), 1.0),
        (What::Acceleration, vec![1.0; 3], view.forces.acceleration),
        (What::Attitude, vec![1.0; 9], view.forces.attitude),
    ];
    let mut end = 0;
    let mut group = |(what, relevance, size): (What, Vec<f64>, f64)| {
        let columns = end..end + relevance.len();
        end = columns.end;
        Group { what, columns, relevance, size }
    };
    all.into_iter().filter(|(_, _, size)| *size > 0.0).map(&mut group).collect()
}

impl What {
    pub fn write<'c>(
        &self,
        cells: impl Iterator<Item = &'c mut [f64]>,
        take: &Take,
        regressors: &[(usize, f64)],
        core: &Core,
        t: usize,
        frame: LocalFrame,
    ) {
        let stride = stride(take.rate_hz());
        for (k, cells) in cells.enumerate() {
            cells.copy_from_slice(&match self {
                Self::Pose => frame.to_local(point(take, t, regressors[k].0)),
                Self::Acceleration => frame.turn_in(core.push(take, t, stride)),
                Self::Attitude => frame.turn_in(std::array::from_fn(|a| f64::from(a == k))),
            });
        }
    }
}

impl Group {
    /// Centres the features on the mean of the rows `x`, weighs columns by their relevance, and gives the rows their mean
    /// square length; does the same to `z`.
    pub fn standardise(&self, x: &mut Panel, z: &mut Panel, reference: usize) {
        let n = x.rows() as f64;
        let columns = || self.columns.clone();
        // Around one of them, so that no digits are lost where they hardly vary.
        let origin = x.row(reference)[columns()].to_vec();
        let mut mean = vec![0.0; origin.len()];
        for i in 0..x.rows() {
            for ((sum, c), o) in mean.iter_mut().zip(&x.row(i)[columns()]).zip(&origin) {
                *sum += (c - o) / n;
            }
        }
        let centre = |row: &mut [f64]| {
            let by = origin.iter().zip(&mean).zip(&self.relevance);
            for (c, ((o, mean), relevance)) in row.iter_mut().zip(by) {
                *c = (*c - o - mean) * relevance;
            }
        };
        (0..x.rows()).for_each(|i| centre(&mut x.row_mut(i)[columns()]));
        (0..z.rows()).for_each(|i| centre(&mut z.row_mut(i)[columns()]));
        let square: f64 =
            (0..x.rows()).flat_map(|i| &x.row(i)[columns()]).map(|c| c * c).sum::<f64>() / n;
        let floor: f64 = self.relevance.iter().map(|r| FLOOR_M2 * r * r).sum();
        let unit = self.size / square.max(floor).sqrt();
        for panel in [x, z] {
            for i in 0..panel.rows() {
                panel.row_mut(i)[columns()].iter_mut().for_each(|c| *c *= unit);
            }
        }
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a fraction of a second
fn stride(rate_hz: f64) -> usize {
    (STRIDE_S * rate_hz).round().max(1.0) as usize
}
