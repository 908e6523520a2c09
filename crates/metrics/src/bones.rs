use mocap_core::{Bone, BoneSet, Mask, Take};

use crate::{MM_PER_M, MetricError, error::check_mask, stats::Moments};

/// How far marker distances are from the lengths of their bones: `| ‖x_i − x_j‖ − d |`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoneDeviation {
    /// Distances measured.
    pub samples: usize,
    /// Mean deviation in mm; NaN without samples.
    pub mean_mm: f64,
    /// Root mean square deviation in mm; NaN without samples.
    pub rms_mm: f64,
    /// Largest deviation in mm; NaN without samples.
    pub max_mm: f64,
}

/// Deviation from bone length over all bones together.
///
/// A distance counts where the take shows both ends and, if `cells` `(T, M)` is given, at least one
/// end is in it.
///
/// # Errors
/// [`MetricError::Core`] for a bone whose markers the take does not have, [`MetricError::Shape`] for
/// `cells` of another shape than the take.
pub fn bone_deviation(
    take: &Take,
    bones: &BoneSet,
    cells: Option<&Mask>,
) -> Result<BoneDeviation, MetricError> {
    check(take, bones, cells)?;
    let all = bones.bones().iter().flat_map(|bone| deviations(take, *bone, cells));
    Ok(BoneDeviation::of(all))
}

/// Deviation from bone length, bone by bone, in the order of the set.
///
/// # Errors
/// As [`bone_deviation`].
pub fn per_bone(
    take: &Take,
    bones: &BoneSet,
    cells: Option<&Mask>,
) -> Result<Vec<(Bone, BoneDeviation)>, MetricError> {
    check(take, bones, cells)?;
    let one = |bone: &Bone| (*bone, BoneDeviation::of(deviations(take, *bone, cells)));
    Ok(bones.bones().iter().map(one).collect())
}

impl BoneDeviation {
    fn of(deviations_m: impl Iterator<Item = f64>) -> Self {
        let Moments { count, mean, rms, max } = Moments::of(deviations_m);
        let [mean_mm, rms_mm, max_mm] = [mean, rms, max].map(|m| MM_PER_M * m);
        Self { samples: count, mean_mm, rms_mm, max_mm }
    }
}

fn check(take: &Take, bones: &BoneSet, cells: Option<&Mask>) -> Result<(), MetricError> {
    bones.check(take)?;
    cells.map_or(Ok(()), |mask| check_mask(take, "the cell mask", mask))
}

fn deviations<'a>(
    take: &'a Take,
    bone: Bone,
    cells: Option<&'a Mask>,
) -> impl Iterator<Item = f64> + 'a {
    let (a, b) = bone.markers();
    let counts =
        move |t: usize| cells.is_none_or(|mask| mask.contains(t, a) || mask.contains(t, b));
    (0..take.frames())
        .filter(move |&t| counts(t))
        .filter_map(move |t| take.distance(t, a, b))
        .map(move |d| (d - bone.length_m()).abs())
}
