//! Motions from one spot, one after the other, each told by keys of a script.

use super::LEAD_S;
use crate::{
    body::Body,
    curve::{Timeline, Wobble, ease, lerp},
    dice::Dice,
    math::{TAU, degrees, sin_cos},
};

/// Someone who stays on a spot, and is never quite still.
pub(super) struct Stance {
    pub(super) heading: f64,
    /// Legs over those of the template.
    pub(super) size: f64,
    sway: [Wobble; 2],
    pub(super) arms: [Wobble; 2],
    pub(super) head: [Wobble; 2],
}

impl Stance {
    /// `head` is how far the head turns by itself, as a standard deviation in radians.
    pub(super) fn new(body: &Body, head: f64, dice: &mut Dice) -> Self {
        let size = body.leg() / 0.852;
        let slow = |dice: &mut Dice, rms: f64| Wobble::new(dice, rms, 0.1, 0.7);
        Self {
            heading: dice.uniform(0.0, TAU),
            size,
            sway: [0, 1].map(|_| slow(dice, 0.005 * size)),
            arms: [0, 1].map(|_| slow(dice, degrees(3.0))),
            head: [0, 1].map(|_| slow(dice, head)),
        }
    }

    /// A point seen from the spot between the feet.
    pub(super) fn at(&self, ahead: f64, left: f64) -> [f64; 2] {
        let (s, c) = sin_cos(self.heading);
        [c * ahead - s * left, s * ahead + c * left]
    }

    /// The same for the pelvis, which sways.
    pub(super) fn swayed(&self, ahead: f64, left: f64, time: f64) -> [f64; 2] {
        let [x, y] = [0, 1].map(|i| self.sway[i].at(time));
        self.at(ahead + x, left + y)
    }
}

/// One run through a script of `N` channels.
pub(super) struct Bout<const N: usize> {
    pub(super) start: f64,
    pub(super) end: f64,
    /// Turn of its direction, in radians.
    pub(super) aim: f64,
    pub(super) channels: Timeline<N>,
    /// When the front foot steps ahead and back.
    pub(super) step: [f64; 2],
    pub(super) back: [f64; 2],
}

impl<const N: usize> Bout<N> {
    /// Runs that fill a take. It begins somewhere in one of them, never on a fixed pose.
    pub(super) fn all(
        seconds: f64,
        dice: &mut Dice,
        mut sample: impl FnMut(f64, &mut Dice) -> Self,
    ) -> Vec<Self> {
        let mut bouts = Vec::new();
        let mut time = -LEAD_S - dice.uniform(0.0, 2.5);
        while time < seconds + LEAD_S {
            let bout = sample(time, dice);
            time = bout.end;
            bouts.push(bout);
        }
        bouts
    }

    /// The run at a time.
    pub(super) fn of(bouts: &[Self], time: f64) -> &Self {
        &bouts[bouts.partition_point(|bout| bout.start <= time).saturating_sub(1)]
    }

    /// Share of the stride by which the front foot stands ahead: forward with the step, back at the end.
    pub(super) fn stride(&self, time: f64) -> f64 {
        let share = |[from, to]: [f64; 2]| ease((time - from) / (to - from));
        share(self.step) - share(self.back)
    }

    /// How high the front foot is on its way ahead and on its way back, from 0 to 1: one arc over the whole step, so that
    /// the foot leaves and meets the floor softly.
    pub(super) fn arcs(&self, time: f64) -> [f64; 2] {
        [self.step, self.back].map(|[from, to]| {
            let u = ((time - from) / (to - from)).clamp(0.0, 1.0);
            let v = u * (1.0 - u);
            64.0 * v * v * v
        })
    }

    /// Turn of the direction at a time.
    pub(super) fn aimed(&self, time: f64) -> f64 {
        let busy = ease((time - self.step[0]) / 0.4) * (1.0 - ease((time - self.back[0]) / 0.5));
        lerp(0.0, self.aim, busy)
    }
}

/// A script in metres of the template and degrees, for one body and with one run's vigour in every channel.
pub(super) struct Script<'a, const N: usize> {
    pub(super) rows: &'a [[f64; N]],
    /// The first channels hold lengths; all others hold angles.
    pub(super) lengths: usize,
    pub(super) size: f64,
    pub(super) vigour: [f64; N],
}

impl<const N: usize> Script<'_, N> {
    pub(super) fn row(&self, key: usize) -> [f64; N] {
        self.of(&self.rows[key])
    }

    /// The same for a row that is not in the script.
    pub(super) fn of(&self, row: &[f64; N]) -> [f64; N] {
        let rest = &self.rows[0];
        std::array::from_fn(|n| {
            let value = rest[n] + self.vigour[n] * (row[n] - rest[n]);
            if n < self.lengths { value * self.size } else { degrees(value) }
        })
    }
}
