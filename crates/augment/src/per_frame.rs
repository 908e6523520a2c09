use mocap_core::{Holdout, Mask, Take};

use crate::{
    AugmentError,
    dice::{Dice, Stream},
    error::{check, check_cells},
};

/// How the per-frame baseline hides cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PerFrameParams {
    /// Standard deviation of the occlusion probability of a frame, from 0 to 1. Default: 0.1, as in
    /// [Holden18] and [Chen21]; it hides 7.8 % of the cells.
    pub deviation: f64,
    /// Seed. Default: 0.
    pub seed: u64,
}

impl Default for PerFrameParams {
    fn default() -> Self {
        Self { deviation: 0.1, seed: 0 }
    }
}

/// Hides cells frame by frame: in each, every marker with probability `min(|α|, 2 deviation)`,
/// where α is normal with zero mean and that deviation.
///
/// The baseline of [Holden18] and [Chen21], against which [Pan23] sets its gaps: frames know nothing
/// of each other, so that gaps of more than a few frames hardly occur.
///
/// # Errors
/// [`AugmentError::OutOfRange`] and [`AugmentError::EmptyTake`].
pub fn hide_per_frame(take: &Take, params: &PerFrameParams) -> Result<Holdout, AugmentError> {
    check("deviation", params.deviation, 0.0, 1.0)?;
    let (frames, markers) = (take.frames(), take.marker_count());
    check_cells(frames, markers)?;
    let mut dice = Dice::new(params.seed, Stream::PerFrame);
    let mut hidden = Mask::none(frames, markers);
    for t in 0..frames {
        let probability = dice.frame_probability(params.deviation);
        for m in 0..markers {
            if dice.chance(probability) {
                hidden.insert(t, m)?;
            }
        }
    }
    Ok(Holdout::new(take.clone(), &hidden)?)
}
