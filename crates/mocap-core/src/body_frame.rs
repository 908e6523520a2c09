use ndarray::Array3;

use crate::{
    CoreError, MarkerKnowledge, RigidTransform, Rotation, Take,
    geometry::{add, norm, scale, sub},
};

/// The vertical axis of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UpAxis {
    /// Y points up, as in most animation software.
    Y,
    /// Z points up, as in most capture software.
    Z,
}

impl UpAxis {
    /// Guesses the axis: from the feet to the head where the marker set is known, else the axis
    /// along which the lowest marker of each frame moves least, which is the floor's.
    ///
    /// Answers `None` for a take without observed samples.
    #[must_use]
    pub fn guess(take: &Take, known: &MarkerKnowledge) -> Option<Self> {
        Self::from_posture(take, known).or_else(|| Self::from_floor(take))
    }

    fn from_posture(take: &Take, known: &MarkerKnowledge) -> Option<Self> {
        let (top, bottom) =
            (known.role("top", take.markers()), known.role("bottom", take.markers()));
        let mut upright = [0.0; 3];
        for t in 0..take.frames() {
            if let (Some(head), Some(feet)) = (mean(take, t, &top), mean(take, t, &bottom)) {
                upright = add(upright, sub(head, feet));
            }
        }
        (norm(upright) > 0.0)
            .then(|| if upright[1].abs() > upright[2].abs() { Self::Y } else { Self::Z })
    }

    fn from_floor(take: &Take) -> Option<Self> {
        let spread = |axis: usize| {
            let lowest = (0..take.frames()).filter_map(|t| {
                (0..take.marker_count())
                    .filter_map(|m| take.position(t, m).map(|p| p[axis]))
                    .min_by(f64::total_cmp)
            });
            let values: Vec<f64> = lowest.collect();
            let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
            (!values.is_empty()).then(|| values.iter().map(|v| (v - mean).powi(2)).sum::<f64>())
        };
        Some(if spread(1)? < spread(2)? { Self::Y } else { Self::Z })
    }

    /// Indices of the two horizontal axes and the vertical one; the three form a right-handed frame.
    fn axes(self) -> (usize, usize, usize) {
        match self {
            Self::Z => (0, 1, 2),
            Self::Y => (2, 0, 1),
        }
    }

    fn unit(self) -> [f64; 3] {
        let mut e = [0.0; 3];
        e[self.axes().2] = 1.0;
        e
    }
}

/// The markers that tell where the body stands and where it faces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BodyMarkers {
    /// On the back: their mean is the origin in the horizontal plane.
    pub back: Vec<usize>,
    /// On the front: the body faces from the back's mean to theirs.
    pub front: Vec<usize>,
}

impl BodyMarkers {
    /// The reference markers that a known marker set names, where a take has some of both.
    #[must_use]
    pub fn find(take: &Take, known: &MarkerKnowledge) -> Option<Self> {
        let back = known.role("back", take.markers());
        let front = known.role("front", take.markers());
        (!back.is_empty() && !front.is_empty()).then_some(Self { back, front })
    }
}

/// Per frame, the horizontal place and heading of the body: the body-local coordinates of [Li10] §4.
///
/// Frames that show all reference markers define the frame directly. Frames that show some are
/// fitted to the mean shape of the markers they show, and frames that show fewer than two are
/// interpolated at the pace of the frames beside them. Heights stay as they are.
///
/// Deviates from [Li10] §4 as its authors computed it: they used the complete motion, hidden
/// reference markers included.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyFrame {
    up: UpAxis,
    placements: Vec<Placement>,
    bridged: usize,
}

/// Place and heading in the horizontal plane.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Placement {
    /// Metres along the two horizontal axes.
    origin: [f64; 2],
    /// Radians from the first horizontal axis.
    heading: f64,
}

impl BodyFrame {
    /// Finds the body frame from what a take shows.
    ///
    /// # Errors
    /// [`CoreError::NoBodyFrame`] if no frame shows a back and a front marker together.
    pub fn estimate(take: &Take, markers: &BodyMarkers, up: UpAxis) -> Result<Self, CoreError> {
        let planar = Planar { take, up };
        let complete: Vec<Option<Placement>> =
            (0..take.frames()).map(|t| planar.complete(t, markers)).collect();
        // Where the reference markers are never all seen, the most complete pair of groups has to do.
        let direct = if complete.iter().any(Option::is_some) {
            complete
        } else {
            (0..take.frames()).map(|t| planar.partial(t, markers)).collect()
        };
        let shape = planar.mean_shape(&direct, markers);
        let placed: Vec<Option<Placement>> = direct
            .iter()
            .enumerate()
            .map(|(t, placement)| placement.or_else(|| planar.fit(t, &shape)))
            .collect();
        let placements = interpolate(&placed).ok_or(CoreError::NoBodyFrame)?;
        let bridged = placed.iter().filter(|placement| placement.is_none()).count();
        Ok(Self { up, placements, bridged })
    }

    /// Number of frames that show too little of the body to tell where it is, so that their
    /// coordinates are a guess.
    #[must_use]
    pub fn bridged(&self) -> usize {
        self.bridged
    }

    /// The transform from body-local to world coordinates of one frame.
    ///
    /// # Panics
    /// If `frame` is not below T.
    #[must_use]
    pub fn to_world(&self, frame: usize) -> RigidTransform {
        let Placement { origin, heading } = self.placements[frame];
        let (i, j, _) = self.up.axes();
        let mut translation = [0.0; 3];
        (translation[i], translation[j]) = (origin[0], origin[1]);
        RigidTransform { rotation: Rotation::about(self.up.unit(), heading), translation }
    }

    /// The take in body-local coordinates.
    ///
    /// # Errors
    /// [`CoreError::Shape`] if the take has another number of frames than the body frame.
    pub fn localise(&self, take: &Take) -> Result<Take, CoreError> {
        self.check(take.frames())?;
        let transforms = self.transforms();
        take.map_positions(|t, _, p| transforms[t].undo(p))
    }

    /// Moves positions `(T, M, 3)` from body-local to world coordinates, in place.
    ///
    /// # Errors
    /// [`CoreError::Shape`] if the array has another number of frames than the body frame.
    pub fn globalise(&self, positions: &mut Array3<f64>) -> Result<(), CoreError> {
        self.check(positions.dim().0)?;
        let transforms = self.transforms();
        for ((t, _), mut p) in ndarray::indices((positions.dim().0, positions.dim().1))
            .into_iter()
            .zip(positions.lanes_mut(ndarray::Axis(2)))
        {
            let world = transforms[t].apply(std::array::from_fn(|a| p[a]));
            p.iter_mut().zip(world).for_each(|(c, w)| *c = w);
        }
        Ok(())
    }

    fn transforms(&self) -> Vec<RigidTransform> {
        (0..self.placements.len()).map(|t| self.to_world(t)).collect()
    }

    fn check(&self, frames: usize) -> Result<(), CoreError> {
        crate::take::check_shape("body frame", &[frames], &[self.placements.len()])
    }
}

/// A take seen from above.
struct Planar<'a> {
    take: &'a Take,
    up: UpAxis,
}

impl Planar<'_> {
    fn point(&self, t: usize, m: usize) -> Option<[f64; 2]> {
        let (i, j, _) = self.up.axes();
        self.take.position(t, m).map(|p| [p[i], p[j]])
    }

    fn complete(&self, t: usize, markers: &BodyMarkers) -> Option<Placement> {
        let all = markers.back.iter().chain(&markers.front);
        all.clone().all(|&m| self.take.is_observed(t, m)).then(|| self.partial(t, markers))?
    }

    /// Place and heading from whichever of the reference markers are seen.
    fn partial(&self, t: usize, markers: &BodyMarkers) -> Option<Placement> {
        let centre = |group: &[usize]| mean_2d(group.iter().filter_map(|&m| self.point(t, m)));
        let (back, front) = (centre(&markers.back)?, centre(&markers.front)?);
        let forward = [front[0] - back[0], front[1] - back[1]];
        (forward[0].hypot(forward[1]) > 0.0)
            .then(|| Placement { origin: back, heading: forward[1].atan2(forward[0]) })
    }

    /// Mean body-local place of each reference marker over the frames that are placed.
    fn mean_shape(
        &self,
        placed: &[Option<Placement>],
        markers: &BodyMarkers,
    ) -> Vec<(usize, [f64; 2])> {
        let locals = |m: usize| {
            placed.iter().enumerate().filter_map(move |(t, placement)| {
                Some(placement.as_ref()?.localise(self.point(t, m)?))
            })
        };
        let all = markers.back.iter().chain(&markers.front);
        all.filter_map(|&m| Some((m, mean_2d(locals(m))?))).collect()
    }

    /// The placement that best moves the mean shape onto the reference markers that are seen.
    fn fit(&self, t: usize, shape: &[(usize, [f64; 2])]) -> Option<Placement> {
        let pairs: Vec<([f64; 2], [f64; 2])> =
            shape.iter().filter_map(|&(m, local)| Some((local, self.point(t, m)?))).collect();
        if pairs.len() < 2 {
            return None;
        }
        let from = mean_2d(pairs.iter().map(|p| p.0))?;
        let to = mean_2d(pairs.iter().map(|p| p.1))?;
        let (mut cos, mut sin) = (0.0, 0.0);
        for (local, world) in &pairs {
            let (x, y) = (local[0] - from[0], local[1] - from[1]);
            let (u, v) = (world[0] - to[0], world[1] - to[1]);
            cos += x * u + y * v;
            sin += x * v - y * u;
        }
        let heading = sin.atan2(cos);
        let (s, c) = heading.sin_cos();
        let origin = [to[0] - c * from[0] + s * from[1], to[1] - s * from[0] - c * from[1]];
        Some(Placement { origin, heading })
    }
}

impl Placement {
    fn localise(&self, world: [f64; 2]) -> [f64; 2] {
        let (x, y) = (world[0] - self.origin[0], world[1] - self.origin[1]);
        let (s, c) = self.heading.sin_cos();
        [c * x + s * y, c * y - s * x]
    }
}

/// Frames beside a gap whose mean move is the pace at which the body enters or leaves it.
const PACE: usize = 2;

impl Placement {
    fn values(self) -> [f64; 3] {
        [self.origin[0], self.origin[1], self.heading]
    }
}

/// Fills frames without a placement by cubics that keep place, heading and pace at both ends, the
/// heading along the shorter way round. Before the first and after the last placement the body stands.
///
/// Source: Hermite interpolation; a body that is lost for a moment keeps going as it went.
fn interpolate(placed: &[Option<Placement>]) -> Option<Vec<Placement>> {
    let known: Vec<(usize, Placement)> =
        placed.iter().enumerate().filter_map(|(t, p)| p.map(|p| (t, p))).collect();
    let first = known.first()?.1;
    let between = |t: usize| {
        let after = known.partition_point(|(k, _)| *k <= t);
        match (after.checked_sub(1), known.get(after)) {
            (Some(before), None) => known[before].1,
            (None, _) => first,
            (Some(before), Some(_)) if known[before].0 == t => known[before].1,
            (Some(before), Some(_)) => across(&known, before, t),
        }
    };
    Some((0..placed.len()).map(between).collect())
}

/// The placement of a frame between the known ones `before` and `before + 1`.
fn across(known: &[(usize, Placement)], before: usize, t: usize) -> Placement {
    let ((s, p), (e, q)) = (known[before], known[before + 1]);
    let (length, share) = ((e - s) as f64, (t - s) as f64 / (e - s) as f64);
    let from = p.values();
    let to: [f64; 3] = std::array::from_fn(|a| from[a] + difference(p, q)[a]);
    let entry = pace(known[..=before].iter().rev());
    let exit = pace(known[before + 1..].iter());
    // The entry pace is measured backwards in time.
    let values: [f64; 3] = std::array::from_fn(|a| {
        cubic([from[a], to[a]], [-entry[a] * length, exit[a] * length], share)
    });
    Placement { origin: [values[0], values[1]], heading: values[2] }
}

/// Mean move per frame from the first of consecutive known frames away over the next few; zero for
/// a frame that stands alone.
fn pace<'a>(mut known: impl Iterator<Item = &'a (usize, Placement)>) -> [f64; 3] {
    let Some(&(border, start)) = known.next() else { return [0.0; 3] };
    let mut sum = [0.0; 3];
    let (mut frames, mut last) = (0, (border, start));
    for &(t, placement) in known.take(PACE) {
        if t.abs_diff(last.0) != 1 {
            break;
        }
        let step = difference(last.1, placement);
        (0..3).for_each(|a| sum[a] += step[a]);
        (frames, last) = (frames + 1, (t, placement));
    }
    sum.map(|s| s / f64::from(frames.max(1)))
}

/// The move from one placement to another, the heading along the shorter way round.
fn difference(p: Placement, q: Placement) -> [f64; 3] {
    use std::f64::consts::{PI, TAU};
    let turn = (q.heading - p.heading + PI).rem_euclid(TAU) - PI;
    [q.origin[0] - p.origin[0], q.origin[1] - p.origin[1], turn]
}

/// The cubic with these values and slopes at 0 and 1.
fn cubic([p, q]: [f64; 2], [u, v]: [f64; 2], x: f64) -> f64 {
    let (x2, x3) = (x * x, x * x * x);
    p * (2.0 * x3 - 3.0 * x2 + 1.0)
        + u * (x3 - 2.0 * x2 + x)
        + q * (3.0 * x2 - 2.0 * x3)
        + v * (x3 - x2)
}

fn mean(take: &Take, t: usize, markers: &[usize]) -> Option<[f64; 3]> {
    let seen: Vec<[f64; 3]> = markers.iter().filter_map(|&m| take.position(t, m)).collect();
    let sum = seen.iter().fold([0.0; 3], |s, &p| add(s, p));
    (!seen.is_empty()).then(|| scale(1.0 / seen.len() as f64, sum))
}

fn mean_2d(points: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    let (n, sum) =
        points.fold((0_usize, [0.0; 2]), |(n, s), p| (n + 1, [s[0] + p[0], s[1] + p[1]]));
    (n > 0).then(|| sum.map(|c| c / n as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_right_handed() {
        for up in [UpAxis::Y, UpAxis::Z] {
            let (i, j, k) = up.axes();
            let mut e = [[0.0; 3]; 3];
            (e[0][i], e[1][j], e[2][k]) = (1.0, 1.0, 1.0);
            assert!(
                (crate::geometry::dot(crate::geometry::cross(e[0], e[1]), e[2]) - 1.0).abs()
                    < 1e-15
            );
        }
    }
}
