use super::{
    Choreography, LEAD_S,
    steps::{Footprint, Steps},
};
use crate::{
    body::{Body, SIDE},
    curve::{Timeline, Wobble},
    dice::Dice,
    math::{TAU, degrees, sin_cos},
    rig::{Arm, Posture, Tilt},
};

/// Place in metres, heading in radians, sway to the left in metres.
const CHANNELS: usize = 4;

/// Turns on the spot with small steps, sometimes a step ahead, and stands between.
pub(crate) struct Turn {
    feet: [Steps; 2],
    body: Timeline<CHANNELS>,
    sway: [Wobble; 2],
    trunk: [Wobble; 2],
    arms: [Wobble; 2],
    head: [Wobble; 2],
    spread: f64,
}

/// The head looks where the body will face this much later, in seconds, and the chest this much.
const GAZE_S: f64 = 0.34;
const CHEST_S: f64 = 0.14;

impl Turn {
    pub(crate) fn new(body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let size = body.leg() / 0.852;
        let half = dice.around(0.10, 0.1) * size;
        let slow = |dice: &mut Dice, rms: f64| Wobble::new(dice, rms, 0.1, 0.7);
        let sway = [0, 1].map(|_| slow(dice, 0.006 * size));
        let trunk = [0, 1].map(|_| slow(dice, degrees(1.5)));
        let arms = [0, 1].map(|_| slow(dice, degrees(4.0)));
        let head = [0, 1].map(|_| slow(dice, degrees(5.0)));
        let spread = degrees(dice.around(9.0, 0.2));
        let (mut place, mut heading) = ([0.0; 2], dice.uniform(0.0, TAU));
        let mut time = -LEAD_S - dice.uniform(0.2, 2.0);
        let prints = |place: [f64; 2], heading: f64, foot: usize| print(place, heading, half, foot);
        let mut feet = [0, 1].map(|foot| Steps::new(prints(place, heading, foot)));
        let mut keys = vec![(time, [place[0], place[1], heading, 0.0])];
        while time < seconds + LEAD_S {
            time += dice.uniform(0.15, 0.8);
            keys.push((time, [place[0], place[1], heading, 0.0]));
            let angle = dice.sign() * degrees(dice.uniform(50.0, 175.0));
            let ahead = if dice.unit() < 0.4 { dice.uniform(0.1, 0.35) * size } else { 0.0 };
            // Turning left, the left foot opens first.
            let first = usize::from(angle < 0.0);
            let pairs = (angle.abs() / degrees(65.0)).ceil().max(1.0);
            let share = angle / pairs;
            let pace = dice.around(0.42, 0.08) * size.sqrt();
            let mut left = pairs;
            while left > 0.5 {
                let (s, c) = sin_cos(heading + 0.5 * share);
                place = [place[0] + c * ahead / pairs, place[1] + s * ahead / pairs];
                heading += share;
                for (n, foot) in [first, 1 - first].into_iter().enumerate() {
                    let start = time + n as f64 * 0.92 * pace;
                    let lift = dice.around(0.035, 0.15) * size;
                    feet[foot].step(start, start + pace, prints(place, heading, foot), lift);
                    // The weight goes over the foot that stands.
                    let weight = -SIDE[foot] * 0.040 * size;
                    let turned = heading - share * if n == 0 { 0.62 } else { 0.12 };
                    keys.push((start + 0.5 * pace, [place[0], place[1], turned, weight]));
                }
                time += 1.92 * pace;
                left -= 1.0;
            }
            time += 0.2;
            keys.push((time, [place[0], place[1], heading, 0.0]));
        }
        Self { feet, body: Timeline::new(&keys), sway, trunk, arms, head, spread }
    }
}

/// Where a foot stands beside a place.
fn print(place: [f64; 2], heading: f64, half: f64, foot: usize) -> Footprint {
    let (s, c) = sin_cos(heading);
    let left = SIDE[foot] * half;
    Footprint {
        flat: [place[0] - s * left, place[1] + c * left],
        heading: heading - SIDE[foot] * degrees(7.0),
    }
}

impl Choreography for Turn {
    fn posture(&self, body: &Body, time: f64) -> Posture {
        let [x, y, heading, weight] = self.body.at(time);
        let [gaze, chest] = [GAZE_S, CHEST_S].map(|lead| self.body.at(time + lead)[2] - heading);
        let (s, c) = sin_cos(heading);
        let [sway_x, sway_y] = [0, 1].map(|i| self.sway[i].at(time));
        let left = weight + sway_y;
        // Shifting the weight lowers the body a little.
        let dip = 0.010 + 3.0 * weight * weight;
        // Arms lag behind the turning trunk: both swing against it.
        let twirl = self.body.at(time + 0.05)[2] - self.body.at(time - 0.15)[2];
        let arm = |i: usize| Arm {
            flexion: degrees(3.0) + self.arms[i].at(time) + SIDE[i] * 0.35 * twirl,
            abduction: self.spread + 0.12 * twirl.abs(),
            outward: degrees(-18.0),
            elbow: degrees(20.0) + 0.3 * twirl.abs() + 0.5 * self.arms[1 - i].at(time),
            pronation: degrees(25.0),
            wrist: degrees(3.0),
            ..Arm::default()
        };
        let [pitch, roll] = [0, 1].map(|i| self.trunk[i].at(time));
        Posture {
            pelvis_m: [
                x + c * sway_x - s * left,
                y + s * sway_x + c * left,
                body.standing() - dip * body.leg(),
            ],
            pelvis: Tilt { pitch: degrees(5.0), roll: 0.9 * weight, yaw: heading },
            trunk: Tilt {
                pitch: degrees(-2.0) + pitch,
                roll: roll - 1.4 * weight,
                yaw: 0.9 * chest,
            },
            head: Tilt {
                pitch: self.head[0].at(time),
                roll: 0.0,
                yaw: (gaze - 0.9 * chest).clamp(degrees(-65.0), degrees(65.0))
                    + self.head[1].at(time),
            },
            arms: [arm(0), arm(1)],
            feet: [0, 1].map(|foot| self.feet[foot].at(body, time)),
        }
    }
}
