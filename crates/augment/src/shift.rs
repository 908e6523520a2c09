use mocap_core::Take;

use crate::{
    AugmentError,
    dice::{Dice, Stream},
    error::{check, check_cells},
};

/// Which cells are shifted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShiftModel {
    /// In each frame every marker with probability `min(|α|, 2 deviation)`, where α is normal with
    /// zero mean and this standard deviation, from 0 to 1: the authors' code. The mean probability is
    /// 0.78 times the deviation.
    PerFrame {
        /// Standard deviation of the probability.
        deviation: f64,
    },
    /// Every cell with the same probability, from 0 to 1: the words of [Pan23].
    Fixed {
        /// The probability.
        probability: f64,
    },
}

/// How markers are shifted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShiftParams {
    /// Which cells. Default: per frame with a deviation of 0.0005, as in the authors' code.
    pub model: ShiftModel,
    /// Each coordinate of an offset is uniform within ± this many metres, from 0 to 10. Default:
    /// 0.05, the authors' value for the body; theirs for fingers is 0.02.
    pub range_m: f64,
    /// Seed. Default: 0.
    pub seed: u64,
}

impl Default for ShiftParams {
    fn default() -> Self {
        Self { model: ShiftModel::PerFrame { deviation: 0.0005 }, range_m: 0.05, seed: 0 }
    }
}

/// A sample that was moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shift {
    /// Zero-based frame.
    pub frame: usize,
    /// Marker index.
    pub marker: usize,
    /// What was added to the position, in metres.
    pub offset_m: [f64; 3],
}

/// A take with outliers.
#[derive(Debug, Clone)]
pub struct Shifted {
    /// The take as a filler or a detector would see it.
    pub take: Take,
    /// Every sample that was moved, frame by frame.
    pub shifts: Vec<Shift>,
}

/// Moves single samples of markers by random offsets: the outliers of a capture.
///
/// Missing cells stay missing. To shift what is left of a holdout, shift its visible take.
///
/// # Errors
/// [`AugmentError::OutOfRange`] and [`AugmentError::EmptyTake`];
/// [`AugmentError::Core`] if an offset takes a coordinate beyond what `f64` can hold.
///
/// Implements [Pan23] Sec. 3.3, the shifts. Deviates from [Pan23] Sec. 3.3: only observed samples
/// are shifted.
pub fn shift_markers(take: &Take, params: &ShiftParams) -> Result<Shifted, AugmentError> {
    let (name, value) = match params.model {
        ShiftModel::PerFrame { deviation } => ("deviation", deviation),
        ShiftModel::Fixed { probability } => ("probability", probability),
    };
    check(name, value, 0.0, 1.0)?;
    check("range_m", params.range_m, 0.0, 10.0)?;
    let (frames, markers) = (take.frames(), take.marker_count());
    check_cells(frames, markers)?;
    let mut dice = Dice::new(params.seed, Stream::Shifts);
    let mut positions = take.positions().to_owned();
    let mut shifts = Vec::new();
    for frame in 0..frames {
        let probability = match params.model {
            ShiftModel::PerFrame { deviation } => dice.frame_probability(deviation),
            ShiftModel::Fixed { probability } => probability,
        };
        for marker in 0..markers {
            // Drawn for missing cells too, so that a gap does not change the shifts after it.
            if !dice.chance(probability) {
                continue;
            }
            let offset_m = [(); 3].map(|()| params.range_m * (2.0 * dice.unit() - 1.0));
            if take.is_observed(frame, marker) {
                for (axis, offset) in offset_m.iter().enumerate() {
                    positions[(frame, marker, axis)] += offset;
                }
                shifts.push(Shift { frame, marker, offset_m });
            }
        }
    }
    let take =
        Take::new(take.markers().clone(), take.rate_hz(), positions, take.observed().clone())?;
    Ok(Shifted { take, shifts })
}
