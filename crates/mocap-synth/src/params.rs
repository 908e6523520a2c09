use std::{fmt, str::FromStr};

use crate::{Hands, Layout, Person, SynthError};

/// What the body does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Activity {
    /// Walks round a small oval track at about 1.3 m/s.
    Walk,
    /// Walks straight on and round sharp corners, to the left and to the right.
    Corner,
    /// Runs round a larger track at about 3 m/s.
    Run,
    /// Jumps from both feet again and again: crouch, take-off, flight, landing.
    Jump,
    /// Jumps as far as it gets, with both arms swinging.
    Leap,
    /// Throws overarm with the right hand again and again: wind-up, step, throw, follow-through.
    Throw,
    /// Turns on the spot with small steps, the head ahead of the body.
    Turn,
    /// Reaches for things near and far, high and low, with either hand.
    Reach,
    /// Kicks with the right foot again and again: run-up step, swing, follow-through.
    Kick,
}

impl Activity {
    /// Every activity.
    pub const ALL: [Self; 9] = [
        Self::Walk,
        Self::Run,
        Self::Jump,
        Self::Throw,
        Self::Turn,
        Self::Reach,
        Self::Kick,
        Self::Leap,
        Self::Corner,
    ];

    /// Name as users type it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Run => "run",
            Self::Jump => "jump",
            Self::Leap => "leap",
            Self::Corner => "corner",
            Self::Throw => "throw",
            Self::Turn => "turn",
            Self::Reach => "reach",
            Self::Kick => "kick",
        }
    }
}

impl fmt::Display for Activity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Activity {
    type Err = SynthError;

    /// Reads the name of an activity, in lower or upper case.
    ///
    /// ```
    /// use mocap_synth::Activity;
    /// assert_eq!("Run".parse(), Ok(Activity::Run));
    /// assert!("swim".parse::<Activity>().is_err());
    /// ```
    fn from_str(word: &str) -> Result<Self, SynthError> {
        let same = |a: &Self| word.eq_ignore_ascii_case(a.name());
        Self::ALL
            .into_iter()
            .find(same)
            .ok_or_else(|| SynthError::UnknownActivity { word: word.to_owned() })
    }
}

/// What to synthesise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SynthParams {
    /// What the body does. Default: walk.
    pub motion: Activity,
    /// Number of frames T, from 1 to 1 000 000. Default: 600, five seconds at the default rate.
    pub frames: usize,
    /// Sampling rate in Hz, from 10 to 2000. Default: 120, the rate of the CMU database.
    pub rate_hz: f64,
    /// Seed of the body, its markers, its motion and the noise. Default: 0.
    pub seed: u64,
    /// Height of the template body in metres, from 1.2 to 2.2; a person has their own. Default: 1.75.
    pub stature_m: f64,
    /// Whose body it is. Default: nobody's, the template at `stature_m` with every length a few percent off by
    /// `seed`, and markers where the layout says. A person has measures that go together, and a skin that
    /// markers sit on.
    pub person: Option<Person>,
    /// Which markers the body wears. Default: those of the CMU database.
    pub layout: Layout,
    /// Markers on the fingers, and fingers that move. Default: none.
    pub hands: Hands,
    /// Radius of the markers in metres, from 0 to 0.03: their centres are so far above the skin of a person.
    /// Finger markers have 0.4 of it. Default: 0.007.
    pub marker_radius_m: f64,
    /// Standard deviation of the white measurement noise per coordinate in metres, from 0 to 0.01.
    /// Default: 0.00025, what a calibrated optical system shows on a marker at rest.
    pub noise_m: f64,
    /// Scale of the soft-tissue movement, from 0 (markers glued to bone) to 3. Default: 1, which
    /// gives bone-length deviations like those of captured bodies.
    pub soft_tissue: f64,
}

impl Default for SynthParams {
    fn default() -> Self {
        Self {
            motion: Activity::Walk,
            frames: 600,
            rate_hz: 120.0,
            seed: 0,
            stature_m: 1.75,
            person: None,
            layout: Layout::Cmu41,
            hands: Hands::None,
            marker_radius_m: 0.007,
            noise_m: 0.000_25,
            soft_tissue: 1.0,
        }
    }
}

const MAX_FRAMES: usize = 1_000_000;

impl SynthParams {
    pub(crate) fn check(&self) -> Result<(), SynthError> {
        if !(1..=MAX_FRAMES).contains(&self.frames) {
            return Err(SynthError::Frames { frames: self.frames, min: 1, max: MAX_FRAMES });
        }
        check("rate_hz", self.rate_hz, 10.0, 2000.0, "Hz")?;
        check("stature_m", self.stature_m, 1.2, 2.2, "m")?;
        check("marker_radius_m", self.marker_radius_m, 0.0, 0.03, "m")?;
        check("noise_m", self.noise_m, 0.0, 0.01, "m")?;
        check("soft_tissue", self.soft_tissue, 0.0, 3.0, "times the default")
    }
}

pub(crate) fn check(
    name: &'static str,
    value: f64,
    min: f64,
    max: f64,
    unit: &'static str,
) -> Result<(), SynthError> {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    Err(SynthError::OutOfRange { name, value, min, max, unit })
}
