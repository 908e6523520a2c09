//! Holdouts of benchmark protocols.

use std::{
    collections::BTreeMap,
    ops::{Range, RangeInclusive},
};

use mocap_core::{Holdout, MarkerSet, Mask, Take};

use crate::{
    AugmentError,
    dice::{Dice, Stream},
    error::{check, check_cells},
};

/// An arm or a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Limb {
    /// Upper arm to fingers.
    LeftArm,
    /// Upper arm to fingers.
    RightArm,
    /// Thigh to toes.
    LeftLeg,
    /// Thigh to toes.
    RightLeg,
}

/// Marker names without the letter of the side.
const ARM: &[&str] = &[
    "UPA", "ELB", "IEL", "BEL", "FRM", "FRA", "WRA", "WRB", "IWR", "OWR", "FIN", "IHAND", "OHAND",
    "THMB", "THM3", "THM6", "IDX3", "IDX6", "MID0", "MID6", "RNG3", "RNG6", "PNK3", "PNK6",
];
const LEG: &[&str] =
    &["THI", "KNE", "KNI", "KNU", "SHN", "TIB", "ANK", "HEE", "HEL", "MT1", "MT5", "TOE"];

impl Limb {
    /// Every limb.
    pub const ALL: [Self; 4] = [Self::LeftArm, Self::RightArm, Self::LeftLeg, Self::RightLeg];

    /// Name in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::LeftArm => "left arm",
            Self::RightArm => "right arm",
            Self::LeftLeg => "left leg",
            Self::RightLeg => "right leg",
        }
    }

    /// The markers known to lie on the limb, of the subject that has most of them; of
    /// equals, of the first by name.
    ///
    /// It knows the names of the CMU database, of Vicon's Plug-in Gait, and those of [`Preset`](crate::Preset).
    /// Shoulder and waist markers belong to the trunk.
    #[must_use]
    pub fn markers(self, set: &MarkerSet) -> Vec<usize> {
        let (side, stems) = match self {
            Self::LeftArm => ("L", ARM),
            Self::RightArm => ("R", ARM),
            Self::LeftLeg => ("L", LEG),
            Self::RightLeg => ("R", LEG),
        };
        let mut subjects = BTreeMap::<&str, Vec<usize>>::new();
        for m in 0..set.len() {
            let (subject, name) = set.split(m);
            if name.strip_prefix(side).is_some_and(|stem| stems.contains(&stem)) {
                subjects.entry(subject).or_default().push(m);
            }
        }
        // The first of equals, where `max_by_key` would give the last.
        subjects.into_values().rev().max_by_key(Vec::len).unwrap_or_default()
    }
}

/// Hides markers in a run of frames, zero-based with its end exclusive.
///
/// # Errors
/// [`AugmentError::Segment`], [`AugmentError::NothingToHide`], and [`AugmentError::Core`] for a marker that is
/// not there.
pub fn hide_segment(
    take: &Take,
    markers: &[usize],
    frames: Range<usize>,
) -> Result<Holdout, AugmentError> {
    check_cells(take.frames(), take.marker_count())?;
    check_segment(&frames, take.frames())?;
    let mut hidden = Mask::none(take.frames(), take.marker_count());
    for &m in markers {
        for t in frames.clone() {
            hidden.insert(t, m)?;
        }
    }
    let holdout = Holdout::new(take.clone(), &hidden)?;
    if holdout.hidden().count() == 0 {
        return Err(AugmentError::NothingToHide { start: frames.start, end: frames.end });
    }
    Ok(holdout)
}

/// Hides one marker, by name, in a run of frames: a trial of the lists made for [Li10].
///
/// # Errors
/// As [`hide_segment`], and [`AugmentError::Core`] for a name that is not there.
///
/// ```
/// use mocap_core::{MarkerSet, Take};
/// let xyz = ndarray::Array3::zeros((100, 2, 3));
/// let take = Take::from_positions(MarkerSet::new(["jane:RKNE", "jane:RTHI"])?, 120.0, xyz)?;
/// let holdout = augment::one_segment(&take, "RKNE", 24..90)?;
/// assert_eq!(holdout.visible().gaps()[0].frames, 24..90);
/// # Ok::<(), augment::AugmentError>(())
/// ```
pub fn one_segment(
    take: &Take,
    marker: &str,
    frames: Range<usize>,
) -> Result<Holdout, AugmentError> {
    hide_segment(take, &[take.markers().find(marker)?], frames)
}

/// Hides all markers of an arm or a leg in a run of frames.
///
/// # Errors
/// As [`hide_segment`], and [`AugmentError::NoLimb`] for a take without such markers.
pub fn limb(take: &Take, limb: Limb, frames: Range<usize>) -> Result<Holdout, AugmentError> {
    let markers = limb.markers(take.markers());
    if markers.is_empty() {
        return Err(AugmentError::NoLimb { limb: limb.name() });
    }
    hide_segment(take, &markers, frames)
}

/// Hides all markers in a run of frames.
///
/// # Errors
/// As [`hide_segment`].
pub fn blackout(take: &Take, frames: Range<usize>) -> Result<Holdout, AugmentError> {
    hide_segment(take, &(0..take.marker_count()).collect::<Vec<_>>(), frames)
}

/// Hides this many random markers in one random run of frames, whose length is uniform in `lengths`
/// and whose start is uniform over all that fit.
///
/// The batch script of [Li10] draws its trials so, with one marker and lengths of 1 to all frames.
/// Markers are drawn from those that are observed somewhere in the run.
///
/// # Errors
/// [`AugmentError::OutOfRange`] for lengths of no frames or more than the take has,
/// [`AugmentError::MarkerCount`] for no markers or more than are observed, and
/// [`AugmentError::EmptyTake`].
pub fn random_segment(
    take: &Take,
    markers: usize,
    lengths: RangeInclusive<usize>,
    seed: u64,
) -> Result<Holdout, AugmentError> {
    check_cells(take.frames(), take.marker_count())?;
    let (shortest, longest) = lengths.into_inner();
    check("shortest length", shortest as f64, 1.0, take.frames() as f64)?;
    check("longest length", longest as f64, shortest as f64, take.frames() as f64)?;
    let mut dice = Dice::new(seed, Stream::Segments);
    let length = shortest + dice.below(longest - shortest + 1);
    let start = dice.below(take.frames() - length + 1);
    let frames = start..start + length;
    let is_seen = |m: &usize| frames.clone().any(|t| take.is_observed(t, *m));
    let mut candidates: Vec<usize> = (0..take.marker_count()).filter(is_seen).collect();
    if markers == 0 || markers > candidates.len() {
        return Err(AugmentError::MarkerCount { wanted: markers, found: candidates.len() });
    }
    for k in 0..markers {
        let other = k + dice.below(candidates.len() - k);
        candidates.swap(k, other);
    }
    hide_segment(take, &candidates[..markers], frames)
}

pub(crate) fn check_segment(segment: &Range<usize>, frames: usize) -> Result<(), AugmentError> {
    if segment.start < segment.end && segment.end <= frames {
        return Ok(());
    }
    Err(AugmentError::Segment { start: segment.start, end: segment.end, frames })
}
