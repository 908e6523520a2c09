use super::{
    Choreography,
    script::{Bout, Script, Stance},
};
use crate::{
    body::Body,
    curve::Timeline,
    dice::Dice,
    math::degrees,
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
    stance: Stance,
    throws: Vec<Bout<CHANNELS>>,
}

impl Throw {
    pub(crate) fn new(body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let stance = Stance::new(body, degrees(5.0), dice);
        let sample = |start, dice: &mut Dice| throw(start, stance.size, body.surface, dice);
        let throws = Bout::all(seconds, dice, sample);
        Self { stance, throws }
    }

    fn feet(
        &self,
        body: &Body,
        throw: &Bout<CHANNELS>,
        time: f64,
        c: &[f64; CHANNELS],
    ) -> [FootTarget; 2] {
        let Stance { size, heading, .. } = self.stance;
        let half = 0.12 * size;
        let [out, home] = throw.arcs(time);
        let front_heading = heading + degrees(4.0);
        let mut front = pitched_ankle(
            body,
            self.stance.at(0.60 * size * throw.stride(time), half),
            front_heading,
            c[17],
            if c[17] > 0.0 { Pivot::Ball } else { Pivot::Heel },
        );
        front[2] += size * (0.12 * out + 0.07 * home);
        let rear_heading = heading - degrees(35.0);
        let rear_flat = self.stance.at(0.0, -half);
        let rear = pitched_ankle(body, rear_flat, rear_heading, c[18], Pivot::Ball);
        [
            FootTarget { ankle: front, heading: front_heading, pitch: c[17], toe: 0.0 },
            FootTarget { ankle: rear, heading: rear_heading, pitch: c[18], toe: c[18].max(0.0) },
        ]
    }
}

/// People wait less between throws than the template does, and throw faster.
fn throw(start: f64, size: f64, of_person: bool, dice: &mut Dice) -> Bout<CHANNELS> {
    let [wait, hurry] = if of_person { [0.3, 0.86] } else { [1.0, 1.0] };
    let rest = wait * dice.uniform(0.1, 0.7);
    let pace = hurry * dice.around(1.0, 0.07);
    let mut time = start + rest;
    let vigour = std::array::from_fn(|_| dice.around(1.0, 0.06));
    let script = Script { rows: &SCRIPT, lengths: LENGTHS, size, vigour };
    let mut keys = vec![(start, script.row(0))];
    for key in 0..KEYS {
        keys.push((time, script.row(key)));
        if let Some(length) = PACE_S.get(key) {
            time += pace * dice.around(*length, 0.04);
        }
    }
    let (step, back) = ([keys[2].0, keys[4].0], [keys[8].0, keys[9].0]);
    let aim = degrees(dice.jitter(5.0));
    Bout { start, end: time, aim, channels: Timeline::new(&keys), step, back }
}

impl Choreography for Throw {
    fn posture(&self, body: &Body, time: f64) -> Posture {
        let throw = Bout::of(&self.throws, time);
        let Stance { heading, arms, head, .. } = &self.stance;
        let c = throw.channels.at(time);
        let [x, y] = self.stance.swayed(c[0], c[1], time);
        let right = Arm {
            flexion: c[9] + arms[1].at(time),
            abduction: c[10],
            across: c[11],
            outward: c[12],
            elbow: c[13] + 0.6 * arms[0].at(time),
            pronation: degrees(25.0),
            wrist: 0.15 * (c[13] - degrees(60.0)).min(0.0),
            shrug: 0.12 * c[10],
        };
        let left = Arm {
            flexion: c[14] + arms[0].at(time),
            abduction: c[15],
            across: 0.0,
            outward: degrees(-20.0),
            elbow: c[16] + 0.6 * arms[1].at(time),
            pronation: degrees(25.0),
            wrist: 0.0,
            shrug: 0.10 * c[14].max(0.0),
        };
        Posture {
            pelvis_m: [x, y, body.standing() - 0.012 * body.leg() + c[2]],
            pelvis: Tilt { pitch: c[3], roll: 0.0, yaw: heading + c[4] + throw.aimed(time) },
            trunk: Tilt { pitch: c[5], roll: c[6], yaw: c[7] },
            head: Tilt {
                pitch: -0.5 * c[5] + head[0].at(time),
                roll: 0.0,
                yaw: c[8] + head[1].at(time),
            },
            arms: [left, right],
            feet: self.feet(body, throw, time, &c),
        }
    }
}
