//! Where markers sit.

mod cmu_41;
mod full_body;
mod hand;

use std::{fmt, str::FromStr};

use mocap_core::geometry::{add, scale, sub};

use crate::{
    SynthError,
    body::{Body, HEAD, LEGS},
    dice::Dice,
    rig::Placed,
    surface::Surface,
    synth::Attachment,
};
use cmu_41::CMU_41;

/// A set of body markers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Layout {
    /// The 41 markers of the CMU database.
    #[default]
    Cmu41,
    /// The 53 body markers of [Pan23] with a marker in the middle of the front waist.
    FrontWaist53,
    /// The 57 body markers of [Pan23] as worn in production.
    Production57,
}

/// Markers on the fingers of both hands; without any the skeleton has no fingers either.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Hands {
    /// None.
    #[default]
    None,
    /// Five on each hand: the tips.
    Five,
    /// Ten on each hand: tips, some middles and the middle finger's knuckle.
    Ten,
}

impl Layout {
    /// Every layout.
    pub const ALL: [Self; 3] = [Self::Cmu41, Self::FrontWaist53, Self::Production57];

    /// Name as users type it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cmu41 => "cmu-41",
            Self::FrontWaist53 => "front_waist-53",
            Self::Production57 => "production-57",
        }
    }

    /// Names of the markers, in column order.
    pub fn markers(self) -> impl Iterator<Item = &'static str> {
        self.sites().map(|site| site.label)
    }

    /// Where the markers sit, in column order.
    pub fn sites(self) -> impl Iterator<Item = MarkerSite> {
        self.table().into_iter().map(MarkerSite::from)
    }

    fn table(self) -> Vec<Site> {
        match self {
            Self::Cmu41 => CMU_41.to_vec(),
            Self::FrontWaist53 => full_body::sites(&full_body::FRONT_WAIST_53),
            Self::Production57 => full_body::sites(&full_body::PRODUCTION_57),
        }
    }
}

impl Hands {
    /// Every choice.
    pub const ALL: [Self; 3] = [Self::None, Self::Five, Self::Ten];

    /// Markers on each hand.
    #[must_use]
    pub fn per_hand(self) -> usize {
        match self {
            Self::None => 0,
            Self::Five => 5,
            Self::Ten => 10,
        }
    }

    /// Names of the markers of both hands, the left first.
    pub fn markers(self) -> impl Iterator<Item = &'static str> {
        hand::sites(self).map(|site| site.label)
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Layout {
    type Err = SynthError;

    /// Reads the name of a layout, in lower or upper case.
    ///
    /// ```
    /// use mocap_synth::Layout;
    /// assert_eq!("production-57".parse(), Ok(Layout::Production57));
    /// assert!("helen-hayes".parse::<Layout>().is_err());
    /// ```
    fn from_str(word: &str) -> Result<Self, SynthError> {
        let same = |layout: &Self| word.eq_ignore_ascii_case(layout.name());
        Self::ALL
            .into_iter()
            .find(same)
            .ok_or_else(|| SynthError::UnknownLayout { word: word.to_owned() })
    }
}

impl fmt::Display for Hands {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.per_hand().fmt(f)
    }
}

impl FromStr for Hands {
    type Err = SynthError;

    /// Reads the number of markers on each hand.
    ///
    /// ```
    /// use mocap_synth::Hands;
    /// assert_eq!("10".parse(), Ok(Hands::Ten));
    /// assert!("3".parse::<Hands>().is_err());
    /// ```
    fn from_str(word: &str) -> Result<Self, SynthError> {
        Self::ALL
            .into_iter()
            .find(|hands| hands.to_string() == word)
            .ok_or_else(|| SynthError::UnknownHands { word: word.to_owned() })
    }
}

/// Where a marker sits on the template.
#[derive(Clone, Copy)]
struct Site {
    label: &'static str,
    /// The joint that carries it, and the one that pulls at the skin with it.
    joints: [usize; 2],
    /// Share of the second joint.
    pull: f64,
    /// From the first joint in the rest pose, in metres of the template.
    offset_m: [f64; 3],
    /// How loose the skin is, 1 for the thigh.
    slack: f64,
    /// How far from there it may be stuck on, over what is usual.
    spread: f64,
    /// A small marker, as fingers wear.
    small: bool,
}

/// Where breathing lifts a marker, and how far forward and up at one standard deviation, in metres.
const BREATH: [(&str, [f64; 3]); 5] = [
    ("STRN", [0.003, 0.0, 0.002]),
    ("CLAV", [0.001, 0.0, 0.003]),
    ("LFWT", [0.001, 0.0, 0.0]),
    ("RFWT", [0.001, 0.0, 0.0]),
    ("MFWT", [0.002, 0.0, 0.0]),
];

const fn site(
    label: &'static str,
    joints: [usize; 2],
    pull: f64,
    offset_m: [f64; 3],
    slack: f64,
) -> Site {
    Site { label, joints, pull, offset_m, slack, spread: 1.0, small: false }
}

/// Where a marker of the layout sits on the body that all others vary from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkerSite {
    /// Name of the marker.
    pub label: &'static str,
    /// The joint of the skeleton that carries it.
    pub joint: usize,
    /// The joint that pulls at the skin with it, and its share from 0 to 1.
    pub pull: (usize, f64),
    /// From the first joint in the rest pose, in metres, on a body of 1.75 m.
    pub offset_m: [f64; 3],
}

impl From<Site> for MarkerSite {
    fn from(site: Site) -> Self {
        let Site { label, joints: [joint, far], pull, offset_m, .. } = site;
        Self { label, joint, pull: (far, pull), offset_m }
    }
}

/// The sites of the markers of the CMU database, in column order.
pub fn marker_sites() -> impl Iterator<Item = MarkerSite> {
    Layout::Cmu41.sites()
}

/// A marker on one body.
pub(crate) struct Worn {
    pub(crate) label: &'static str,
    pub(crate) joints: [usize; 2],
    /// In the frames of the two joints, in metres.
    pub(crate) local: [[f64; 3]; 2],
    pull: f64,
    breath: [f64; 3],
    pub(crate) slack: f64,
}

/// Standard deviation of where a marker is stuck on, per axis, in metres.
const PLACEMENT_M: f64 = 0.008;
/// Limits of the half width of the bar that carries the two wrist markers, over the template's.
const WRIST_BAR: [f64; 2] = [0.62, 1.25];
/// How far the ends of that bar stand off the skin on the template, and how thick the cap on the head
/// and the shoe under a marker are, in metres.
const BAR_M: f64 = 0.026;
const CAP_M: f64 = 0.004;
const SHOE_M: f64 = 0.006;
/// Radius of a small marker over that of a usual one.
const SMALL: f64 = 0.4;

/// Sticks the markers onto a body: on its skin if it has one, else where the layout says.
///
/// # Units
/// Metres.
pub(crate) fn wear(
    body: &Body,
    layout: Layout,
    hands: Hands,
    radius_m: f64,
    dice: &mut Dice,
) -> Vec<Worn> {
    let rest = rest_places(body);
    let skin = Surface::new(body);
    let bar = dice.uniform(WRIST_BAR[0], WRIST_BAR[1]);
    let sites = layout.table().into_iter().chain(hand::sites(hands));
    let stick = |site: Site| {
        let [near, far] = site.joints;
        let [mut x, mut y, z] = body.flesh[near];
        let on_bar = site.label.ends_with("WRA") || site.label.ends_with("WRB");
        if on_bar {
            x *= bar;
            y *= bar;
        }
        let stuck = [0, 1, 2].map(|_| dice.jitter(PLACEMENT_M));
        // On the foot the floor leaves less room.
        let on_foot = LEGS.iter().any(|l| near == l[2]);
        let spread = if on_foot { 0.5 } else { site.spread };
        let o = site.offset_m;
        let mut local = add([o[0] * x, o[1] * y, o[2] * z], scale(spread, stuck));
        if body.surface {
            let radius = if site.small { SMALL * radius_m } else { radius_m };
            let thick = match near {
                _ if on_bar => BAR_M * bar,
                HEAD => CAP_M,
                _ if on_foot => SHOE_M,
                _ => 0.0,
            };
            local = skin.on(near, local, radius + thick);
        }
        let seen_from_far = sub(add(rest[near], local), rest[far]);
        let slack = dice.around(site.slack, 0.15);
        let breath = BREATH.iter().find(|(label, _)| *label == site.label);
        Worn {
            label: site.label,
            joints: site.joints,
            local: [local, seen_from_far],
            pull: site.pull,
            breath: breath.map_or([0.0; 3], |(_, lift)| *lift),
            slack,
        }
    };
    sites.map(stick).collect()
}

impl Worn {
    pub(crate) fn attachment(&self) -> Attachment {
        let Self { label, joints, local, pull, .. } = *self;
        Attachment { label, joints, local_m: local, share: pull }
    }

    /// Where the skin under the marker is, blended from the two joints, in metres.
    /// `breath` says how full the lungs are, in standard deviations.
    pub(crate) fn place(&self, frames: &[Placed], breath: f64) -> [f64; 3] {
        let [near, far] = self.joints.map(|joint| &frames[joint]);
        let local: [f64; 3] = std::array::from_fn(|a| self.local[0][a] + breath * self.breath[a]);
        let held = near.point(local);
        if self.pull <= 0.0 {
            return held;
        }
        let pulled = far.point(self.local[1]);
        std::array::from_fn(|a| held[a] + self.pull * (pulled[a] - held[a]))
    }
}

fn rest_places(body: &Body) -> Vec<[f64; 3]> {
    let mut places: Vec<[f64; 3]> = Vec::with_capacity(body.skeleton.joints().len());
    for joint in body.skeleton.joints() {
        let origin = joint.parent.map_or([0.0; 3], |p| places[p]);
        places.push(add(origin, joint.offset_m));
    }
    places
}
