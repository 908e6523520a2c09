use super::{
    Choreography, LEAD_S,
    footwork::{Footwork, Planner, Walk},
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

/// Seconds from each key to the next: the template's, and those of people, who hurry but for the throw itself.
const PACE_S: [f64; KEYS - 1] = [0.55, 0.50, 0.45, 0.20, 0.125, 0.28, 0.55, 0.70];
const PEOPLE_PACE_S: [f64; KEYS - 1] = [0.36, 0.34, 0.32, 0.19, 0.12, 0.26, 0.36, 0.42];

/// The first channels hold lengths; all others hold angles.
const LENGTHS: usize = 3;

/// Both hands up before the body: a ball is about to come.
const READY: [f64; CHANNELS] = [
    0.01, 0.0, -0.03, 8.0, 0.0, 0.0, 0.0, 0.0, 0.0, 24.0, 14.0, 0.0, -40.0, 68.0, 24.0, 14.0, 68.0,
    0.0, 0.0,
];
/// Meets it.
const CATCH: [f64; CHANNELS] = [
    0.04, 0.0, -0.04, 8.0, 0.0, 4.0, 0.0, 0.0, 0.0, 62.0, 16.0, 6.0, -46.0, 56.0, 62.0, 14.0, 56.0,
    0.0, 0.0,
];

/// Picks it up from the floor.
const PICK: [f64; CHANNELS] = [
    -0.02, 0.0, -0.24, 34.0, 0.0, 30.0, 0.0, 0.0, 0.0, 72.0, 6.0, 0.0, -20.0, 18.0, 72.0, 6.0,
    18.0, 0.0, 0.0,
];

/// Overarm throws with the right hand, one after the other: the template's from one spot; people move to where the ball
/// comes, and catch it first.
pub(crate) struct Throw {
    stance: Stance,
    footwork: Footwork,
    throws: Vec<Bout<CHANNELS>>,
}

impl Throw {
    pub(crate) fn new(body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let stance = Stance::new(body, degrees(5.0), dice);
        if body.surface {
            let mut planner = Planner::new(stance.size, -2.0 * LEAD_S, [0.0; 2]);
            let sample =
                |start, dice: &mut Dice| catch_and_throw(start, stance.size, &mut planner, dice);
            let throws = Bout::all(seconds, dice, sample);
            return Self { stance, footwork: planner.finish(), throws };
        }
        let throws = Bout::all(seconds, dice, |start, dice| throw(start, stance.size, dice));
        Self { stance, footwork: Footwork::none(), throws }
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
        let [front_shift, rear_shift] = [0, 1].map(|foot| self.footwork.foot(foot, time));
        let (front_pitch, rear_pitch) = (c[17] + front_shift.pitch, c[18] + rear_shift.pitch);
        let front_heading = heading + degrees(4.0) + front_shift.turn;
        let mut front = pitched_ankle(
            body,
            self.stance
                .at(0.60 * size * throw.stride(time) + front_shift.ahead, half + front_shift.left),
            front_heading,
            front_pitch,
            if front_pitch > 0.0 { Pivot::Ball } else { Pivot::Heel },
        );
        front[2] += size * (0.12 * out + 0.07 * home) + front_shift.up;
        let rear_heading = heading - degrees(35.0) + rear_shift.turn;
        let rear_flat = self.stance.at(rear_shift.ahead, rear_shift.left - half);
        let mut rear = pitched_ankle(body, rear_flat, rear_heading, rear_pitch, Pivot::Ball);
        rear[2] += rear_shift.up;
        [
            FootTarget { ankle: front, heading: front_heading, pitch: front_pitch, toe: 0.0 },
            FootTarget {
                ankle: rear,
                heading: rear_heading,
                pitch: rear_pitch,
                toe: c[18].max(0.0),
            },
        ]
    }
}

fn throw(start: f64, size: f64, dice: &mut Dice) -> Bout<CHANNELS> {
    let rest = dice.uniform(0.1, 0.7);
    let pace = dice.around(1.0, 0.07);
    let vigour = std::array::from_fn(|_| dice.around(1.0, 0.06));
    let script = Script { rows: &SCRIPT, lengths: LENGTHS, size, vigour };
    let keys = vec![(start, script.row(0)), (start + rest, script.row(0))];
    throw_from(keys, PACE_S.map(|length| pace * length), &script, dice)
}

/// Goes on from where the keys end, through the script's rows behind the first.
fn throw_from(
    mut keys: Vec<(f64, [f64; CHANNELS])>,
    pace_s: [f64; KEYS - 1],
    script: &Script<'_, CHANNELS>,
    dice: &mut Dice,
) -> Bout<CHANNELS> {
    let start = keys[0].0;
    let first = keys.len();
    let mut time = keys[first - 1].0;
    for (key, length) in pace_s.into_iter().enumerate() {
        time += dice.around(length, 0.04);
        keys.push((time, script.row(key + 1)));
    }
    let at = |key: usize| keys[first + key - 1].0;
    let (step, back) = ([at(1), at(3)], [at(7), at(8)]);
    let aim = degrees(dice.jitter(5.0));
    Bout { start, end: time, aim, channels: Timeline::new(&keys), step, back }
}

/// A few quick steps to where the ball comes, the catch, and the throw.
fn catch_and_throw(
    start: f64,
    size: f64,
    planner: &mut Planner,
    dice: &mut Dice,
) -> Bout<CHANNELS> {
    let vigour = std::array::from_fn(|_| dice.around(1.0, 0.06));
    let script = Script { rows: &SCRIPT, lengths: LENGTHS, size, vigour };
    let mut keys = vec![(start, script.row(0))];
    let setting_off = start + dice.uniform(0.1, 0.35);
    let to = [size * dice.uniform(-1.5, 1.5), size * dice.uniform(-2.0, 2.0)];
    let from = planner.at();
    let way = (to[0] - from[0]).hypot(to[1] - from[1]) / size;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let steps = 2 + (way / 0.6) as usize;
    // Sideways the near foot goes first.
    let first = usize::from(to[1] < from[1]);
    let pace = dice.around(0.25, 0.12);
    let lift = 0.07 * size;
    let there = planner.walk(&Walk { start: setting_off, to, steps, first, pace, lift });
    // Caught, or picked up where it fell.
    let (ball, hurry) = if dice.unit() < 0.7 { (&CATCH, 0.3) } else { (&PICK, 0.6) };
    let met = there + dice.uniform(0.1, 0.3) + 0.5 * hurry;
    keys.push((setting_off + 0.1, script.of(&READY)));
    keys.push((met - hurry, script.of(&READY)));
    keys.push((met, script.of(ball)));
    let pace = dice.around(1.0, 0.08);
    throw_from(keys, PEOPLE_PACE_S.map(|length| pace * length), &script, dice)
}

impl Choreography for Throw {
    fn posture(&self, body: &Body, time: f64) -> Posture {
        let throw = Bout::of(&self.throws, time);
        let Stance { heading, arms, head, .. } = &self.stance;
        let c = throw.channels.at(time);
        let [ahead, to_left, up, turn] = self.footwork.pelvis(time);
        let [x, y] = self.stance.swayed(c[0] + ahead, c[1] + to_left, time);
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
            pelvis_m: [x, y, body.standing() - 0.012 * body.leg() + c[2] + up],
            pelvis: Tilt { pitch: c[3], roll: 0.0, yaw: heading + turn + c[4] + throw.aimed(time) },
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
