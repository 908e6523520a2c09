use super::{Choreography, LEAD_S};
use crate::{
    body::Body,
    curve::{Timeline, Wobble, ease, lerp},
    dice::Dice,
    math::{TAU, degrees, sin_cos},
    rig::{Arm, FootTarget, Pivot, Posture, Tilt, pitched_ankle},
};

/// Channels of a throw: place of the pelvis (ahead, left, up), its pitch and turn; pitch, roll and
/// turn of the trunk; turn of the head; the throwing arm (flexion, abduction, across, outward,
/// elbow); the other arm (flexion, abduction, elbow); pitch of the front and of the rear foot.
const CHANNELS: usize = 19;
const KEYS: usize = 9;

/// Metres of the template and degrees, one row a key; the order of columns is that of the channels.
#[rustfmt::skip]
const SCRIPT: [[f64; CHANNELS]; KEYS] = [
    // Stands at ease.
    [0.0, 0.0, 0.0,   4.0, 0.0,   -2.0, 0.0, 0.0,   0.0,   2.0, 9.0, 0.0, -20.0, 18.0,   2.0, 9.0, 18.0,   0.0,   0.0],
    // Lifts the ball with both hands.
    [-0.01, -0.01, -0.02,   6.0, -12.0,   2.0, 0.0, -8.0,   10.0,   42.0, 12.0, 0.0, -45.0, 100.0,   38.0, 10.0, 85.0,   0.0,   0.0],
    // Turns away over the rear leg; the front foot leaves the floor.
    [-0.05, -0.06, -0.04,   6.0, -38.0,   2.0, 4.0, -22.0,   45.0,   15.0, 45.0, -10.0, -5.0, 95.0,   60.0, 30.0, 40.0,   6.0,   0.0],
    // Strides: the throwing arm goes back and up.
    [0.16, -0.03, -0.10,   6.0, -34.0,   -2.0, 4.0, -28.0,   50.0,   0.0, 82.0, -28.0, 45.0, 85.0,   70.0, 45.0, 20.0,   -6.0,   8.0],
    // The hips turn ahead of the chest; the forearm lags behind.
    [0.29, 0.00, -0.12,   8.0, 2.0,   -6.0, -6.0, -24.0,   16.0,   0.0, 94.0, -14.0, 88.0, 98.0,   55.0, 40.0, 45.0,   0.0,   28.0],
    // Lets go of the ball.
    [0.36, 0.02, -0.10,   16.0, 24.0,   10.0, -12.0, 12.0,   -24.0,   0.0, 100.0, 18.0, 45.0, 28.0,   20.0, 30.0, 80.0,   0.0,   46.0],
    // Follows through across the body.
    [0.42, 0.03, -0.12,   28.0, 34.0,   24.0, -8.0, 24.0,   -34.0,   15.0, 55.0, 62.0, -35.0, 25.0,   -10.0, 22.0, 70.0,   0.0,   58.0],
    // Comes up again.
    [0.28, 0.02, -0.06,   14.0, 16.0,   8.0, -2.0, 8.0,   -10.0,   18.0, 22.0, 20.0, -25.0, 35.0,   5.0, 14.0, 35.0,   0.0,   30.0],
    // Steps back.
    [0.0, 0.0, 0.0,   4.0, 0.0,   -2.0, 0.0, 0.0,   0.0,   2.0, 9.0, 0.0, -20.0, 18.0,   2.0, 9.0, 18.0,   0.0,   0.0],
];

/// Seconds from each key to the next.
const PACE_S: [f64; KEYS - 1] = [0.55, 0.50, 0.45, 0.20, 0.125, 0.28, 0.55, 0.70];

/// The first channels hold lengths; all others hold angles.
const LENGTHS: usize = 3;

/// Overarm throws with the right hand from one spot, one after the other.
pub(crate) struct Throw {
    throws: Vec<Cast>,
    heading: f64,
    size: f64,
    sway: [Wobble; 2],
    arms: [Wobble; 2],
    head: [Wobble; 2],
}

struct Cast {
    start: f64,
    end: f64,
    /// Turn of this throw's direction, in radians.
    aim: f64,
    channels: Timeline<CHANNELS>,
    /// When the front foot swings forward and back.
    step: [f64; 2],
    back: [f64; 2],
}

impl Throw {
    pub(crate) fn new(body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let size = body.leg() / 0.852;
        let slow = |dice: &mut Dice, rms: f64| Wobble::new(dice, rms, 0.1, 0.7);
        let mut throw = Self {
            throws: Vec::new(),
            heading: dice.uniform(0.0, TAU),
            size,
            sway: [0, 1].map(|_| slow(dice, 0.005 * size)),
            arms: [0, 1].map(|_| slow(dice, degrees(3.0))),
            head: [0, 1].map(|_| slow(dice, degrees(5.0))),
        };
        // A take begins somewhere in a throw, never on a fixed pose.
        let mut time = -LEAD_S - dice.uniform(0.0, 2.5);
        while time < seconds + LEAD_S {
            let cast = Cast::sample(time, size, body.surface, dice);
            time = cast.end;
            throw.throws.push(cast);
        }
        throw
    }
}

impl Cast {
    /// People wait less between throws than the template does, and throw faster.
    fn sample(start: f64, size: f64, of_person: bool, dice: &mut Dice) -> Self {
        let [wait, hurry] = if of_person { [0.3, 0.86] } else { [1.0, 1.0] };
        let rest = wait * dice.uniform(0.1, 0.7);
        let pace = hurry * dice.around(1.0, 0.07);
        let mut time = start + rest;
        let vigour: [f64; CHANNELS] = std::array::from_fn(|_| dice.around(1.0, 0.06));
        let mut keys = vec![(start, Self::values(0, size, &vigour))];
        for key in 0..KEYS {
            keys.push((time, Self::values(key, size, &vigour)));
            if let Some(length) = PACE_S.get(key) {
                time += pace * dice.around(*length, 0.04);
            }
        }
        let (step, back) = ([keys[2].0, keys[4].0], [keys[8].0, keys[9].0]);
        let aim = degrees(dice.jitter(5.0));
        Self { start, end: time, aim, channels: Timeline::new(&keys), step, back }
    }

    /// One row of the script for this body, with this throw's vigour in every channel.
    fn values(key: usize, size: f64, vigour: &[f64; CHANNELS]) -> [f64; CHANNELS] {
        let rest = &SCRIPT[0];
        std::array::from_fn(|n| {
            let value = rest[n] + vigour[n] * (SCRIPT[key][n] - rest[n]);
            if n < LENGTHS { value * size } else { degrees(value) }
        })
    }
}

impl Throw {
    /// A point seen from the spot between the feet.
    fn at(&self, ahead: f64, left: f64) -> [f64; 2] {
        let (s, c) = sin_cos(self.heading);
        [c * ahead - s * left, s * ahead + c * left]
    }

    fn feet(&self, body: &Body, cast: &Cast, time: f64, c: &[f64; CHANNELS]) -> [FootTarget; 2] {
        let half = 0.12 * self.size;
        // One arc over the whole step, so that the foot leaves and meets the floor softly.
        let arc = |[from, to]: [f64; 2]| {
            let u = ((time - from) / (to - from)).clamp(0.0, 1.0);
            let v = u * (1.0 - u);
            64.0 * v * v * v
        };
        let lift = self.size * (0.12 * arc(cast.step) + 0.07 * arc(cast.back));
        let front_heading = self.heading + degrees(4.0);
        let mut front = pitched_ankle(
            body,
            self.at(self.stride(cast, time), half),
            front_heading,
            c[17],
            if c[17] > 0.0 { Pivot::Ball } else { Pivot::Heel },
        );
        front[2] += lift;
        let rear_heading = self.heading - degrees(35.0);
        let rear = pitched_ankle(body, self.at(0.0, -half), rear_heading, c[18], Pivot::Ball);
        [
            FootTarget { ankle: front, heading: front_heading, pitch: c[17], toe: 0.0 },
            FootTarget { ankle: rear, heading: rear_heading, pitch: c[18], toe: c[18].max(0.0) },
        ]
    }

    /// How far the front foot stands ahead: forward with the step, back at the end.
    fn stride(&self, cast: &Cast, time: f64) -> f64 {
        let share = |[from, to]: [f64; 2]| ease((time - from) / (to - from));
        0.60 * self.size * (share(cast.step) - share(cast.back))
    }
}

impl Choreography for Throw {
    fn posture(&self, body: &Body, time: f64) -> Posture {
        let index = self.throws.partition_point(|c| c.start <= time).saturating_sub(1);
        let cast = &self.throws[index];
        let c = cast.channels.at(time);
        let busy = ease((time - cast.step[0]) / 0.4) * (1.0 - ease((time - cast.back[0]) / 0.5));
        let aim = lerp(0.0, cast.aim, busy);
        let [sway_x, sway_y] = [0, 1].map(|i| self.sway[i].at(time));
        let [x, y] = self.at(c[0] + sway_x, c[1] + sway_y);
        let right = Arm {
            flexion: c[9] + self.arms[1].at(time),
            abduction: c[10],
            across: c[11],
            outward: c[12],
            elbow: c[13] + 0.6 * self.arms[0].at(time),
            pronation: degrees(25.0),
            wrist: 0.15 * (c[13] - degrees(60.0)).min(0.0),
            shrug: 0.12 * c[10],
        };
        let left = Arm {
            flexion: c[14] + self.arms[0].at(time),
            abduction: c[15],
            across: 0.0,
            outward: degrees(-20.0),
            elbow: c[16] + 0.6 * self.arms[1].at(time),
            pronation: degrees(25.0),
            wrist: 0.0,
            shrug: 0.10 * c[14].max(0.0),
        };
        Posture {
            pelvis_m: [x, y, body.standing() - 0.012 * body.leg() + c[2]],
            pelvis: Tilt { pitch: c[3], roll: 0.0, yaw: self.heading + c[4] + aim },
            trunk: Tilt { pitch: c[5], roll: c[6], yaw: c[7] },
            head: Tilt {
                pitch: -0.5 * c[5] + self.head[0].at(time),
                roll: 0.0,
                yaw: c[8] + self.head[1].at(time),
            },
            arms: [left, right],
            feet: self.feet(body, cast, time, &c),
        }
    }
}
