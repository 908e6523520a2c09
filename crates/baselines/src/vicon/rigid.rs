use std::ops::ControlFlow;

use mocap_core::{
    FillError, Filled, Gap, GapFiller, IterReport, Refusal, RigidTransform, Take,
    geometry::{add, best_rotation, cross, norm, scale, sub},
};

use super::{Curve, borders, fill, steadiest};

/// The rigid-body fill of Vicon Nexus: the gap moves with three donors as if all four were one body.
///
/// The donors are the three markers at the steadiest distances that do not stand on a line. Their rigid
/// motion from the frame before the gap, and the one from the frame after it, each carry the marker into the gap;
/// the two answers are blended linearly. A gap at the start or the end of the take has one of
/// them. If a donor is missing anywhere from border to border, the gap stays open with
/// [`Refusal::DonorMissing`].
///
/// Implements the rigid-body fill of [Nexus]. Deviates from [Nexus]: there the user names the donors, and its pages
/// do not tell how two reference frames are joined.
///
/// # When not to use
/// Where donors sit on another body part than the marker.
///
/// # Cost
/// Linear in frames times markers for each marker that has gaps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct RigidBodyFill;

impl GapFiller for RigidBodyFill {
    fn name(&self) -> &'static str {
        "vicon-rigid"
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let rule =
            |gap: &Gap, donors: &Option<_>| carry(take, gap, donors.ok_or(Refusal::NoNeighbour)?);
        fill(take, self.name(), |marker| donors(take, marker), rule)
    }
}

/// The steadiest three that span a plane in the first frame that shows them.
fn donors(take: &Take, marker: usize) -> Option<[usize; 3]> {
    let ranked = steadiest(take, marker);
    let (&a, &b) = (ranked.first()?, ranked.get(1)?);
    ranked[2..].iter().map(|&c| [a, b, c]).find(|&donors| {
        let pose = (0..take.frames()).find_map(|t| pose(take, t, donors));
        pose.is_some_and(|pose| !on_a_line(pose))
    })
}

fn pose(take: &Take, t: usize, donors: [usize; 3]) -> Option<[[f64; 3]; 3]> {
    let [a, b, c] = donors.map(|m| take.position(t, m));
    Some([a?, b?, c?])
}

/// Whether the third point lies within a twentieth of the longest side from the line through the others.
fn on_a_line([a, b, c]: [[f64; 3]; 3]) -> bool {
    let sides = [sub(b, a), sub(c, b), sub(a, c)].map(norm);
    let longest = sides.into_iter().fold(0.0, f64::max);
    norm(cross(sub(b, a), sub(c, a))) <= 0.05 * longest * longest
}

fn carry(take: &Take, gap: &Gap, donors: [usize; 3]) -> Curve {
    let (before, after) = borders(take, gap);
    let first = before.unwrap_or(gap.frames.start);
    let last = after.unwrap_or(gap.frames.end - 1);
    let missing = donors.iter().find(|&&m| (first..=last).any(|t| !take.is_observed(t, m)));
    if let Some(&donor) = missing {
        return Err(Refusal::DonorMissing { donor });
    }
    let reference = |t: Option<usize>| {
        let t = t?;
        Some((take.position(t, gap.marker)?, pose(take, t, donors)?))
    };
    let (from, to) = (reference(before), reference(after));
    let place = |t: usize| {
        let here = pose(take, t, donors)?;
        let carried = |(p, pose): ([f64; 3], [[f64; 3]; 3])| motion(pose, here).apply(p);
        Some(match (from.map(carried), to.map(carried)) {
            (Some(p), Some(q)) => {
                let share = (t + 1 - gap.frames.start) as f64 / (gap.len() + 1) as f64;
                add(scale(1.0 - share, p), scale(share, q))
            }
            (p, q) => p.or(q)?,
        })
    };
    gap.frames.clone().map(place).collect::<Option<_>>().ok_or(Refusal::NoNeighbour)
}

/// The rigid motion that takes one pose of three points closest to another.
fn motion(from: [[f64; 3]; 3], to: [[f64; 3]; 3]) -> RigidTransform {
    let mean = |p: [[f64; 3]; 3]| scale(1.0 / 3.0, add(add(p[0], p[1]), p[2]));
    let (centre, target) = (mean(from), mean(to));
    let mut sums = [[0.0; 3]; 3];
    for (p, q) in from.into_iter().zip(to) {
        let (p, q) = (sub(p, centre), sub(q, target));
        for (row, a) in sums.iter_mut().zip(p) {
            row.iter_mut().zip(q).for_each(|(sum, b)| *sum += a * b);
        }
    }
    let rotation = best_rotation(&sums);
    RigidTransform { rotation, translation: sub(target, rotation.apply(centre)) }
}
