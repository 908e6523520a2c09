use mocap_core::CoreError;
use thiserror::Error;

/// What this crate refuses.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum AugmentError {
    /// A parameter outside of the allowed range, or not a number.
    #[error("`{name}` = {value} is not between {min} and {max}; choose a value in that range")]
    OutOfRange {
        /// Name of the parameter.
        name: &'static str,
        /// The value as given.
        value: f64,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
    },
    /// A take without frames or without markers.
    #[error("{frames} frames × {markers} markers leave nothing to work on; give a take with both")]
    EmptyTake {
        /// Frames of the take.
        frames: usize,
        /// Markers of the take.
        markers: usize,
    },
    /// No take at all.
    #[error("statistics of no takes are empty; give at least one")]
    NoTakes,
    /// Takes whose frames last differently long.
    #[error(
        "takes at {first_hz} Hz and {other_hz} Hz count gap lengths in different frames; \
         make statistics of each rate on its own"
    )]
    MixedRates {
        /// Rate of the first take in Hz.
        first_hz: f64,
        /// The rate that differs.
        other_hz: f64,
    },
    /// A model whose frames last differently long than those of the take.
    #[error(
        "the model counts frames at {model_hz} Hz and the take at {take_hz} Hz; \
         convert it with `OcclusionModel::at_rate`"
    )]
    RateMismatch {
        /// Rate of the model in Hz.
        model_hz: f64,
        /// Rate of the take in Hz.
        take_hz: f64,
    },
    /// A gap length of no frames.
    #[error("a gap of length 0 is no gap; lengths start at 1 frame")]
    ZeroLength,
    /// A weight that is negative or not finite.
    #[error("gaps of {frames} frames have weight {weight}; weights are finite and not negative")]
    Weight {
        /// Length of the gaps in frames.
        frames: usize,
        /// The weight as given.
        weight: f64,
    },
    /// A histogram without any gap.
    #[error(
        "a gap histogram without weight has nothing to draw; give one length a positive weight"
    )]
    EmptyHistogram,
    /// A span of lengths that ends before it begins.
    #[error("a gap of {shortest} to {longest} frames cannot be; give the shorter length first")]
    Span {
        /// Shortest length of the span.
        shortest: usize,
        /// Longest length of the span.
        longest: usize,
    },
    /// Too few lengths for two parameters.
    #[error(
        "a log-normal law needs gaps of at least 2 different lengths whose ends were seen, \
         not {distinct}; add takes"
    )]
    TooFewLengths {
        /// Different lengths at hand.
        distinct: usize,
    },
    /// A marker of the take that the model does not list.
    #[error(
        "marker `{marker}` is not among the {listed} markers of the model; \
         rename it, or let `unlisted` say what becomes of such markers"
    )]
    UnlistedMarker {
        /// Name of the marker.
        marker: String,
        /// Markers of the model.
        listed: usize,
    },
    /// A model whose probabilities are all zero on the markers of the take.
    #[error("no marker of the take has a positive occlusion probability; give one of them one")]
    NeverOccluded,
    /// A mean rate above the limit of each marker.
    #[error(
        "a mean occlusion of {occlusion} is above the limit of {limit} of a single marker; \
         lower `occlusion` or raise `marker_limit`"
    )]
    AboveLimit {
        /// The mean rate as given.
        occlusion: f64,
        /// The limit as given.
        limit: f64,
    },
    /// Neighbours of another marker set.
    #[error(
        "neighbours of {found} markers do not fit a set of {expected}; compute them on this set"
    )]
    NeighbourCount {
        /// Markers of the take.
        expected: usize,
        /// Markers with neighbours.
        found: usize,
    },
    /// A segment that is empty or leaves the take.
    #[error(
        "frames {start}..{end} are no segment of a take of {frames} frames; stay below its end"
    )]
    Segment {
        /// First frame of the segment.
        start: usize,
        /// Frame after its last.
        end: usize,
        /// Frames of the take.
        frames: usize,
    },
    /// A segment in which nothing was observed.
    #[error(
        "no chosen marker is observed in frames {start}..{end}, so there is no truth to hide; \
         choose other frames or markers"
    )]
    NothingToHide {
        /// First frame of the segment.
        start: usize,
        /// Frame after its last.
        end: usize,
    },
    /// A draw of more markers than there are.
    #[error("{wanted} markers were asked for, but there are {found}; ask for 1 to {found}")]
    MarkerCount {
        /// Markers asked for.
        wanted: usize,
        /// Markers to choose from.
        found: usize,
    },
    /// A take without markers of the limb.
    #[error("no marker of the take is known to lie on the {limb}; list the markers by index")]
    NoLimb {
        /// Name of the limb.
        limb: &'static str,
    },
    /// A swap of a marker with itself.
    #[error("marker {marker} cannot be swapped with itself; name two markers")]
    SelfSwap {
        /// The marker.
        marker: usize,
    },
    /// A word that names no preset.
    #[error(
        "`{word}` is no preset; choose one of front_waist, production, ten_finger, five_finger, \
         three_finger"
    )]
    UnknownPreset {
        /// The word as given.
        word: String,
    },
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
}

/// Refuses a value outside of `min..=max`, NaN included.
pub(crate) fn check(
    name: &'static str,
    value: f64,
    min: f64,
    max: f64,
) -> Result<(), AugmentError> {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    Err(AugmentError::OutOfRange { name, value, min, max })
}

/// Refuses takes and masks without cells.
pub(crate) fn check_cells(frames: usize, markers: usize) -> Result<(), AugmentError> {
    if frames == 0 || markers == 0 {
        return Err(AugmentError::EmptyTake { frames, markers });
    }
    Ok(())
}
