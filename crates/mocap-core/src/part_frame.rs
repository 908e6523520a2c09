use ndarray::Array3;

use crate::{
    CoreError, MarkerSet, RigidTransform, Rotation, Take,
    geometry::{add, best_rotation, cross, distance, scale, sub, symmetric_eigen},
};

/// Left or right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// Left.
    Left,
    /// Right.
    Right,
}

/// The axis of a part-local frame that pairs of markers point along, beside the one that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PairAxis {
    /// X, to the left of the part.
    X,
    /// Z, ahead of the part.
    Z,
}

/// The markers that say where a part of the body is and how it is turned.
///
/// The origin is the mean of all of them; y goes from the mean of the `low` ones to the mean of the `high` ones; the
/// mean of the pairs' directions, square to y, is the second axis, and the third follows by the right hand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartMarkers {
    low: Vec<usize>,
    high: Vec<usize>,
    pairs: Vec<(usize, usize)>,
    axis: PairAxis,
}

/// How a frame of the take came by its part-local coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Alignment {
    /// All reference markers were seen: axes and origin come from them directly.
    Direct,
    /// At least three were seen, not on one line: fitted to the subject's own mean shape.
    Fitted,
    /// Too few were seen. The coordinates are interpolated between the frames beside, and only good for
    /// keeping arrays whole: mask them.
    Lost,
}

/// A frame that moves with a part of the body, such as the waist or a wrist, in every frame of a take.
///
/// Made for methods that look at one part at a time, as the networks of [Pan23] do: in these coordinates a
/// pose looks the same wherever the body stands and faces. [`BodyFrame`](crate::BodyFrame) keeps heights
/// and only follows place and heading; this one follows every turn of its part.
///
/// Where reference markers are missing, frames are fitted to the mean shape over the complete frames, in which
/// a marker counts the more the stiller it sits. The coordinates of a take and back are exact to rounding, whatever
/// the alignment.
#[derive(Debug, Clone, PartialEq)]
pub struct PartFrame {
    to_world: Vec<RigidTransform>,
    alignment: Vec<Alignment>,
}

/// The variance that even the stillest marker is taken to have, in m²: soft tissue under a marker moves by
/// some millimetres.
const LEAST_VARIANCE_M2: f64 = 2.5e-5;
/// Points whose second spread is below this share of the first lie on a line.
const LINE: f64 = 0.05;

impl PartMarkers {
    /// Markers by their indices: those low and those high on the part, and pairs along the other axis.
    ///
    /// # Errors
    /// [`CoreError::NoPartMarkers`] if a list is empty, so that an axis is undefined.
    pub fn new(
        low: Vec<usize>,
        high: Vec<usize>,
        pairs: Vec<(usize, usize)>,
        axis: PairAxis,
    ) -> Result<Self, CoreError> {
        if low.is_empty() || high.is_empty() || pairs.is_empty() {
            return Err(CoreError::NoPartMarkers);
        }
        Ok(Self { low, high, pairs, axis })
    }

    /// The waist with breastbone and tenth vertebra: x to the left, y up, z ahead. It knows the names of the 53- and
    /// 57-marker layouts of [Pan23] and of the CMU set; `None` for takes that wear neither.
    #[must_use]
    pub fn waist(markers: &MarkerSet) -> Option<Self> {
        /// Markers of a waist, and its pairs from back to front.
        type Waist = (&'static [&'static str], &'static [(&'static str, &'static str)]);
        const WAISTS: [Waist; 3] = [
            (
                &["LFWT", "MFWT", "RFWT", "LBWT", "MBWT", "RBWT"],
                &[("RBWT", "RFWT"), ("MBWT", "MFWT"), ("LBWT", "LFWT")],
            ),
            (
                &["LFWT", "LMWT", "LBWT", "RFWT", "RMWT", "RBWT"],
                &[("LBWT", "LFWT"), ("RBWT", "RFWT")],
            ),
            (&["LFWT", "RFWT", "LBWT", "RBWT"], &[("LBWT", "LFWT"), ("RBWT", "RFWT")]),
        ];
        let find = |name: &&str| markers.find(name).ok();
        let high = ["STRN", "T10"].iter().map(find).collect::<Option<Vec<usize>>>()?;
        WAISTS.iter().find_map(|(low, pairs)| {
            let low = low.iter().map(find).collect::<Option<Vec<usize>>>()?;
            let ahead = |(back, front): &(&str, &str)| Some((find(back)?, find(front)?));
            let mut along = vec![(high[1], high[0])];
            along.extend(pairs.iter().map(ahead).collect::<Option<Vec<_>>>()?);
            Some(Self { low, high: high.clone(), pairs: along, axis: PairAxis::Z })
        })
    }

    /// A wrist and the back of its hand: y toward the fingers, x toward the thumb, z as the right hand has it, which is
    /// dorsal on one side and palmar on the other. `None` for takes without these markers.
    #[must_use]
    pub fn wrist(markers: &MarkerSet, side: Side) -> Option<Self> {
        let letter = match side {
            Side::Left => 'L',
            Side::Right => 'R',
        };
        let find = |stem: &str| markers.find(&format!("{letter}{stem}")).ok();
        let [inner, outer] = [find("IWR")?, find("OWR")?];
        let [inner_hand, outer_hand] = [find("IHAND")?, find("OHAND")?];
        Some(Self {
            low: vec![inner, outer],
            high: vec![inner_hand, outer_hand],
            pairs: vec![(outer, inner), (outer_hand, inner_hand)],
            axis: PairAxis::X,
        })
    }

    /// All reference markers, each once.
    #[must_use]
    pub fn all(&self) -> Vec<usize> {
        let ends = self.pairs.iter().flat_map(|&(from, to)| [from, to]);
        let mut all: Vec<usize> = self.low.iter().chain(&self.high).copied().chain(ends).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Axes and origin where all markers are seen and span a frame.
    ///
    /// Implements the local coordinates of [Pan23] §3.1, as its authors' code has them.
    /// Deviates from that code: the axes are written down at once, where two successive rotations have attitudes in which
    /// they are undefined.
    fn direct(&self, take: &Take, frame: usize) -> Option<RigidTransform> {
        let at = |marker: usize| take.position(frame, marker);
        let mean = |markers: &[usize]| {
            let mut sum = [0.0; 3];
            for &marker in markers {
                sum = add(sum, at(marker)?);
            }
            Some(scale(1.0 / markers.len() as f64, sum))
        };
        let origin = mean(&self.all())?;
        let up = sub(mean(&self.high)?, mean(&self.low)?);
        let mut along = [0.0; 3];
        for &(from, to) in &self.pairs {
            along = add(along, sub(at(to)?, at(from)?));
        }
        let rotation = match self.axis {
            // from_six makes x of its first and y of its second direction; here y is the exact one.
            PairAxis::X => basis(up, along, |y, x| [x, y, cross(x, y)]),
            PairAxis::Z => basis(up, along, |y, z| [cross(y, z), y, z]),
        }?;
        Some(RigidTransform { rotation, translation: origin })
    }
}

/// The rotation with columns made of the unit vector `first` and the part of `second` square to it.
fn basis(
    first: [f64; 3],
    second: [f64; 3],
    columns: impl Fn([f64; 3], [f64; 3]) -> [[f64; 3]; 3],
) -> Option<Rotation> {
    let [a, b] = Rotation::from_six(first, second)?.six();
    let c = columns(a, b);
    Rotation::from_matrix(&std::array::from_fn(|row| c.map(|column| column[row])))
}

impl PartFrame {
    /// Finds the part in every frame of a take.
    ///
    /// # Errors
    /// [`CoreError::NoPartFrame`] if no frame shows all reference markers of the part, spanning a frame.
    pub fn estimate(take: &Take, markers: &PartMarkers) -> Result<Self, CoreError> {
        let direct: Vec<Option<RigidTransform>> =
            (0..take.frames()).map(|t| markers.direct(take, t)).collect();
        let shape = mean_shape(take, markers, &direct).ok_or(CoreError::NoPartFrame)?;
        let placed: Vec<(Option<RigidTransform>, Alignment)> = direct
            .into_iter()
            .enumerate()
            .map(|(t, direct)| match direct.or_else(|| fit(take, t, &shape)) {
                Some(transform) if direct.is_some() => (Some(transform), Alignment::Direct),
                Some(transform) => (Some(transform), Alignment::Fitted),
                None => (None, Alignment::Lost),
            })
            .collect();
        let alignment = placed.iter().map(|p| p.1).collect();
        let known: Vec<(usize, RigidTransform)> =
            placed.iter().enumerate().filter_map(|(t, p)| Some((t, p.0?))).collect();
        let to_world = (0..take.frames())
            .map(|t| between(&known, t).ok_or(CoreError::NoPartFrame))
            .collect::<Result<_, _>>()?;
        Ok(Self { to_world, alignment })
    }

    /// How each frame was aligned, `(T,)`.
    #[must_use]
    pub fn alignment(&self) -> &[Alignment] {
        &self.alignment
    }

    /// The transform from part-local to world coordinates of one frame.
    ///
    /// # Panics
    /// If `frame` is not below T.
    #[must_use]
    pub fn to_world(&self, frame: usize) -> RigidTransform {
        self.to_world[frame]
    }

    /// The take in part-local coordinates.
    ///
    /// # Errors
    /// [`CoreError::Shape`] if the take has another number of frames.
    pub fn localise(&self, take: &Take) -> Result<Take, CoreError> {
        self.check(take.frames())?;
        take.map_positions(|t, _, p| self.to_world[t].undo(p))
    }

    /// Moves positions `(T, M, 3)` from part-local to world coordinates, in place.
    ///
    /// # Errors
    /// [`CoreError::Shape`] if the array has another number of frames.
    pub fn globalise(&self, positions: &mut Array3<f64>) -> Result<(), CoreError> {
        self.check(positions.dim().0)?;
        for (transform, mut frame) in self.to_world.iter().zip(positions.outer_iter_mut()) {
            for mut p in frame.outer_iter_mut() {
                let world = transform.apply(std::array::from_fn(|a| p[a]));
                p.iter_mut().zip(world).for_each(|(c, w)| *c = w);
            }
        }
        Ok(())
    }

    fn check(&self, frames: usize) -> Result<(), CoreError> {
        crate::take::check_shape("part frame", &[frames], &[self.to_world.len()])
    }
}

/// A reference marker in the mean shape: its mean local place, and how much it counts.
struct Anchor {
    marker: usize,
    place: [f64; 3],
    weight: f64,
}

/// Mean and scatter of each reference marker over the complete frames.
fn mean_shape(
    take: &Take,
    markers: &PartMarkers,
    direct: &[Option<RigidTransform>],
) -> Option<Vec<Anchor>> {
    let local = |marker: usize| {
        direct.iter().enumerate().filter_map(move |(t, transform)| {
            Some(transform.as_ref()?.undo(take.position(t, marker)?))
        })
    };
    let complete = direct.iter().flatten().count() as f64;
    let anchor = |marker: usize| {
        let place = scale(1.0 / complete, local(marker).fold([0.0; 3], add));
        let variance = local(marker).map(|p| distance(p, place).powi(2)).sum::<f64>() / complete;
        Anchor { marker, place, weight: 1.0 / (variance + LEAST_VARIANCE_M2) }
    };
    (complete > 0.0).then(|| markers.all().into_iter().map(anchor).collect())
}

/// The rigid transform that takes the mean shape to the markers seen, each by its weight.
///
/// Implements [Kabsch76] by the quaternion of [Horn87] Sec. 4, which is never a reflection.
fn fit(take: &Take, frame: usize, shape: &[Anchor]) -> Option<RigidTransform> {
    let seen: Vec<(&Anchor, [f64; 3])> = shape
        .iter()
        .filter_map(|anchor| Some((anchor, take.position(frame, anchor.marker)?)))
        .collect();
    if seen.len() < 3 {
        return None;
    }
    let total: f64 = seen.iter().map(|(anchor, _)| anchor.weight).sum();
    let (mut from, mut to) = ([0.0; 3], [0.0; 3]);
    for (anchor, place) in &seen {
        let share = anchor.weight / total;
        from = add(from, scale(share, anchor.place));
        to = add(to, scale(share, *place));
    }
    let mut sums = [[0.0; 3]; 3];
    let mut spread = [[0.0; 3]; 3];
    for (anchor, place) in &seen {
        let (p, q) = (sub(anchor.place, from), sub(*place, to));
        for a in 0..3 {
            for b in 0..3 {
                sums[a][b] += anchor.weight * p[a] * q[b];
                spread[a][b] += anchor.weight * p[a] * p[b];
            }
        }
    }
    // Points on a line leave the turn about it open.
    let mut spreads = symmetric_eigen(spread).0;
    spreads.sort_by(|a, b| b.total_cmp(a));
    if spreads[1].max(0.0).sqrt() < LINE * spreads[0].max(0.0).sqrt() {
        return None;
    }
    let rotation = best_rotation(&sums);
    Some(RigidTransform { rotation, translation: sub(to, rotation.apply(from)) })
}

/// The transform of a frame from the known ones: a share of the way between the two beside it, or the nearest at
/// the ends.
fn between(known: &[(usize, RigidTransform)], t: usize) -> Option<RigidTransform> {
    let after = known.partition_point(|(k, _)| *k <= t);
    match (after.checked_sub(1).map(|i| known[i]), known.get(after)) {
        (Some((s, p)), Some((e, q))) if s != t => {
            let share = (t - s) as f64 / (e - s) as f64;
            let step = sub(q.translation, p.translation);
            Some(RigidTransform {
                rotation: p.rotation.toward(q.rotation, share),
                translation: add(p.translation, scale(share, step)),
            })
        }
        (Some((_, p)), _) => Some(p),
        (None, next) => next.map(|n| n.1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{dot, norm};

    #[test]
    fn a_basis_is_right_handed_and_keeps_its_first_axis() {
        let (up, ahead) = ([0.1, 2.0, -0.3], [0.4, 0.2, 1.0]);
        let turn = basis(up, ahead, |y, z| [cross(y, z), y, z]).unwrap();
        let y = turn.apply([0.0, 1.0, 0.0]);
        assert!(distance(y, scale(1.0 / norm(up), up)) < 1e-15);
        assert!(dot(turn.apply([0.0, 0.0, 1.0]), ahead) > 0.0);
    }
}
