use super::{
    Choreography, LEAD_S,
    footwork::{Footwork, Planner, Walk},
    script::{Bout, Script, Stance},
};
use crate::{
    body::{Body, SIDE},
    curve::{Timeline, ease},
    dice::Dice,
    math::degrees,
    rig::{Arm, FootTarget, Pivot, Posture, Tilt, pitched_ankle},
};

/// Channels of a kick: place of the pelvis (ahead, left, up), the kicking foot (ahead, left, up); pitch, roll and
/// turn of the pelvis and of the trunk; flexion, abduction and bend of the right and the left arm; pitch of the head
/// and of the kicking foot.
const CHANNELS: usize = 20;
const KEYS: usize = 10;
/// The first channels hold lengths; all others hold angles.
const LENGTHS: usize = 6;

/// Metres of the template and degrees, one row a key; the order of columns is that of the channels.
#[rustfmt::skip]
const SCRIPT: [[f64; CHANNELS]; KEYS] = [
    // Stands.
    [0.0, 0.0, 0.0,        0.0, 0.0, 0.0,       4.0, 0.0, 0.0,     -2.0, 0.0, 0.0,    2.0, 9.0, 18.0,    2.0, 9.0, 18.0,    0.0, 0.0],
    // Weight on the right foot; the left one goes ahead.
    [0.02, -0.055, -0.02,  0.0, 0.0, 0.0,       7.0, 2.0, -6.0,     0.0, -2.0, 4.0,   12.0, 14.0, 30.0,  -6.0, 14.0, 24.0,  10.0, 0.0],
    // The left foot lands; the right heel comes off.
    [0.30, 0.010, -0.07,   0.0, 0.0, 0.0,       8.0, 0.0, -14.0,   -2.0, 0.0, 10.0,   -18.0, 22.0, 35.0, 20.0, 50.0, 28.0,  14.0, 42.0],
    // The kicking leg is back, knee bent, the left arm out.
    [0.44, 0.050, -0.06,  -0.02, 0.02, 0.44,    10.0, 3.0, -20.0,  -6.0, -4.0, 16.0,  -34.0, 26.0, 38.0, 26.0, 74.0, 26.0,  22.0, 88.0],
    // Meets the ball.
    [0.55, 0.055, -0.035,  0.76, 0.00, 0.055,   -2.0, -3.0, 8.0,     8.0, 2.0, -6.0,  -12.0, 30.0, 42.0, 34.0, 52.0, 34.0,  26.0, 34.0],
    // Follows through.
    [0.60, 0.050, -0.015,  1.30, 0.06, 0.58,    -10.0, -4.0, 20.0,  20.0, 4.0, -18.0, -22.0, 32.0, 34.0, 50.0, 34.0, 48.0,  10.0, -24.0],
    // The leg comes down.
    [0.60, 0.040, -0.025,  0.86, 0.03, 0.16,     2.0, -2.0, 10.0,    6.0, 2.0, -8.0,  -4.0, 22.0, 30.0,  22.0, 26.0, 36.0,  4.0, 0.0],
    // Both feet side by side.
    [0.56, 0.010, -0.02,   0.60, 0.00, 0.0,      5.0, 0.0, 2.0,     -1.0, 0.0, 0.0,    2.0, 12.0, 22.0,  4.0, 12.0, 22.0,   2.0, 0.0],
    // Steps back, the right foot first.
    [0.34, 0.045, -0.02,   0.28, 0.00, 0.05,     7.0, 2.0, 0.0,      0.0, -2.0, 0.0,   6.0, 11.0, 22.0,  0.0, 11.0, 20.0,   6.0, 16.0],
    [0.10, -0.03, -0.015,  0.0, 0.0, 0.0,        5.0, 0.0, 0.0,     -1.0, 0.0, 0.0,    1.0, 10.0, 19.0,  4.0, 10.0, 20.0,   3.0, 0.0],
];

/// Seconds from each key to the next, and from the last to standing.
const PACE_S: [f64; KEYS] = [0.34, 0.30, 0.17, 0.145, 0.17, 0.33, 0.36, 0.34, 0.32, 0.46];

/// Kicks with the right foot, one after the other: the template's from one spot; people run up a few steps, and walk
/// back.
pub(crate) struct Kick {
    stance: Stance,
    footwork: Footwork,
    kicks: Vec<Bout<CHANNELS>>,
}

impl Kick {
    pub(crate) fn new(body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let stance = Stance::new(body, degrees(4.0), dice);
        let size = stance.size;
        if body.surface {
            let away = [-size * dice.uniform(0.8, 1.8), size * dice.jitter(0.3)];
            let mut planner = Planner::new(size, -2.0 * LEAD_S, away);
            let sample = |start, dice: &mut Dice| run_and_kick(start, size, &mut planner, dice);
            let kicks = Bout::all(seconds, dice, sample);
            return Self { stance, footwork: planner.finish(), kicks };
        }
        let kicks = Bout::all(seconds, dice, |start, dice| {
            let time = start + dice.uniform(0.05, 0.35);
            kick(start, time, size, dice)
        });
        Self { stance, footwork: Footwork::none(), kicks }
    }

    fn feet(
        &self,
        body: &Body,
        kick: &Bout<CHANNELS>,
        time: f64,
        c: &[f64; CHANNELS],
    ) -> [FootTarget; 2] {
        let Stance { size, heading, .. } = self.stance;
        let half = 0.10 * size;
        let stride = 0.56 * size * kick.stride(time);
        let [out, home] = kick.arcs(time);
        let [shift_l, shift_r] = [0, 1].map(|foot| self.footwork.foot(foot, time));
        let pitch = degrees(14.0) * home - degrees(6.0) * out + shift_l.pitch;
        let pivot = if pitch > 0.0 { Pivot::Ball } else { Pivot::Heel };
        let heading_l = heading + degrees(6.0) + shift_l.turn;
        let flat = self.stance.at(stride + shift_l.ahead, half + shift_l.left);
        let mut left = pitched_ankle(body, flat, heading_l, pitch, pivot);
        left[2] += size * (0.09 * out + 0.06 * home) + shift_l.up;
        let heading_r = heading - degrees(8.0) + shift_r.turn;
        // On the floor the foot turns about its ball; in the air the toes do not matter.
        let flat = self.stance.at(c[3] + shift_r.ahead, c[4] + shift_r.left - half);
        let pitch_r = c[19] + shift_r.pitch;
        let mut right = pitched_ankle(body, flat, heading_r, pitch_r.max(0.0), Pivot::Ball);
        right[2] += c[5] + shift_r.up;
        let grounded = 1.0 - ease(c[5] / (0.06 * size));
        [
            FootTarget { ankle: left, heading: heading_l, pitch, toe: 0.0 },
            FootTarget {
                ankle: right,
                heading: heading_r,
                pitch: pitch_r,
                toe: c[19].max(0.0) * grounded,
            },
        ]
    }
}

/// A run-up to the spot, the kick, and the way back to where the next one begins.
fn run_and_kick(start: f64, size: f64, planner: &mut Planner, dice: &mut Dice) -> Bout<CHANNELS> {
    let setting_off = start + dice.uniform(0.3, 1.0);
    let [ahead, left] = planner.at();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let steps = 2 + (ahead.hypot(left) / (0.62 * size)) as usize;
    let pace = dice.around(0.29, 0.08);
    // The right foot lands last, so that the left one can go ahead at once.
    let first = steps % 2;
    let lift = 0.09 * size;
    let there = planner.walk(&Walk { start: setting_off, to: [0.0; 2], steps, first, pace, lift });
    let mut bout = kick(start, there - 0.62 * pace, size, dice);
    let away = [-size * dice.uniform(0.8, 1.8), size * dice.jitter(0.3)];
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let steps = 2 + (-away[0] / (0.45 * size)) as usize;
    let pace = dice.around(0.42, 0.08);
    let lift = 0.05 * size;
    let walk = Walk { start: bout.end + 0.05, to: away, steps, first: 1, pace, lift };
    bout.end = planner.walk(&walk) + 0.2;
    bout
}

fn kick(start: f64, begin: f64, size: f64, dice: &mut Dice) -> Bout<CHANNELS> {
    let mut time = begin;
    let pace = dice.around(0.94, 0.07);
    let vigour = std::array::from_fn(|_| dice.around(1.0, 0.06));
    let script = Script { rows: &SCRIPT, lengths: LENGTHS, size, vigour };
    let mut keys = vec![(start, script.row(0))];
    for (key, length) in PACE_S.into_iter().enumerate() {
        keys.push((time, script.row(key)));
        time += pace * dice.around(length, 0.04);
    }
    keys.push((time, script.row(0)));
    let (step, back) = ([keys[1].0 + 0.1, keys[3].0], [keys[9].0, keys[11].0 - 0.1]);
    let aim = degrees(dice.jitter(5.0));
    Bout { start, end: time, aim, channels: Timeline::new(&keys), step, back }
}

impl Choreography for Kick {
    fn posture(&self, body: &Body, time: f64) -> Posture {
        let kick = Bout::of(&self.kicks, time);
        let Stance { heading, arms, head, .. } = &self.stance;
        let c = kick.channels.at(time);
        let [ahead, to_left, up, turn] = self.footwork.pelvis(time);
        let swing = self.footwork.swing(time);
        let [x, y] = self.stance.swayed(c[0] + ahead, c[1] + to_left, time);
        let arm = |i: usize, from: usize| Arm {
            flexion: c[from] + arms[i].at(time) + SIDE[i] * swing,
            abduction: c[from + 1],
            outward: degrees(-18.0),
            elbow: c[from + 2] + 0.6 * arms[1 - i].at(time),
            pronation: degrees(25.0),
            wrist: degrees(3.0),
            shrug: 0.10 * c[from + 1],
            across: 0.0,
        };
        Posture {
            pelvis_m: [x, y, body.standing() - 0.012 * body.leg() + c[2] + up],
            pelvis: Tilt { pitch: c[6], roll: c[7], yaw: heading + turn + c[8] + kick.aimed(time) },
            trunk: Tilt { pitch: c[9], roll: c[10], yaw: c[11] },
            head: Tilt {
                pitch: c[18] + head[0].at(time),
                roll: 0.0,
                yaw: -0.8 * (c[8] + c[11]) + head[1].at(time),
            },
            arms: [arm(0, 15), arm(1, 12)],
            feet: self.feet(body, kick, time, &c),
        }
    }
}
