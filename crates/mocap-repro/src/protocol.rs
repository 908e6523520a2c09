use std::{fmt, path::Path, str::FromStr};

use augment::{GapSampler, GapSamplerParams, Limb, Occluder, Preset, Unlisted};
use mocap_core::{Gap, Take};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::{
    Hide, Motions, ReproError, Trial,
    bolero::{FOLDER, LIST, LIST_CLASS},
    read_trials,
};

/// A rule by which gaps are cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Protocol {
    /// The 90 trials with one marker over 10–50 % of a motion.
    Bolero90,
    /// 1, 3, 5 and 10 markers at once for 0.1, 0.5, 1 and 2 s.
    Multi,
    /// All markers of an arm or a leg for 0.5, 1 and 2 s.
    Limb,
    /// All markers for 10, 30 and 60 frames.
    Blackout,
    /// Gaps with the lengths of real ones, long ones included, on independent markers and on
    /// neighbours that go missing together.
    Realistic,
    /// 1 and 5 markers for 0.1, 0.5, 1 and 2 s, a limb for 1 s and black-outs on recordings that no
    /// other protocol uses: the place to choose parameters.
    PseudoGaps,
}

impl Protocol {
    /// All protocols.
    pub const ALL: [Self; 6] = [
        Self::Bolero90,
        Self::Multi,
        Self::Limb,
        Self::Blackout,
        Self::Realistic,
        Self::PseudoGaps,
    ];
    /// The protocols by which methods are compared: all on which nothing may be chosen.
    pub const BOARD: [Self; 5] =
        [Self::Bolero90, Self::Multi, Self::Limb, Self::Blackout, Self::Realistic];

    /// What users type.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bolero90 => "bolero-90",
            Self::Multi => "multi",
            Self::Limb => "limb",
            Self::Blackout => "blackout",
            Self::Realistic => "realistic",
            Self::PseudoGaps => "pseudo-gaps",
        }
    }
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Protocol {
    type Err = ReproError;

    fn from_str(text: &str) -> Result<Self, ReproError> {
        let named = Self::ALL.into_iter().find(|protocol| protocol.name() == text);
        named.ok_or_else(|| ReproError::Protocol { text: text.to_owned() })
    }
}

const MARKERS_AT_ONCE: [usize; 4] = [1, 3, 5, 10];
const MULTI_S: [f64; 4] = [0.1, 0.5, 1.0, 2.0];
const LIMB_S: [f64; 3] = [0.5, 1.0, 2.0];
const BLACKOUT_FRAMES: [usize; 3] = [10, 30, 60];
/// Frames that stay visible on either side of a gap.
const SEEN_FRAMES: usize = 10;
/// Share of the samples that the protocol `realistic` hides: as much as the captures of hands lack.
const REALISTIC_SHARE: f64 = 0.05;
/// Pseudo-gaps of each kind on each recording.
const PSEUDO_DRAWS: usize = 2;

/// The trials of a protocol on the given motions. A gap that a motion is too short for, or markers that
/// it lacks, leave its trial out; the rest depends on nothing but the motions' names, lengths and markers.
///
/// # Errors
/// As [`read_trials`], for [`Protocol::Bolero90`], which reads its list from `data`;
/// [`ReproError::Sampler`].
pub fn protocol_trials(
    protocol: Protocol,
    data: &Path,
    motions: &Motions,
) -> Result<Vec<Trial>, ReproError> {
    let cuts = Cuts { protocol, motions };
    match protocol {
        Protocol::Bolero90 => {
            read_trials(&data.join(FOLDER).join(LIST), protocol.name(), LIST_CLASS)
        }
        Protocol::Multi => Ok(cuts.multi(&MARKERS_AT_ONCE)),
        Protocol::Limb => Ok(cuts.limbs(&LIMB_S)),
        Protocol::Blackout => Ok(cuts.blackouts(&BLACKOUT_FRAMES)),
        Protocol::Realistic => cuts.realistic(),
        Protocol::PseudoGaps => {
            let mut trials = cuts.multi(&[1, 5]);
            trials.extend(cuts.limbs(&[1.0]));
            trials.extend(cuts.blackouts(&[10, 30]));
            Ok(trials)
        }
    }
}

/// Cuts gaps class by class, so that tables read in order of difficulty.
struct Cuts<'a> {
    protocol: Protocol,
    motions: &'a Motions,
}

impl Cuts<'_> {
    fn multi(&self, counts: &[usize]) -> Vec<Trial> {
        let classes = counts.iter().flat_map(|&count| MULTI_S.map(|seconds| (count, seconds)));
        let cut = |(count, seconds): (usize, f64)| {
            let noun = if count == 1 { "marker" } else { "markers" };
            let class = format!("{count} {noun}, {seconds} s");
            self.each(&class, Length::Seconds(seconds), |draw| draw.some(count))
        };
        classes.flat_map(cut).collect()
    }

    fn limbs(&self, lengths_s: &[f64]) -> Vec<Trial> {
        let classes = lengths_s.iter().flat_map(|&seconds| Limb::ALL.map(|limb| (limb, seconds)));
        let cut = |(limb, seconds): (Limb, f64)| {
            let class = format!("{}, {seconds} s", limb.name());
            self.each(&class, Length::Seconds(seconds), |draw| draw.limb(limb))
        };
        classes.flat_map(cut).collect()
    }

    fn blackouts(&self, lengths: &[usize]) -> Vec<Trial> {
        let cut = |&frames: &usize| {
            let class = format!("all markers, {frames} frames");
            self.each(&class, Length::Frames(frames), |draw| {
                (0..draw.take.marker_count()).collect()
            })
        };
        lengths.iter().flat_map(cut).collect()
    }

    /// A trial on each motion, or several for pseudo-gaps.
    fn each(
        &self,
        class: &str,
        length: Length,
        choose: impl Fn(&mut Draw<'_>) -> Vec<usize>,
    ) -> Vec<Trial> {
        let draws = if self.protocol == Protocol::PseudoGaps { PSEUDO_DRAWS } else { 1 };
        let mut trials = Vec::new();
        for (motion, take) in self.motions.iter().map(|(name, motion)| (name, motion.take())) {
            for number in 1..=draws {
                let place =
                    if draws == 1 { motion.clone() } else { format!("{motion} ({number})") };
                let seed = seed(&[self.protocol.name(), class, &place]);
                let draw = Draw { rng: ChaCha8Rng::seed_from_u64(seed), take, frames: 0..0 };
                if let Some(gaps) = draw.gaps(length, &choose) {
                    let name = format!("{place}, {class}");
                    trials.push(self.trial(class, name, motion.clone(), hides(take, &gaps)));
                }
            }
        }
        trials
    }

    fn realistic(&self) -> Result<Vec<Trial>, ReproError> {
        let mut trials = Vec::new();
        for (class, occluder) in
            [("independent markers", None), ("neighbours together", Some(Occluder::default()))]
        {
            for (name, motion) in self.motions {
                let take = motion.take();
                let params = GapSamplerParams {
                    occlusion: REALISTIC_SHARE,
                    unlisted: Unlisted::Mean,
                    occluder,
                    seed: seed(&[self.protocol.name(), name]),
                    ..GapSamplerParams::default()
                };
                let model = Preset::FrontWaist.model()?.at_rate(take.rate_hz())?;
                let draw = GapSampler::new(model, params)?.sample(take)?.draw;
                let hidden = hides(take, &draw.gaps);
                trials.push(self.trial(class, format!("{name}, {class}"), name.clone(), hidden));
            }
        }
        Ok(trials)
    }

    fn trial(&self, class: &str, name: String, motion: String, hidden: Vec<Hide>) -> Trial {
        let (set, class) = (self.protocol.name().to_owned(), class.to_owned());
        Trial { set, class, name, motion, hidden, seed: 1, iterations: None }
    }
}

pub(crate) fn hides(take: &Take, gaps: &[Gap]) -> Vec<Hide> {
    let hide = |gap: &Gap| Hide {
        marker: take.markers().name(gap.marker).to_owned(),
        start: gap.frames.start,
        end: gap.frames.end,
    };
    gaps.iter().map(hide).collect()
}

#[derive(Clone, Copy)]
enum Length {
    Seconds(f64),
    Frames(usize),
}

impl Length {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few seconds
    fn frames(self, rate_hz: f64) -> usize {
        match self {
            Self::Seconds(seconds) => (seconds * rate_hz).round().max(0.0) as usize,
            Self::Frames(frames) => frames,
        }
    }
}

/// One gap on one motion.
struct Draw<'a> {
    rng: ChaCha8Rng,
    take: &'a Take,
    frames: std::ops::Range<usize>,
}

impl Draw<'_> {
    /// The gap in each of the chosen markers, if there is room for it.
    fn gaps(
        mut self,
        length: Length,
        choose: impl Fn(&mut Self) -> Vec<usize>,
    ) -> Option<Vec<Gap>> {
        let frames = length.frames(self.take.rate_hz());
        let last_start = self.take.frames().checked_sub(frames + SEEN_FRAMES)?;
        if frames == 0 || last_start < SEEN_FRAMES {
            return None;
        }
        let start = self.rng.random_range(SEEN_FRAMES..=last_start);
        self.frames = start..start + frames;
        let markers = choose(&mut self);
        let gap = |marker| Gap { marker, frames: self.frames.clone() };
        (!markers.is_empty()).then(|| markers.into_iter().map(gap).collect())
    }

    /// Whether a marker was measured in all of the frames and some on either side.
    fn is_seen(&self, marker: usize) -> bool {
        let (start, end) = (self.frames.start - SEEN_FRAMES, self.frames.end + SEEN_FRAMES);
        (start..end).all(|t| self.take.is_observed(t, marker))
    }

    /// So many different markers, or none if the motion has too few.
    fn some(&mut self, count: usize) -> Vec<usize> {
        let mut left: Vec<usize> =
            (0..self.take.marker_count()).filter(|&m| self.is_seen(m)).collect();
        // A neighbour has to stay.
        if left.len() <= count {
            return Vec::new();
        }
        (0..count).map(|_| left.swap_remove(self.rng.random_range(0..left.len()))).collect()
    }

    fn limb(&mut self, limb: Limb) -> Vec<usize> {
        let mut markers = limb.markers(self.take.markers());
        markers.retain(|&m| self.is_seen(m));
        markers
    }
}

/// A seed for each place in the protocols, so that adding one changes no other: the FNV-1a hash.
fn seed(words: &[&str]) -> u64 {
    let bytes = words.iter().flat_map(|word| word.bytes().chain([0]));
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
