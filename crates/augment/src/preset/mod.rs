use std::{fmt, str::FromStr};

use crate::{AugmentError, LengthSpan, LogNormal, OcclusionModel};

mod tables;

use tables::{SPANS, Table};

/// Gap statistics of captured performances, by marker layout.
///
/// The counts come with the authors' code of [Pan23]; the captures themselves are not public.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Preset {
    /// 53 body markers with a marker in the middle of the front waist; 5.5 hours.
    FrontWaist,
    /// 57 body markers; 17.2 hours.
    Production,
    /// 20 finger markers, ten a hand; 2.0 hours.
    TenFinger,
    /// 10 finger markers, five a hand; 19.6 hours.
    FiveFinger,
    /// 6 finger markers, three a hand; 0.7 hours.
    ThreeFinger,
}

/// Length in frames at which the counts saturate.
const SATURATED: usize = 999;
const RATE_HZ: f64 = 120.0;

impl Preset {
    /// Every preset.
    pub const ALL: [Self; 5] =
        [Self::FrontWaist, Self::Production, Self::TenFinger, Self::FiveFinger, Self::ThreeFinger];

    /// Name as users type it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::FrontWaist => "front_waist",
            Self::Production => "production",
            Self::TenFinger => "ten_finger",
            Self::FiveFinger => "five_finger",
            Self::ThreeFinger => "three_finger",
        }
    }

    fn table(self) -> &'static Table {
        match self {
            Self::FrontWaist => &tables::FRONT_WAIST,
            Self::Production => &tables::PRODUCTION,
            Self::TenFinger => &tables::TEN_FINGER,
            Self::FiveFinger => &tables::FIVE_FINGER,
            Self::ThreeFinger => &tables::THREE_FINGER,
        }
    }

    /// Number of frames at 120 Hz in which each marker was watched.
    #[must_use]
    pub fn frames(self) -> u64 {
        self.table().frames
    }

    /// Marker names and the share of frames in which each was missing, between 0 and 1.
    pub fn markers(self) -> impl Iterator<Item = (&'static str, f64)> {
        self.table().percent.iter().map(|&(name, percent)| (name, percent / 100.0))
    }

    /// Share of all cells that were missing.
    #[must_use]
    pub fn occlusion(self) -> f64 {
        let percent = self.table().percent;
        percent.iter().map(|marker| marker.1).sum::<f64>() / (100.0 * percent.len() as f64)
    }

    /// The counted gaps in 23 spans of length, the last of which is open.
    #[must_use]
    pub fn spans(self) -> Vec<LengthSpan> {
        let spans = SPANS.iter().zip(self.table().gaps);
        spans
            .map(|(&(shortest, longest), gaps)| LengthSpan {
                shortest,
                longest,
                weight: f64::from(gaps),
            })
            .collect()
    }

    /// The log-normal law of the gap lengths in frames at 120 Hz.
    #[must_use]
    pub fn law(self) -> LogNormal {
        LogNormal::trusted(self.table().mu, self.table().sigma)
    }

    /// What a sampler needs: the probabilities, and the law up to 998 frames, where the counts end.
    ///
    /// # Errors
    /// None with these numbers; the type is that of [`OcclusionModel::new`].
    pub fn model(self) -> Result<OcclusionModel, AugmentError> {
        OcclusionModel::new(self.markers(), self.law().histogram(SATURATED - 1)?, RATE_HZ)
    }
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Preset {
    type Err = AugmentError;

    /// Reads the name of a preset.
    ///
    /// ```
    /// use augment::Preset;
    /// assert_eq!("five_finger".parse(), Ok(Preset::FiveFinger));
    /// assert!("six_finger".parse::<Preset>().is_err());
    /// ```
    fn from_str(word: &str) -> Result<Self, AugmentError> {
        let same = |preset: &Self| word.eq_ignore_ascii_case(preset.name());
        Self::ALL
            .into_iter()
            .find(same)
            .ok_or_else(|| AugmentError::UnknownPreset { word: word.to_owned() })
    }
}
