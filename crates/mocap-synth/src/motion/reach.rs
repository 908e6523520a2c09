use mocap_core::{
    Rotation,
    geometry::{add, sub},
};

use super::{
    Choreography, LEAD_S,
    manner::{self, Manner},
    steps::{Footprint, Steps},
};
use crate::{
    body::{ARMS, Body, SIDE},
    curve::{Timeline, Wobble},
    dice::Dice,
    math::{TAU, atan2, damped, degrees, sin_cos},
    rig::{self, Arm, FootTarget, Frames, Posture, Tilt},
};

/// Channels of the trunk: place of the pelvis (ahead, left, up), its pitch and turn; pitch, roll and turn of the
/// trunk; pitch and turn of the head.
const TRUNK: usize = 10;
/// Channels of an arm: flexion, abduction, across, outward, elbow, wrist.
const ARM: usize = 6;

/// Standing, a hand goes out to something, stays, brings it to the chest or lets it be, and comes back.
pub(crate) struct Reach {
    heading: f64,
    feet: [Steps; 2],
    trunk: Timeline<TRUNK>,
    arms: [Timeline<ARM>; 2],
    sway: [Wobble; 2],
    idle: [Wobble; 4],
    head: [Wobble; 2],
}

const STAND: [f64; TRUNK] = [0.0, 0.0, 0.0, degrees(4.0), 0.0, degrees(-2.0), 0.0, 0.0, 0.0, 0.0];
const HANG: [f64; ARM] =
    [degrees(2.0), degrees(9.0), 0.0, degrees(-20.0), degrees(18.0), degrees(3.0)];
/// Something in the hand is looked at before the chest.
const CHEST: [f64; ARM] =
    [degrees(24.0), degrees(14.0), degrees(8.0), degrees(-42.0), degrees(104.0), degrees(4.0)];

/// Or brought to the mouth.
const MOUTH: [f64; ARM] =
    [degrees(44.0), degrees(20.0), degrees(4.0), degrees(-38.0), degrees(122.0), degrees(2.0)];

/// Where something is, seen from the middle of the feet, in metres: ahead, left, up.
struct Goal {
    place: [f64; 3],
    arms: [bool; 2],
    /// Length of a step toward it.
    step: f64,
}

impl Goal {
    fn sample(size: f64, manner: &Manner, dice: &mut Dice) -> Self {
        let both = dice.unit() < 0.3;
        let side = usize::from(dice.unit() < 0.6);
        let arms = if both { [true; 2] } else { [side == 0, side == 1] };
        // Tables and shelves more often than floors and ceilings.
        let up = match dice.unit() {
            u if u < manner.low => dice.uniform(0.12, 0.75),
            u if u < manner.low + manner.middle => dice.uniform(0.85, 1.35),
            _ => dice.uniform(1.45, 1.95),
        };
        let step = if dice.unit() < manner.steps {
            dice.uniform(manner.step[0], manner.step[1])
        } else {
            0.0
        };
        let ahead = dice.uniform(0.42, 0.72) + 0.9 * step;
        let azimuth = if both { dice.jitter(0.15) } else { SIDE[side] * dice.uniform(-0.35, 0.75) };
        let (s, c) = sin_cos(azimuth);
        let place = [size * ahead * c, size * ahead * s, size * up];
        Self { place, arms, step: size * step }
    }
}

/// What one reach asks of the trunk and the arms.
struct Plan {
    trunk: [f64; TRUNK],
    arms: [[f64; ARM]; 2],
}

impl Plan {
    fn new(body: &Body, goal: &Goal, manner: &Manner) -> Self {
        let size = body.leg() / 0.852;
        let shoulder = 1.43 * size;
        let [ahead, left, up] = goal.place;
        let far = ((ahead - goal.step).hypot(left) / size - 0.55).clamp(0.0, 0.4);
        let low = ((shoulder - 0.30 * size - up) / size).clamp(0.0, 1.0);
        let high = ((up - shoulder) / size).clamp(0.0, 0.5);
        let azimuth = atan2(left, ahead);
        let one = goal.arms[0] != goal.arms[1];
        // With one hand the shoulder comes forward; with two the trunk stays square.
        let side = if goal.arms[0] { 1.0 } else { -1.0 };
        let turn = if one { 0.55 * azimuth - side * (0.12 + 0.5 * far) } else { 0.7 * azimuth };
        let squat = manner.squat * 0.30 * low * size;
        let bend = manner.bend * low + degrees(38.0) * far - degrees(12.0) * high;
        let hips_back = -0.11 * low * size;
        let trunk = [
            manner.along * goal.step + 0.04 * far * size + hips_back,
            0.25 * left,
            -squat - 0.015 * size,
            degrees(4.0) + (1.0 - manner.trunk) * bend,
            0.4 * turn,
            degrees(-2.0) + manner.trunk * bend,
            if one { -side * 0.18 * high } else { 0.0 },
            0.6 * turn,
            // The eyes are on it.
            (0.45 * low - 0.55 * high) - 0.35 * bend,
            0.8 * azimuth - turn,
        ];
        let arms =
            [0, 1].map(|i| if goal.arms[i] { arm(body, goal, &trunk, i) } else { resting(bend) });
        Self { trunk, arms }
    }
}

/// An arm that is not needed hangs from the bent trunk.
fn resting(bend: f64) -> [f64; ARM] {
    let mut angles = HANG;
    angles[0] += 0.7 * bend.max(0.0);
    angles[1] += degrees(6.0);
    angles
}

/// The angles that bring a hand to the goal, found on the body itself: Gauss–Newton over flexion, across and elbow.
fn arm(body: &Body, goal: &Goal, trunk: &[f64; TRUNK], i: usize) -> [f64; ARM] {
    const ROUNDS: usize = 12;
    const STEP: f64 = 1e-4;
    /// The angles that move, with their limits.
    const MOVES: [(usize, [f64; 2]); 3] = [
        (0, [degrees(-30.0), degrees(150.0)]),
        (2, [degrees(-50.0), degrees(45.0)]),
        (4, [degrees(8.0), degrees(140.0)]),
    ];
    let size = body.scale.stature;
    // Two hands hold a thing at its sides.
    let aside = if goal.arms[0] && goal.arms[1] { SIDE[i] * 0.13 * size } else { 0.0 };
    let target = add(goal.place, [0.0, aside, 0.0]);
    let mut frames = Frames::new(body);
    let mut miss = |angles: &[f64; ARM]| {
        let mut arms = [Arm::default(); 2];
        arms[i] = posed(angles, 0.0, 0.0);
        let posture = standing(body, trunk, arms);
        let mut pose = rig::pose(body, &posture);
        pose.rotations.resize(body.skeleton.joints().len(), Rotation::IDENTITY);
        frames.set(body, &pose);
        // The fingers' roots are this far from the wrist.
        let hand = frames.placed[ARMS[i][3]].point([0.0, 0.0, -0.08 * size]);
        sub(hand, target)
    };
    let mut angles =
        [degrees(60.0), degrees(10.0), 0.0, degrees(-12.0), degrees(50.0), degrees(-4.0)];
    for _ in 0..ROUNDS {
        let apart = miss(&angles);
        let columns = MOVES.map(|(n, _)| {
            let mut nearby = angles;
            nearby[n] += STEP;
            sub(miss(&nearby), apart).map(|c| c / STEP)
        });
        for ((n, [low, high]), turn) in MOVES.into_iter().zip(damped(&columns, apart, 4e-3)) {
            angles[n] = (angles[n] + turn.clamp(-0.4, 0.4)).clamp(low, high);
        }
    }
    angles
}

fn posed(angles: &[f64; ARM], flexes: f64, bends: f64) -> Arm {
    let [flexion, abduction, across, outward, elbow, wrist] = *angles;
    Arm {
        flexion: flexion + flexes,
        abduction,
        across,
        outward,
        elbow: (elbow + bends).max(degrees(3.0)),
        pronation: degrees(25.0),
        wrist,
        shrug: 0.10 * flexion.max(0.0),
    }
}

/// The trunk as its channels say, facing ahead over feet that stand side by side.
fn standing(body: &Body, c: &[f64; TRUNK], arms: [Arm; 2]) -> Posture {
    let foot = |side: f64| FootTarget {
        ankle: [0.0, 0.1 * side, body.foot.height],
        ..FootTarget::default()
    };
    Posture {
        pelvis_m: [c[0], c[1], body.standing() - 0.010 * body.leg() + c[2]],
        pelvis: Tilt { pitch: c[3], roll: 0.0, yaw: c[4] },
        trunk: Tilt { pitch: c[5], roll: c[6], yaw: c[7] },
        head: Tilt { pitch: c[8], roll: 0.0, yaw: c[9] },
        arms,
        feet: SIDE.map(foot),
    }
}

impl Reach {
    pub(crate) fn new(body: &Body, seconds: f64, dice: &mut Dice) -> Self {
        let size = body.leg() / 0.852;
        let half = 0.12 * size;
        let heading = dice.uniform(0.0, TAU);
        let slow = |dice: &mut Dice, rms: f64| Wobble::new(dice, rms, 0.1, 0.7);
        let sway = [0, 1].map(|_| slow(dice, 0.006 * size));
        let idle = [0, 1, 2, 3].map(|_| slow(dice, degrees(2.5)));
        let head = [0, 1].map(|_| slow(dice, degrees(4.0)));
        let manner = if body.surface { Manner::of_person(dice) } else { manner::TEMPLATE };
        let print = |ahead: f64, foot: usize| footprint(heading, ahead, half, foot);
        let mut feet = [0, 1].map(|foot| Steps::new(print(0.0, foot)));
        let mut time = -LEAD_S - dice.uniform(0.2, 2.0);
        let mut trunk = vec![(time, STAND)];
        let mut arms = [vec![(time, HANG)], vec![(time, HANG)]];
        while time < seconds + LEAD_S {
            let goal = Goal::sample(size, &manner, dice);
            let plan = Plan::new(body, &goal, &manner);
            let go = manner.slow * dice.around(0.78, 0.15) + 0.25 * goal.step / size;
            let hold = dice.uniform(0.08, 0.35);
            let rest = dice.uniform(0.03, 0.3);
            let start = time + rest;
            let (there, leave) = (start + go, start + go + hold);
            let fetched = leave + manner.slow * dice.around(0.6, 0.15);
            let home = manner.slow * dice.around(0.75, 0.12);
            let fetch = dice.unit() < 0.6;
            let hold_s =
                if fetch && manner.holds > 0.0 { dice.uniform(0.1, manner.holds) } else { 0.0 };
            let back = fetched + hold_s + home;
            trunk.extend([(start, STAND), (there, plan.trunk), (leave, plan.trunk)]);
            let mut upright = STAND;
            upright[0] = 0.4 * plan.trunk[0];
            upright[8] = degrees(if fetch { 14.0 } else { 0.0 });
            trunk.push((fetched, upright));
            if hold_s > 0.0 {
                trunk.push((fetched + hold_s, upright));
            }
            trunk.push((back, STAND));
            for (i, keys) in arms.iter_mut().enumerate() {
                let lag = dice.uniform(0.0, 0.05);
                let late = |t: f64| t + lag;
                let mut nudge = |mut angles: [f64; ARM]| {
                    for angle in &mut angles {
                        *angle += degrees(dice.jitter(1.5));
                    }
                    angles
                };
                keys.extend([(late(start), HANG), (late(there), nudge(plan.arms[i]))]);
                keys.push((late(leave), nudge(plan.arms[i])));
                let after = if fetch && goal.arms[i] { CHEST } else { HANG };
                keys.push((late(fetched), nudge(after)));
                if hold_s > 0.0 && goal.arms[i] {
                    if hold_s > 0.6 {
                        // Looked at closely, or drunk from.
                        keys.push((late(fetched + 0.5 * hold_s), nudge(MOUTH)));
                    }
                    keys.push((late(fetched + hold_s), nudge(CHEST)));
                }
                keys.push((late(back), HANG));
            }
            if goal.step > 0.0 {
                // The foot on the side of the hand, or the left one.
                let foot = usize::from(!goal.arms[0]);
                feet[foot].step(start, start + 0.62 * go, print(goal.step, foot), 0.05 * size);
                // Behind a long step the other foot follows.
                let other = goal.step - 0.3 * size;
                let follows = manner.along > 0.7 && other > 0.1 * size;
                if follows {
                    let time = start + 0.5 * go;
                    feet[1 - foot].step(time, start + go, print(other, 1 - foot), 0.04 * size);
                    let time = fetched + hold_s;
                    feet[1 - foot].step(time, time + 0.5, print(0.0, 1 - foot), 0.04 * size);
                }
                let leave = fetched - 0.1;
                feet[foot].step(leave, leave + 0.55, print(0.0, foot), 0.04 * size);
            }
            time = back + 0.06;
        }
        Self {
            heading,
            feet,
            trunk: Timeline::new(&trunk),
            arms: arms.map(|keys| Timeline::new(&keys)),
            sway,
            idle,
            head,
        }
    }

    fn arm(&self, i: usize, time: f64) -> Arm {
        let bends = 0.6 * self.idle[2 + i].at(time);
        posed(&self.arms[i].at(time), self.idle[i].at(time), bends)
    }
}

fn footprint(heading: f64, ahead: f64, half: f64, foot: usize) -> Footprint {
    let (s, c) = sin_cos(heading);
    let left = SIDE[foot] * half;
    Footprint {
        flat: [c * ahead - s * left, s * ahead + c * left],
        heading: heading - SIDE[foot] * degrees(8.0),
    }
}

impl Choreography for Reach {
    fn posture(&self, body: &Body, time: f64) -> Posture {
        let c = self.trunk.at(time);
        let [sway_x, sway_y] = [0, 1].map(|i| self.sway[i].at(time));
        let (s, co) = sin_cos(self.heading);
        let (ahead, left) = (c[0] + sway_x, c[1] + sway_y);
        let mut posture = standing(body, &c, [self.arm(0, time), self.arm(1, time)]);
        posture.pelvis_m[0] = co * ahead - s * left;
        posture.pelvis_m[1] = s * ahead + co * left;
        posture.pelvis.yaw += self.heading;
        posture.trunk.roll -= 1.2 * sway_y;
        posture.head.pitch += self.head[0].at(time);
        posture.head.yaw += self.head[1].at(time);
        posture.feet = [0, 1].map(|foot| self.feet[foot].at(body, time));
        posture
    }
}
