use mocap_core::Rotation;

use super::{
    FINGERS, HAND_JOINTS,
    grip::{ANGLES, Grip},
    pinch::pinch,
    rotations,
};
use crate::{
    curve::{Timeline, Wobble},
    dice::Dice,
    math::degrees,
    motion::LEAD_S,
};

/// The fingers of one hand over time: grasp after grasp, pinch after pinch, with rests between.
pub(crate) struct Fingers {
    side: usize,
    /// Each finger has a timeline of its own: fingers neither start nor arrive together.
    lags: [f64; FINGERS + 1],
    angles: Timeline<ANGLES>,
    tremble: [Wobble; 2],
}

/// Fingers lag behind the hand by at most this, in seconds.
const LAG_S: f64 = 0.06;

impl Fingers {
    pub(crate) fn new(side: usize, seconds: f64, dice: &mut Dice) -> Self {
        let lags = std::array::from_fn(|_| dice.uniform(0.0, LAG_S));
        let tremble = [0, 1].map(|_| Wobble::new(dice, degrees(1.2), 0.3, 1.5));
        let mut keys = Vec::new();
        let mut time = -LEAD_S - LAG_S - dice.uniform(0.5, 2.5);
        keys.push((time, varied(Grip::REST, dice).0));
        while time < seconds + LEAD_S {
            let mut go = |length: f64, grip: Grip, dice: &mut Dice| {
                time += dice.around(length, 0.2);
                keys.push((time, grip.0));
            };
            let target = choose(dice);
            let rest = varied(if dice.unit() < 0.6 { Grip::REST } else { Grip::OPEN }, dice);
            let ready = varied(Grip::READY, dice);
            go(0.45, ready, dice);
            go(0.38, target, dice);
            // Holds on: a key a little tighter, so that a hand that holds is never quite still.
            let hold = dice.uniform(0.2, 1.2);
            go(hold, target.along_synergies(degrees(1.5), 0.0), dice);
            if dice.unit() < 0.3 {
                // Lets go and takes again, as fingers that play with something do.
                go(0.25, between(&target, &ready, 0.5), dice);
                go(0.25, target, dice);
            }
            go(0.40, rest, dice);
            let pause = dice.uniform(0.1, 0.9);
            go(pause, rest.along_synergies(degrees(1.0), 0.0), dice);
        }
        Self { side, lags, angles: Timeline::new(&keys), tremble }
    }

    /// Angles at a time in seconds.
    pub(crate) fn grip(&self, time: f64) -> Grip {
        let mut grip = Grip([0.0; ANGLES]);
        for (finger, lag) in self.lags.iter().enumerate() {
            let now = self.angles.at(time - lag);
            let own = 4 * finger..4 * finger + 4;
            grip.0[own.clone()].copy_from_slice(&now[own]);
        }
        let [closing, hooking] = [0, 1].map(|i| self.tremble[i].at(time));
        grip.along_synergies(closing, hooking)
    }

    pub(crate) fn rotations(&self, time: f64) -> [Rotation; HAND_JOINTS] {
        rotations(&self.grip(time), self.side)
    }
}

/// A pinch or a grasp, unlike any before.
fn choose(dice: &mut Dice) -> Grip {
    // The index finger pinches most, the little finger least.
    const SHARES: [f64; FINGERS] = [0.20, 0.10, 0.04, 0.06];
    let mut u = dice.unit();
    for (finger, share) in SHARES.into_iter().enumerate() {
        if u < share {
            return pinch(varied(Grip::PINCH, dice), finger);
        }
        u -= share;
    }
    let left = 1.0 - SHARES.iter().sum::<f64>();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let index = (u / left * Grip::GRASPS.len() as f64) as usize;
    varied(Grip::GRASPS[index.min(Grip::GRASPS.len() - 1)], dice)
}

/// No two grasps are alike: they differ along the synergies, and a little in every joint.
fn varied(grip: Grip, dice: &mut Dice) -> Grip {
    let mut grip = grip.along_synergies(degrees(dice.jitter(4.0)), degrees(dice.jitter(3.0)));
    for angle in &mut grip.0 {
        *angle += degrees(dice.jitter(1.5));
    }
    grip.limited()
}

fn between(a: &Grip, b: &Grip, share: f64) -> Grip {
    Grip(std::array::from_fn(|n| a.0[n] + share * (b.0[n] - a.0[n])))
}
