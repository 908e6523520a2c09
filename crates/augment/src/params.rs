use crate::{AugmentError, Unlisted, error::check};

/// How marker probabilities become rates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Normalisation {
    /// Divided by their mean: `occlusion` is the mean rate of the markers, as its name says and as
    /// the authors' code has it.
    #[default]
    Mean,
    /// Divided by their sum, as Eq. 6 is printed: `occlusion` is the sum of the rates of all
    /// markers, and the mean rate is M times smaller.
    Sum,
}

/// How expected numbers of gaps become whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rounding {
    /// From the longest length to the shortest, each fraction is carried on to the next, and the
    /// first from a random start: right on average for every length, and for each marker the hidden
    /// frames are within one longest gap of those planned.
    #[default]
    Systematic,
    /// Up with the probability of the fraction, each length on its own: the authors' code.
    Bernoulli,
    /// Down, as Eq. 6 is printed: lengths of which less than one gap is due never occur, which in
    /// a short take is all of them.
    Floor,
}

/// What becomes of the occlusion that a marker's limit cuts off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Excess {
    /// The other markers take it over, in proportion to their rates.
    #[default]
    Spread,
    /// It is lost, and the mean rate is lower than asked for: the authors' code.
    Drop,
}

/// Something that hides neighbouring markers together.
///
/// It moves gaps in time and never adds any: rates and lengths of each marker stay as they are
/// without it. Where a marker is hidden, each of its neighbours may spend its own longest open gap
/// inside the same frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Occluder {
    /// Neighbours it can reach, by mean distance, from 1 up. Default: 6.
    pub reach: usize,
    /// Probability, from 0 to 1, that it hides a neighbour that it reaches. Default: 0.5.
    pub coupling: f64,
}

impl Default for Occluder {
    fn default() -> Self {
        Self { reach: 6, coupling: 0.5 }
    }
}

/// What to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapSamplerParams {
    /// Share of the observed cells to hide, `p_occ`, from 0 to 1. Default: 0.1, the example of the
    /// authors' code; their captures show 0.005 to 0.05.
    pub occlusion: f64,
    /// What `occlusion` is the mean or the sum of. Default: the mean of the markers' rates.
    pub normalisation: Normalisation,
    /// How numbers of gaps are rounded. Default: with carried fractions.
    pub rounding: Rounding,
    /// Largest share of its frames that a marker may lose, from 0 to 1. Also bounds each single
    /// gap. Default: 0.5, as in the authors' code.
    pub marker_limit: f64,
    /// Where occlusion above the limit goes. Default: to the other markers.
    pub excess: Excess,
    /// What becomes of markers that the model does not list. Default: the take is refused.
    pub unlisted: Unlisted,
    /// Whether neighbours go missing together. Default: no, as in [Pan23].
    pub occluder: Option<Occluder>,
    /// Seed of all draws. Default: 0.
    pub seed: u64,
}

impl Default for GapSamplerParams {
    fn default() -> Self {
        Self {
            occlusion: 0.1,
            normalisation: Normalisation::default(),
            rounding: Rounding::default(),
            marker_limit: 0.5,
            excess: Excess::default(),
            unlisted: Unlisted::default(),
            occluder: None,
            seed: 0,
        }
    }
}

impl GapSamplerParams {
    /// Eq. 6 to the letter: divided by the sum, rounded down, no limit of a marker.
    #[must_use]
    pub fn printed() -> Self {
        Self {
            normalisation: Normalisation::Sum,
            rounding: Rounding::Floor,
            marker_limit: 1.0,
            ..Self::default()
        }
    }

    /// The rates and roundings of the authors' code; its gaps have 1 to 199 frames, see
    /// [`OcclusionModel::clipped`].
    #[must_use]
    pub fn authors_code() -> Self {
        Self { rounding: Rounding::Bernoulli, excess: Excess::Drop, ..Self::default() }
    }

    pub(crate) fn check(&self) -> Result<(), AugmentError> {
        let Self { occlusion, marker_limit: limit, .. } = *self;
        check("occlusion", occlusion, 0.0, 1.0)?;
        check("marker_limit", limit, 0.0, 1.0)?;
        if let Some(Occluder { reach, coupling }) = self.occluder {
            check("reach", reach as f64, 1.0, f64::MAX)?;
            check("coupling", coupling, 0.0, 1.0)?;
        }
        let keeps_mean = self.normalisation == Normalisation::Mean && self.excess == Excess::Spread;
        if keeps_mean && occlusion > limit {
            return Err(AugmentError::AboveLimit { occlusion, limit });
        }
        Ok(())
    }
}
