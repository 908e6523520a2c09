//! Steps of someone who otherwise stays on a spot: a run-up, a shuffle to the side, the way back.

use crate::{
    body::SIDE,
    curve::{Timeline, ease, hop, lerp},
    math::{atan2, degrees},
};

/// How far feet and pelvis are from where they would be on the spot; zero for someone who never steps.
pub(super) struct Footwork {
    feet: [Vec<Move>; 2],
    pelvis: Timeline<4>,
}

/// Places ahead and to the left in metres, and turns to the left in radians.
type Place = [f64; 3];

struct Move {
    start: f64,
    end: f64,
    from: Place,
    to: Place,
    lift: f64,
}

/// Where a foot is: ahead and to the left in metres, its height, and its pitch and turn in radians.
#[derive(Clone, Copy)]
pub(super) struct Shift {
    pub(super) turn: f64,
    pub(super) ahead: f64,
    pub(super) left: f64,
    pub(super) up: f64,
    pub(super) pitch: f64,
}

/// Plans steps one after the other.
pub(super) struct Planner {
    size: f64,
    at: [f64; 2],
    feet: [Vec<Move>; 2],
    pelvis: Vec<(f64, [f64; 4])>,
}

/// A walk of some steps that ends with both feet side by side.
pub(super) struct Walk {
    pub(super) start: f64,
    /// Ahead and to the left in metres.
    pub(super) to: [f64; 2],
    pub(super) steps: usize,
    /// The foot that goes first.
    pub(super) first: usize,
    /// Seconds from step to step.
    pub(super) pace: f64,
    /// Metres.
    pub(super) lift: f64,
}

impl Planner {
    /// Someone whose leg is `size` of the template's begins at a place, at a time.
    pub(super) fn new(size: f64, time: f64, at: [f64; 2]) -> Self {
        let pelvis = vec![(time, [at[0], at[1], 0.0, 0.0])];
        Self { size, at, feet: [Vec::new(), Vec::new()], pelvis }
    }

    /// Where both feet are.
    pub(super) fn at(&self) -> [f64; 2] {
        self.at
    }

    /// Appends a walk of two steps at least; returns when its last foot lands.
    pub(super) fn walk(&mut self, walk: &Walk) -> f64 {
        let (from, to) = (self.at, walk.to);
        let last = walk.steps.max(2) - 1;
        let facing = self.facing(walk);
        // The last two steps end where the body faces ahead again.
        let landing = |step: usize| {
            let share = ((step + 1) as f64 / last as f64).min(1.0);
            let turn = if share < 1.0 { facing } else { 0.0 };
            [lerp(from[0], to[0], share), lerp(from[1], to[1], share), turn]
        };
        let middle = |p: Place, q: Place| [0, 1, 2].map(|a| 0.5 * (p[a] + q[a]));
        let mut feet: [Place; 2] = [[from[0], from[1], 0.0]; 2];
        let key = |time: f64, feet: &[Place; 2], left: f64, up: f64| {
            let [x, y, turn] = middle(feet[0], feet[1]);
            (time, [x, y + left, up, turn])
        };
        self.pelvis.push(key(walk.start - 0.3 * walk.pace, &feet, 0.0, 0.0));
        for step in 0..=last {
            let foot = (walk.first + step) % 2;
            let start = walk.start + step as f64 * walk.pace;
            let (old, new) = (feet[foot], landing(step));
            feet[foot] = middle(old, new);
            // The weight is over the foot that stands.
            let weight = -SIDE[foot] * 0.03 * self.size;
            let dip = -0.012 * self.size;
            self.pelvis.push(key(start + 0.45 * walk.pace, &feet, weight, dip));
            feet[foot] = new;
            let end = start + 0.92 * walk.pace;
            self.feet[foot].push(Move { start, end, from: old, to: new, lift: walk.lift });
        }
        let end = walk.start + (last as f64 + 0.92) * walk.pace;
        self.pelvis.push(key(end + 0.35 * walk.pace, &feet, 0.0, 0.0));
        self.at = to;
        end
    }

    /// Turn of the body on the way: toward a long way's end, if that is not behind.
    fn facing(&self, walk: &Walk) -> f64 {
        /// Of someone who keeps an eye on what is ahead.
        const MOST: f64 = degrees(55.0);
        let [ahead, left] = [0, 1].map(|a| walk.to[a] - self.at[a]);
        let near = 1.0 - ease(ahead.hypot(left) / self.size - 0.5);
        (1.0 - near) * atan2(left, ahead.abs()).clamp(-MOST, MOST) * ahead.signum().max(0.3)
    }

    pub(super) fn finish(self) -> Footwork {
        Footwork { feet: self.feet, pelvis: Timeline::new(&self.pelvis) }
    }
}

impl Footwork {
    pub(super) fn none() -> Self {
        Self { feet: [Vec::new(), Vec::new()], pelvis: Timeline::new(&[]) }
    }

    /// Of the pelvis: ahead, left, up, in metres, and its turn in radians.
    pub(super) fn pelvis(&self, time: f64) -> [f64; 4] {
        self.pelvis.at(time)
    }

    /// How far the arms swing with the feet, the left one ahead, in radians.
    pub(super) fn swing(&self, time: f64) -> f64 {
        let [left, right] = [0, 1].map(|foot| self.foot(foot, time).ahead);
        0.6 * (right - left)
    }

    pub(super) fn foot(&self, foot: usize, time: f64) -> Shift {
        /// Rise of the heel in the middle of a step.
        const RISE: f64 = degrees(30.0);
        let moves = &self.feet[foot];
        let index = moves.partition_point(|step| step.start <= time);
        let Some(step) = index.checked_sub(1).map(|k| &moves[k]) else {
            let [ahead, left, turn] = moves.first().map_or([0.0; 3], |step| step.from);
            return Shift { ahead, left, turn, up: 0.0, pitch: 0.0 };
        };
        let u = (time - step.start) / (step.end - step.start);
        let [ahead, left, turn] = [0, 1, 2].map(|a| lerp(step.from[a], step.to[a], ease(u)));
        let size = (step.to[0] - step.from[0]).hypot(step.to[1] - step.from[1]);
        // A short step hardly rolls over the ball.
        let pitch = RISE * (size / 0.5).min(1.2) * hop(u);
        Shift { ahead, left, turn, up: step.lift * hop(u), pitch }
    }
}
