use crate::{
    body::Body,
    curve::{ease, hop, lerp},
    math::degrees,
    rig::{FootTarget, Pivot, pitched_ankle},
};

/// Where a foot stands flat: the floor below its ankle in metres, and its heading in radians.
#[derive(Clone, Copy)]
pub(super) struct Footprint {
    pub(super) flat: [f64; 2],
    pub(super) heading: f64,
}

struct Step {
    start: f64,
    end: f64,
    to: Footprint,
    /// Of the ankle on top of what the heel's rise lifts, in metres.
    lift: f64,
}

/// One foot that stands, and now and then steps elsewhere.
pub(super) struct Steps {
    first: Footprint,
    steps: Vec<Step>,
}

impl Steps {
    pub(super) fn new(first: Footprint) -> Self {
        Self { first, steps: Vec::new() }
    }

    /// Steps to a place; steps come in the order of time.
    pub(super) fn step(&mut self, start: f64, end: f64, to: Footprint, lift: f64) {
        self.steps.push(Step { start, end, to, lift });
    }

    pub(super) fn at(&self, body: &Body, time: f64) -> FootTarget {
        /// Rise of the heel in the middle of a step.
        const RISE: f64 = degrees(28.0);
        let begun = self.steps.partition_point(|step| step.start <= time);
        let print = |n: usize| n.checked_sub(1).map_or(self.first, |k| self.steps[k].to);
        let to = print(begun);
        let stand = |print: Footprint, pitch: f64| {
            pitched_ankle(body, print.flat, print.heading, pitch, Pivot::Ball)
        };
        let Some(step) = begun.checked_sub(1).map(|k| &self.steps[k]).filter(|s| time < s.end)
        else {
            return FootTarget { ankle: stand(to, 0.0), heading: to.heading, pitch: 0.0, toe: 0.0 };
        };
        let from = print(begun - 1);
        let u = (time - step.start) / (step.end - step.start);
        let pitch = RISE * hop(u);
        let share = ease(u);
        let (left, reached) = (stand(from, pitch), stand(to, pitch));
        let mut ankle: [f64; 3] = std::array::from_fn(|a| lerp(left[a], reached[a], share));
        ankle[2] += step.lift * hop(u);
        let heading = lerp(from.heading, to.heading, share);
        FootTarget { ankle, heading, pitch, toe: pitch * (1.0 - ease(3.0 * u)) }
    }
}
