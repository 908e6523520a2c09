use crate::{dice::Dice, math::degrees};

/// How someone gets at things.
#[derive(Clone, Copy)]
pub(super) struct Manner {
    /// How far the knees bend for low things, over the template's.
    pub(super) squat: f64,
    /// Pitch of pelvis and trunk together for low things in radians, and the trunk's share of it.
    pub(super) bend: f64,
    pub(super) trunk: f64,
    /// Share of reaches with a step, its length in metres of the template, and the share of it that the pelvis goes
    /// along.
    pub(super) steps: f64,
    pub(super) step: [f64; 2],
    pub(super) along: f64,
    /// Longest time that what was fetched is held before the chest, in seconds.
    pub(super) holds: f64,
    /// Times of the movements over the template's.
    pub(super) slow: f64,
    /// Shares of low things and of those at the height of tables.
    pub(super) low: f64,
    pub(super) middle: f64,
}

pub(super) const TEMPLATE: Manner = Manner {
    squat: 1.0,
    bend: degrees(70.0),
    trunk: 0.45,
    steps: 0.35,
    step: [0.2, 0.45],
    along: 0.55,
    holds: 0.0,
    slow: 1.0,
    low: 0.35,
    middle: 0.43,
};

impl Manner {
    /// Some bend the knees, some the back.
    pub(super) fn of_person(dice: &mut Dice) -> Self {
        let squat = dice.uniform(0.25, 1.1);
        Self {
            squat,
            bend: degrees(115.0 - 40.0 * squat),
            trunk: 0.62,
            steps: 0.6,
            step: [0.25, 0.75],
            along: 0.8,
            holds: 0.8,
            slow: 1.05,
            low: 0.35,
            middle: 0.35,
        }
    }
}
