use super::{Choreography, LEAD_S};
use crate::{
    body::{Body, SIDE},
    curve::{Timeline, Wobble, ease, lerp},
    dice::Dice,
    math::{TAU, cos, degrees, sin_cos},
    rig::{Arm, FootTarget, Pivot, Posture, Tilt, pitched_ankle},
};

const GRAVITY: f64 = 9.81;

/// Channels of a jump's timeline.
const HEIGHT: usize = 0;
const AHEAD: usize = 1;
const CHANNELS: usize = 9;

/// Standing jumps one after the other, each ahead and a little to one side.
pub(crate) struct Jump {
    hops: Vec<Hop>,
    sway: [Wobble; 2],
    arms: [Wobble; 2],
    head: [Wobble; 2],
    breath: Wobble,
    /// Of each arm from the trunk, in radians.
    spread: [f64; 2],
}

struct Hop {
    start: f64,
    end: f64,
    take_off: f64,
    landing: f64,
    from: Stance,
    to: Stance,
    /// Of the feet over a straight line in flight, in metres.
    tuck: f64,
    channels: Timeline<CHANNELS>,
}

/// Where both feet stand: the point between the ankles, and the body's heading.
#[derive(Clone, Copy)]
struct Stance {
    place: [f64; 2],
    heading: f64,
    half_width: f64,
}

impl Jump {
    pub(crate) fn new(body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let size = body.scale.stature;
        let slow = |dice: &mut Dice, rms: f64| Wobble::new(dice, rms, 0.1, 0.7);
        let mut jump = Self {
            hops: Vec::new(),
            sway: [0, 1].map(|_| slow(dice, 0.005 * size)),
            arms: [0, 1].map(|_| slow(dice, degrees(3.0))),
            head: [0, 1].map(|_| slow(dice, degrees(6.0))),
            breath: slow(dice, degrees(0.8)),
            spread: [0, 1].map(|_| degrees(10.0 + dice.jitter(3.0))),
        };
        let side = dice.sign();
        let mut from =
            Stance { place: [0.0; 2], heading: dice.uniform(0.0, TAU), half_width: 0.11 * size };
        // A take begins somewhere in a jump, never on a fixed pose.
        let mut time = -LEAD_S - dice.uniform(0.0, 2.0);
        while time < seconds + LEAD_S {
            let hop = Hop::sample(body, time, from, side, dice);
            (time, from) = (hop.end, hop.to);
            jump.hops.push(hop);
        }
        jump
    }
}

impl Hop {
    fn sample(body: &Body, start: f64, from: Stance, side: f64, dice: &mut Dice) -> Self {
        let size = body.scale.stature;
        let rise = dice.around(0.27, 0.25) * size;
        let reach = dice.around(0.42, 0.25) * size;
        let depth = dice.around(0.27, 0.12) * size;
        let (tip, settle, absorb) = (0.055 * size, 0.02 * size, dice.around(0.20, 0.15) * size);
        let speed = (2.0 * GRAVITY * rise).sqrt();
        let down = (2.0 * GRAVITY * (rise + tip - settle)).sqrt();
        // Twice the mean speed of a push that starts from rest and ends at take-off speed.
        let push = 1.75 * (depth + tip) / speed;
        let brake = 1.75 * (absorb + settle) / down;
        let lengths = [
            dice.around(0.30, 0.3),
            dice.around(0.50, 0.15),
            push,
            (speed + down) / GRAVITY,
            brake,
            dice.around(0.55, 0.15),
            dice.around(0.25, 0.3),
        ];
        let mut times = [start; 8];
        for (i, length) in lengths.into_iter().enumerate() {
            times[i + 1] = times[i] + length;
        }
        let (take_off, landing) = (times[3], times[4]);
        let crouched = degrees(dice.around(32.0, 0.1));
        let back = degrees(dice.around(-50.0, 0.15));
        let up = degrees(dice.around(95.0, 0.12));
        let d = degrees;
        // Height, way, pelvis pitch, trunk pitch, arm flexion, abduction, elbow, foot, head.
        let stand = [0.0, 0.0, d(4.0), d(-2.0), d(2.0), 0.0, d(16.0), 0.0, 0.0];
        let finish = [0.0, reach, d(4.0), d(-2.0), d(2.0), 0.0, d(16.0), 0.0, 0.0];
        let keys = [
            (times[0], stand),
            (times[1], stand),
            (
                lerp(times[1], times[2], 0.55),
                [-0.55 * depth, 0.0, 0.6 * crouched, d(10.0), back, d(4.0), d(18.0), 0.0, d(-12.0)],
            ),
            (
                times[2],
                [
                    -depth,
                    0.02 * size,
                    crouched,
                    d(18.0),
                    0.25 * back,
                    d(8.0),
                    d(20.0),
                    d(5.0),
                    d(-22.0),
                ],
            ),
            (
                take_off,
                [tip, 0.13 * size, d(10.0), d(-4.0), up, d(12.0), d(35.0), d(48.0), d(-8.0)],
            ),
            (
                landing,
                [
                    settle,
                    reach - 0.06 * size,
                    d(16.0),
                    d(8.0),
                    d(55.0),
                    d(22.0),
                    d(40.0),
                    d(24.0),
                    d(6.0),
                ],
            ),
            (
                times[5],
                [-absorb, reach, d(26.0), d(14.0), d(25.0), d(18.0), d(35.0), 0.0, d(-12.0)],
            ),
            (times[6], finish),
            (times[7], finish),
        ];
        let mut channels = Timeline::new(&keys);
        channels.pin(3, HEIGHT, 0.0, 0.8 * speed / push);
        channels.pin(4, HEIGHT, speed, -GRAVITY);
        channels.pin(5, HEIGHT, -down, -GRAVITY);
        channels.pin(6, HEIGHT, 0.0, 0.8 * down / brake);
        let along = (reach - 0.19 * size) / (landing - take_off);
        channels.pin(4, AHEAD, along, 0.0);
        channels.pin(5, AHEAD, along, 0.0);
        let to = Stance {
            place: from.ahead(reach),
            heading: from.heading + side * degrees(35.0 + dice.jitter(10.0)),
            half_width: dice.around(0.11, 0.1) * size,
        };
        let tuck = rise + 0.03 * size;
        Self { start, end: times[7], take_off, landing, from, to, tuck, channels }
    }

    fn foot(&self, body: &Body, side: f64, pitch: f64, time: f64) -> FootTarget {
        let at = |stance: &Stance| {
            let heading = stance.heading - side * degrees(6.0);
            let flat = stance.beside(side * stance.half_width);
            (pitched_ankle(body, flat, heading, pitch, Pivot::Ball), heading)
        };
        let u = ((time - self.take_off) / (self.landing - self.take_off)).clamp(0.0, 1.0);
        let share = ease(u);
        let ((left, heading), (reached, new_heading)) = (at(&self.from), at(&self.to));
        let mut ankle: [f64; 3] = std::array::from_fn(|a| lerp(left[a], reached[a], share));
        let v = u * (1.0 - u);
        ankle[2] += 16.0 * self.tuck * v * v;
        // The toes stay on the floor while the heel rises, and straighten in flight.
        let grounded = 1.0 - ease(5.0 * u) * ease(5.0 * (1.0 - u));
        let heading = lerp(heading, new_heading, share);
        FootTarget { ankle, heading, pitch, toe: pitch.max(0.0) * grounded }
    }
}

impl Stance {
    fn ahead(&self, metres: f64) -> [f64; 2] {
        let (s, c) = sin_cos(self.heading);
        [self.place[0] + c * metres, self.place[1] + s * metres]
    }

    fn beside(&self, left: f64) -> [f64; 2] {
        let (s, c) = sin_cos(self.heading);
        [self.place[0] - s * left, self.place[1] + c * left]
    }
}

impl Choreography for Jump {
    fn posture(&self, body: &Body, time: f64) -> Posture {
        let index = self.hops.partition_point(|h| h.start <= time).saturating_sub(1);
        let hop = &self.hops[index];
        let [height, ahead, pitch, lean, flexion, abduction, elbow, foot, nod] =
            hop.channels.at(time);
        let turn = ease((time - hop.take_off) / (hop.landing - hop.take_off));
        let heading = lerp(hop.from.heading, hop.to.heading, turn);
        let [x, y] = hop.from.ahead(ahead);
        // Above the shoulder the same roll would bring the hands together.
        let apart = cos(flexion);
        let arm = |i: usize| Arm {
            flexion: flexion + self.arms[i].at(time),
            abduction: apart * (abduction + self.spread[i]),
            outward: degrees(-18.0) + 0.2 * flexion.max(0.0),
            elbow: elbow + 0.6 * self.arms[1 - i].at(time),
            pronation: degrees(25.0),
            wrist: degrees(3.0),
            shrug: 0.08 * flexion.max(0.0),
            across: -0.15 * flexion.max(0.0),
        };
        let [sway_x, sway_y] = [0, 1].map(|i| self.sway[i].at(time));
        Posture {
            pelvis_m: [x + sway_x, y + sway_y, body.standing() - 0.010 * body.leg() + height],
            pelvis: Tilt { pitch, roll: 1.5 * sway_y, yaw: heading + 3.0 * sway_x },
            trunk: Tilt {
                pitch: lean + self.breath.at(time),
                roll: -1.5 * sway_y,
                yaw: 2.0 * sway_y,
            },
            head: Tilt {
                pitch: nod + self.head[0].at(time),
                roll: 0.0,
                yaw: self.head[1].at(time),
            },
            arms: [arm(0), arm(1)],
            feet: SIDE.map(|side| hop.foot(body, side, foot, time)),
        }
    }
}
