use super::{Choreography, LEAD_S, track::Track};
use crate::{
    body::{Body, SIDE},
    curve::{Timeline, Wobble, ease, hop, lerp},
    dice::Dice,
    math::{TAU, atan2, cos, degrees, sin},
    rig::{Arm, FootTarget, Pivot, Posture, Tilt, pitched_ankle},
};

/// What tells walking from running. Lengths in metres of the template, angles in radians, phases as
/// shares of a cycle (two steps) from a foot's first contact.
#[derive(Clone, Copy)]
pub(crate) struct Style {
    cycles_hz: f64,
    stride: f64,
    radius: f64,
    /// Share of the cycle in which a foot is on the ground.
    stance: f64,
    /// Of the ankle before the pelvis at contact.
    lead: f64,
    /// From the track's middle to a footprint.
    width: f64,
    toe_out: f64,
    /// Of the swinging foot, on top of what its pitch lifts.
    lift: f64,
    /// Pitch of the foot over the cycle, heel up positive.
    pitch: &'static [(f64, [f64; 1])],
    /// Mean height of the pelvis below standing, as a share of the leg.
    crouch: f64,
    bounce: f64,
    /// Phase of the lowest point.
    lowest: f64,
    sway: f64,
    pelvis_turn: f64,
    pelvis_drop: f64,
    pelvis_pitch: f64,
    lean: f64,
    arm_swing: f64,
    arm_mean: f64,
    elbow: f64,
    elbow_swing: f64,
    trunk_turn: f64,
}

pub(crate) const WALK: Style = Style {
    cycles_hz: 0.93,
    stride: 1.38,
    radius: 2.6,
    stance: 0.62,
    lead: 0.31,
    width: 0.065,
    toe_out: degrees(7.0),
    lift: 0.085,
    pitch: &[
        (0.0, [degrees(-20.0)]),
        (0.10, [0.0]),
        (0.34, [0.0]),
        (0.50, [degrees(24.0)]),
        (0.64, [degrees(68.0)]),
        (0.75, [degrees(42.0)]),
        (0.86, [degrees(-2.0)]),
        (0.95, [degrees(-20.0)]),
    ],
    crouch: 0.030,
    bounce: 0.018,
    lowest: 0.05,
    sway: 0.022,
    pelvis_turn: degrees(5.0),
    pelvis_drop: degrees(4.0),
    pelvis_pitch: degrees(5.0),
    lean: degrees(-2.0),
    arm_swing: degrees(22.0),
    arm_mean: degrees(2.0),
    elbow: degrees(24.0),
    elbow_swing: degrees(12.0),
    trunk_turn: degrees(9.0),
};

pub(crate) const RUN: Style = Style {
    cycles_hz: 1.36,
    stride: 2.25,
    radius: 7.0,
    stance: 0.34,
    lead: 0.30,
    width: 0.03,
    toe_out: degrees(6.0),
    lift: 0.20,
    pitch: &[
        (0.0, [degrees(-8.0)]),
        (0.06, [0.0]),
        (0.15, [0.0]),
        (0.34, [degrees(60.0)]),
        (0.45, [degrees(88.0)]),
        (0.70, [degrees(28.0)]),
        (0.90, [degrees(-6.0)]),
    ],
    crouch: 0.055,
    bounce: 0.036,
    lowest: 0.15,
    sway: 0.012,
    pelvis_turn: degrees(8.0),
    pelvis_drop: degrees(5.0),
    pelvis_pitch: degrees(10.0),
    lean: degrees(4.0),
    arm_swing: degrees(32.0),
    arm_mean: degrees(-10.0),
    elbow: degrees(88.0),
    elbow_swing: degrees(16.0),
    trunk_turn: degrees(16.0),
};

impl Style {
    /// The same gait as people of the CMU database go: brisker, with a longer swing in which the knee
    /// bends more.
    pub(crate) fn of_people(&self) -> Self {
        Self {
            cycles_hz: 1.02 * self.cycles_hz,
            stride: 1.05 * self.stride,
            stance: 0.955 * self.stance,
            lift: 1.5 * self.lift,
            crouch: 0.9 * self.crouch,
            ..*self
        }
    }
}

/// One footprint: where the foot stands flat and how it got there.
struct Footfall {
    flat: [f64; 2],
    heading: f64,
    /// Scales pitch and lift of the swing that leads here.
    vigour: f64,
}

/// Walking or running round a track.
pub(crate) struct Gait {
    style: Style,
    size: f64,
    cycles_hz: f64,
    stride: f64,
    track: Track,
    first_cycle: f64,
    pitch: Timeline<1>,
    falls: [Vec<Footfall>; 2],
    cadence: Wobble,
    pace: Wobble,
    swing: [Wobble; 2],
    elbows: [Wobble; 2],
    spread: [Wobble; 2],
    trunk: [Wobble; 3],
    head: [Wobble; 3],
    height: Wobble,
    drift: Wobble,
}

impl Gait {
    pub(crate) fn new(style: Style, body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let size = body.leg() / 0.852;
        let radius = style.radius * size;
        let heading = dice.uniform(0.0, TAU);
        let slow = |dice: &mut Dice, rms: f64| Wobble::new(dice, rms, 0.07, 0.6);
        let mut gait = Self {
            style,
            size,
            // Long legs swing slowly, like pendulums.
            cycles_hz: dice.around(style.cycles_hz, 0.03) / size.sqrt(),
            stride: dice.around(style.stride, 0.03) * size,
            track: Track::new(radius, heading, [0.0; 2]),
            first_cycle: dice.unit(),
            pitch: Timeline::periodic(style.pitch, 1.0),
            falls: [Vec::new(), Vec::new()],
            cadence: Wobble::new(dice, 0.018, 0.05, 0.35),
            pace: Wobble::new(dice, 0.018, 0.05, 0.3),
            swing: [0, 1].map(|_| slow(dice, 0.12)),
            elbows: [0, 1].map(|_| slow(dice, degrees(3.0))),
            spread: [0, 1].map(|_| slow(dice, degrees(1.5))),
            trunk: [0, 1, 2].map(|_| slow(dice, degrees(1.3))),
            head: [4.5, 2.5, 8.0].map(|rms| slow(dice, degrees(rms))),
            height: slow(dice, 0.003),
            drift: slow(dice, 0.012),
        };
        // The take begins anywhere on the track, and there the origin is.
        let start = dice.uniform(0.0, gait.track.lap());
        gait.first_cycle += (start / gait.stride).floor();
        let [x, y] = gait.track.at(gait.progress(gait.cycle(0.0))).place;
        gait.track = Track::new(radius, heading, [-x, -y]);
        gait.place_feet(seconds, dice);
        gait
    }

    /// Cycles since the start; a little faster and slower over time.
    fn cycle(&self, time: f64) -> f64 {
        self.first_cycle + self.cycles_hz * time + self.cadence.at(time)
    }

    /// Arc length of the pelvis along the track in metres.
    fn progress(&self, cycle: f64) -> f64 {
        self.stride * (cycle + self.pace.at(cycle))
    }

    /// Places the footprints step by step, so that a longer walk begins like a shorter one.
    fn place_feet(&mut self, seconds: f64, dice: &mut Dice) {
        let first = self.first_footfall();
        let last = self.cycle(seconds + LEAD_S) + 3.0;
        let mut cycle = first;
        while cycle < last {
            for (foot, side) in SIDE.into_iter().enumerate() {
                let fall = self.footfall(cycle + 0.5 * foot as f64, side, dice);
                self.falls[foot].push(fall);
            }
            cycle += 1.0;
        }
    }

    fn footfall(&self, cycle: f64, side: f64, dice: &mut Dice) -> Footfall {
        let style = &self.style;
        let lead = self.size * (style.lead + dice.jitter(0.012));
        let left = self.size * (side * style.width + dice.jitter(0.010));
        let spot = self.track.at(self.progress(cycle) + lead);
        Footfall {
            flat: spot.beside(0.0, left),
            heading: spot.heading - side * style.toe_out + dice.jitter(degrees(1.5)),
            vigour: dice.around(1.0, 0.05),
        }
    }

    /// Cycle of the left foot's first footprint, before the earliest moment that is asked for.
    fn first_footfall(&self) -> f64 {
        self.cycle(-LEAD_S).floor() - 3.0
    }

    fn foot(&self, body: &Body, foot: usize, cycle: f64) -> FootTarget {
        let since = cycle - 0.5 * foot as f64 - self.first_footfall();
        let phase = since - since.floor();
        let falls = &self.falls[foot];
        // Beyond the footprints that were placed the foot stays on the last one.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = (since.max(0.0) as usize).min(falls.len() - 2);
        let (here, next) = (&falls[index], &falls[index + 1]);
        let stance = self.style.stance;
        let u = (phase - stance) / (1.0 - stance);
        let vigour = lerp(here.vigour, next.vigour, ease(phase));
        let pitch = vigour * self.pitch.at(phase)[0];
        if u <= 0.0 {
            let pivot = if pitch > 0.0 { Pivot::Ball } else { Pivot::Heel };
            let ankle = pitched_ankle(body, here.flat, here.heading, pitch, pivot);
            return FootTarget { ankle, heading: here.heading, pitch, toe: pitch.max(0.0) };
        }
        let share = ease(u);
        let left = pitched_ankle(body, here.flat, here.heading, pitch, Pivot::Ball);
        let reached = pitched_ankle(body, next.flat, next.heading, pitch, Pivot::Heel);
        let mut ankle: [f64; 3] = std::array::from_fn(|a| lerp(left[a], reached[a], share));
        ankle[2] += self.style.lift * self.size * vigour * hop(u);
        let heading = lerp(here.heading, next.heading, share);
        FootTarget { ankle, heading, pitch, toe: pitch.max(0.0) * (1.0 - ease(2.5 * u)) }
    }

    fn arm(&self, arm: usize, time: f64, wave: f64) -> Arm {
        let style = &self.style;
        let swing = style.arm_swing * (1.0 + self.swing[arm].at(time));
        // The elbow bends as the arm comes forward.
        let elbow = style.elbow + style.elbow_swing * wave + self.elbows[arm].at(time);
        Arm {
            flexion: style.arm_mean + swing * wave,
            abduction: degrees(9.0) + self.spread[arm].at(time),
            outward: degrees(-18.0) - degrees(6.0) * wave,
            elbow: elbow.max(degrees(5.0)),
            pronation: degrees(25.0),
            wrist: degrees(4.0),
            shrug: degrees(1.5) * wave,
            across: 0.0,
        }
    }
}

impl Choreography for Gait {
    fn posture(&self, body: &Body, time: f64) -> Posture {
        let style = &self.style;
        let cycle = self.cycle(time);
        let turn = TAU * cycle;
        let step = 2.0 * (turn - TAU * style.lowest);
        let spot = self.track.at(self.progress(cycle));
        let speed = self.stride * self.cycles_hz;
        // A runner leans into the bend until weight and centripetal force balance.
        let bank = -atan2(speed * speed * spot.curvature, 9.81);
        let surge = 0.010 * self.size * sin(step);
        let sway = style.sway * sin(turn + 0.1) + self.drift.at(time);
        let [x, y] = spot.beside(surge, sway * self.size);
        let bounce = -style.bounce * cos(step) + self.height.at(time);
        let z = body.standing() - style.crouch * body.leg() + bounce * self.size;

        let yaw = -style.pelvis_turn * cos(turn);
        let roll = style.pelvis_drop * sin(turn);
        let pitch = style.pelvis_pitch + degrees(1.5) * cos(step - 0.5);
        let [tp, tr, ty] = [0, 1, 2].map(|i| self.trunk[i].at(time));
        let trunk_yaw = (style.trunk_turn) * cos(turn - 0.2) + ty;
        // The right arm goes with the left leg.
        let wave = cos(turn - 0.25);
        let [hp, hr, hy] = [0, 1, 2].map(|i| self.head[i].at(time));
        Posture {
            pelvis_m: [x, y, z],
            pelvis: Tilt { pitch, roll: roll + bank, yaw: spot.heading + yaw },
            trunk: Tilt { pitch: style.lean + tp, roll: -0.8 * roll + tr, yaw: trunk_yaw },
            head: Tilt {
                pitch: hp - 0.6 * (style.lean + style.pelvis_pitch),
                roll: hr - 0.6 * bank,
                // The gaze stays on the track and looks a little into the bend.
                yaw: hy - 0.9 * (trunk_yaw + yaw) + 0.25 * spot.curvature,
            },
            arms: [self.arm(0, time, -wave), self.arm(1, time, wave)],
            feet: [self.foot(body, 0, cycle), self.foot(body, 1, cycle)],
        }
    }
}
