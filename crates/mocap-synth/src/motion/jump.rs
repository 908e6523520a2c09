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

/// How someone jumps. Lengths in metres of the template, times in seconds, angles in degrees.
#[derive(Clone, Copy)]
pub(crate) struct Way {
    /// Mean height and mean length of the jumps.
    rise: f64,
    reach: f64,
    /// Deviation of both from jump to jump, as a share.
    spread: f64,
    /// How far the body sinks before take-off and after landing.
    depth: f64,
    absorb: f64,
    /// The pelvis over standing when the feet leave and meet the floor.
    tip: f64,
    settle: f64,
    /// The pelvis ahead of the feet at take-off, and behind them at landing.
    lean_out: f64,
    lean_in: f64,
    /// Mean times of standing before and after.
    waits: [f64; 2],
    /// Flexion of the arms before the crouch, behind the body and at take-off.
    arms: [f64; 3],
    /// The arms at the lowest point, as a share of their way back.
    passing: f64,
    /// Of the elbows, over the template's.
    bend: f64,
    /// How far trunk and head go along, over the template's.
    bow: f64,
    /// How far the pelvis tilts in the crouch, over the template's.
    tilt: f64,
    /// Turn from jump to jump.
    turn: f64,
}

pub(crate) const TEMPLATE: Way = Way {
    rise: 0.27,
    reach: 0.42,
    spread: 0.25,
    depth: 0.27,
    absorb: 0.20,
    tip: 0.055,
    settle: 0.02,
    lean_out: 0.13,
    lean_in: 0.06,
    waits: [0.30, 0.25],
    arms: [2.0, -50.0, 95.0],
    passing: 0.25,
    bend: 1.0,
    bow: 1.0,
    tilt: 1.0,
    turn: 35.0,
};

impl Way {
    /// Single jumps as people of the CMU and HDM05 databases do them: longer stands, less swing of the arms, knees bent
    /// at landing. Some jump up, some ahead.
    pub(crate) fn of_person(dice: &mut Dice) -> Self {
        Self {
            reach: dice.uniform(0.05, 1.0),
            depth: 0.22,
            tip: 0.035,
            settle: -0.05,
            waits: [0.38, 0.28],
            absorb: 0.25,
            arms: [2.0, -dice.uniform(15.0, 45.0), dice.uniform(15.0, 55.0)],
            bend: 1.7,
            bow: 1.0,
            tilt: 0.45,
            ..TEMPLATE
        }
    }

    /// As far as they get: both arms swing ahead, back and ahead again.
    pub(crate) fn far(dice: &mut Dice) -> Self {
        Self {
            rise: 0.20,
            reach: dice.uniform(0.9, 1.5),
            spread: 0.12,
            depth: 0.21,
            absorb: 0.25,
            tip: 0.0,
            settle: -0.06,
            lean_out: 0.28,
            lean_in: 0.22,
            waits: [0.20, 0.06],
            arms: [dice.uniform(50.0, 80.0), -64.0, dice.uniform(75.0, 98.0)],
            passing: -0.8,
            bend: 1.2,
            bow: 0.9,
            tilt: 0.65,
            turn: 25.0,
        }
    }
}

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
    pub(crate) fn new(way: &Way, body: &Body, seconds: f64, dice: &mut Dice) -> Self {
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
            let hop = Hop::sample(way, body, time, from, side, dice);
            (time, from) = (hop.end, hop.to);
            jump.hops.push(hop);
        }
        jump
    }
}

impl Hop {
    fn sample(
        way: &Way,
        body: &Body,
        start: f64,
        from: Stance,
        side: f64,
        dice: &mut Dice,
    ) -> Self {
        let size = body.scale.stature;
        let rise = dice.around(way.rise, way.spread) * size;
        let reach = dice.around(way.reach, way.spread) * size;
        let depth = dice.around(way.depth, 0.12) * size;
        let absorb = dice.around(way.absorb, 0.15) * size;
        let (tip, settle) = (way.tip * size, way.settle * size);
        let speed = (2.0 * GRAVITY * rise).sqrt();
        let down = (2.0 * GRAVITY * (rise + tip - settle)).sqrt();
        // Twice the mean speed of a push that starts from rest and ends at take-off speed.
        let push = 1.75 * (depth + tip) / speed;
        let brake = 1.75 * (absorb + settle) / down;
        let lengths = [
            dice.around(way.waits[0], 0.3),
            dice.around(0.50, 0.15),
            push,
            (speed + down) / GRAVITY,
            brake,
            dice.around(0.55, 0.15),
            dice.around(way.waits[1], 0.3),
        ];
        let mut times = [start; 8];
        for (i, length) in lengths.into_iter().enumerate() {
            times[i + 1] = times[i] + length;
        }
        let (take_off, landing) = (times[3], times[4]);
        let crouched = degrees(dice.around(32.0, 0.1));
        let [ahead, back, up] = way.arms;
        let back = degrees(dice.around(back, 0.15));
        let up = degrees(dice.around(up, 0.12));
        let d = degrees;
        // Trunk and head, and the elbows.
        let b = |angle: f64| way.bow * degrees(angle);
        let e = |angle: f64| way.bend * degrees(angle);
        let [land, low] = [55.0, 25.0].map(|angle| way.arms[2] / TEMPLATE.arms[2] * angle);
        // Height, way, pelvis pitch, trunk pitch, arm flexion, abduction, elbow, foot, head.
        let stand = [0.0, 0.0, d(4.0), d(-2.0), d(2.0), 0.0, d(16.0), 0.0, 0.0];
        let ready = [0.0, 0.0, d(4.0), d(-2.0), d(ahead), 0.0, d(16.0), 0.0, 0.0];
        let finish = [0.0, reach, d(4.0), d(-2.0), d(2.0), 0.0, d(16.0), 0.0, 0.0];
        let (out, back_in) = (way.lean_out * size, way.lean_in * size);
        #[rustfmt::skip]
        let keys = [
            (times[0], stand),
            (times[1], ready),
            (
                lerp(times[1], times[2], 0.55),
                [-0.55 * depth, 0.0, 0.6 * way.tilt * crouched, b(10.0), back, d(4.0), e(18.0), 0.0, b(-12.0)],
            ),
            (
                times[2],
                [-depth, 0.02 * size, way.tilt * crouched, b(18.0), way.passing * back, d(8.0), e(20.0), d(5.0), b(-22.0)],
            ),
            (take_off, [tip, out, d(10.0), d(-4.0), up, d(12.0), e(35.0), d(48.0), b(-8.0)]),
            (
                landing,
                [settle, reach - back_in, d(16.0), b(8.0), d(land), d(22.0), e(40.0), d(24.0), b(6.0)],
            ),
            (times[5], [-absorb, reach, d(26.0), b(14.0), d(low), d(18.0), e(35.0), 0.0, b(-12.0)]),
            (times[6], finish),
            (times[7], finish),
        ];
        let mut channels = Timeline::new(&keys);
        channels.pin(3, HEIGHT, 0.0, 0.8 * speed / push);
        channels.pin(4, HEIGHT, speed, -GRAVITY);
        channels.pin(5, HEIGHT, -down, -GRAVITY);
        channels.pin(6, HEIGHT, 0.0, 0.8 * down / brake);
        let along = (reach - out - back_in) / (landing - take_off);
        channels.pin(4, AHEAD, along, 0.0);
        channels.pin(5, AHEAD, along, 0.0);
        let to = Stance {
            place: from.ahead(reach),
            heading: from.heading + side * degrees(way.turn + dice.jitter(10.0)),
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
