use super::{
    Choreography, LEAD_S,
    corners::Corners,
    style::Style,
    track::{Spot, Track},
};
use crate::{
    body::{Body, SIDE},
    curve::{Timeline, Wobble, ease, hop, lerp},
    dice::Dice,
    math::{TAU, atan2, cos, degrees, sin},
    rig::{Arm, FootTarget, Pivot, Posture, Tilt, pitched_ankle},
};

/// One footprint: where the foot stands flat and how it got there.
struct Footfall {
    flat: [f64; 2],
    heading: f64,
    /// Scales pitch and lift of the swing that leads here.
    vigour: f64,
}

/// Where a gait leads.
enum Way {
    Oval(Track),
    Corners(Corners),
}

impl Way {
    fn at(&self, s: f64) -> Spot {
        match self {
            Self::Oval(track) => track.at(s),
            Self::Corners(corners) => corners.at(s),
        }
    }

    /// How far someone leans into a bend, over what balances the centripetal force: round a corner, which is over in a
    /// step or two, feet placed aside do most of it.
    fn banked(&self) -> f64 {
        match self {
            Self::Oval(_) => 1.0,
            Self::Corners(_) => 0.35,
        }
    }
}

/// Walking or running round a track or along a path.
pub(crate) struct Gait {
    style: Style,
    size: f64,
    cycles_hz: f64,
    stride: f64,
    track: Way,
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
        let heading = dice.uniform(0.0, TAU);
        let mut gait = Self::unplaced(style, body, heading, dice);
        let track = |origin| Track::new(style.radius * gait.size, heading, origin);
        // The take begins anywhere on the track, and there the origin is.
        let start = dice.uniform(0.0, track([0.0; 2]).lap());
        gait.first_cycle += (start / gait.stride).floor();
        let [x, y] = gait.track.at(gait.progress(gait.cycle(0.0))).place;
        gait.track = Way::Oval(track([-x, -y]));
        gait.place_feet(seconds, dice);
        gait
    }

    /// Someone whose feet are nowhere yet.
    fn unplaced(style: Style, body: &Body, heading: f64, dice: &mut Dice) -> Self {
        let size = body.leg() / 0.852;
        let slow = |dice: &mut Dice, rms: f64| Wobble::new(dice, rms, 0.07, 0.6);
        Self {
            style,
            size,
            // Long legs swing slowly, like pendulums.
            cycles_hz: dice.around(style.cycles_hz, 0.03) / size.sqrt(),
            stride: dice.around(style.stride, 0.03) * size,
            track: Way::Oval(Track::new(style.radius * size, heading, [0.0; 2])),
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
        }
    }

    /// Round corners instead of round a track.
    pub(crate) fn with_corners(style: Style, body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let heading = dice.uniform(0.0, TAU);
        let mut gait = Self::unplaced(style, body, heading, dice);
        gait.first_cycle += dice.uniform(0.0, 3.0);
        // A little farther than the take gets.
        let length = gait.progress(gait.cycle(seconds + LEAD_S)) + 4.0 * gait.stride;
        // Of its own, so that a longer walk begins like a shorter one.
        let path = Corners::new(gait.size, heading, length, &mut dice.fork());
        let [x, y] = path.at(gait.progress(gait.cycle(0.0))).place;
        gait.track = Way::Corners(path.moved([-x, -y]));
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
        let bank = -self.track.banked() * atan2(speed * speed * spot.curvature, 9.81);
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
