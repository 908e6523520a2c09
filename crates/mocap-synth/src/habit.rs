//! How a person moves in their own way, whatever they do.

use crate::{
    curve::Drift,
    dice::Dice,
    math::{degrees, sin_cos},
    rig::{Arm, Posture},
};

/// Angles that a person's postures always differ by, and slow waves on top.
pub(crate) struct Habits {
    /// Of the trunk and the head, ahead.
    lean: f64,
    nod: f64,
    head: [Drift; 2],
    trunk: [Drift; 2],
    /// Left, right.
    arms: [ArmHabit; 2],
    sway: Sway,
}

/// Nobody stands still: the weight wanders between the feet, and everything above follows.
struct Sway {
    /// Ahead and to the left, in metres.
    weight: [Drift; 2],
    /// Pitch, roll and turn of the pelvis, the trunk and the head.
    pelvis: [Drift; 3],
    trunk: [Drift; 3],
    head: [Drift; 3],
    /// Flexion, abduction and bend of either arm.
    arms: [[Drift; 3]; 2],
}

struct ArmHabit {
    elbow: f64,
    abduction: f64,
    wrist: f64,
    pronation: f64,
    /// Of the wrist, of the forearm's turn and of the elbow.
    waves: [Drift; 3],
}

impl Habits {
    pub(crate) fn new(dice: &mut Dice) -> Self {
        // Both arms of a person are much alike.
        let elbow = degrees(6.0 + dice.jitter(7.0));
        let wrist = degrees(10.0 + dice.jitter(7.0));
        let pronation = degrees(dice.jitter(14.0));
        Self {
            lean: degrees(dice.jitter(2.5)),
            nod: degrees(4.0 + dice.jitter(6.0)),
            head: [5.0, 4.0].map(|rms| Drift::new(dice, degrees(rms), 0.05, 0.5)),
            trunk: [1.6, 1.6].map(|rms| Drift::new(dice, degrees(rms), 0.08, 0.6)),
            arms: [0, 1].map(|_| ArmHabit {
                elbow: elbow + degrees(dice.jitter(3.0)),
                abduction: degrees(dice.jitter(3.0)),
                wrist: wrist + degrees(dice.jitter(4.0)),
                pronation: pronation + degrees(dice.jitter(6.0)),
                waves: [6.0, 6.0, 3.0].map(|rms| Drift::new(dice, degrees(rms), 0.1, 1.1)),
            }),
            sway: Sway::new(dice),
        }
    }

    /// Puts them on a posture at a time in seconds.
    pub(crate) fn put_on(&self, posture: &mut Posture, time: f64) {
        let [bend, twist] = [0, 1].map(|i| self.trunk[i].at(time));
        posture.trunk.pitch += self.lean + bend;
        posture.trunk.yaw += twist;
        // The gaze stays where it was.
        posture.head.pitch += self.nod - self.lean - bend + self.head[0].at(time);
        posture.head.yaw += self.head[1].at(time) - twist;
        for (arm, habit) in posture.arms.iter_mut().zip(&self.arms) {
            habit.put_on(arm, time);
        }
        self.sway.put_on(posture, time);
    }
}

impl Sway {
    fn new(dice: &mut Dice) -> Self {
        // Some are more restless than others.
        let unrest = dice.around(1.0, 0.3);
        let mut angles = |rms: [f64; 3], high: f64| {
            rms.map(|rms| Drift::new(dice, unrest * degrees(rms), 0.15, high))
        };
        let pelvis = angles([0.7, 0.5, 0.8], 1.6);
        let trunk = angles([0.8, 0.6, 0.9], 2.0);
        let head = angles([1.2, 0.8, 1.4], 2.5);
        let arms = [0, 1].map(|_| angles([1.6, 0.8, 1.8], 2.5));
        // A few millimetres, most of it slow.
        let weight = [0.005, 0.007].map(|rms| Drift::new(dice, unrest * rms, 0.08, 1.3));
        Self { weight, pelvis, trunk, head, arms }
    }

    fn put_on(&self, posture: &mut Posture, time: f64) {
        let (s, c) = sin_cos(posture.pelvis.yaw);
        let [ahead, left] = [0, 1].map(|i| self.weight[i].at(time));
        posture.pelvis_m[0] += c * ahead - s * left;
        posture.pelvis_m[1] += s * ahead + c * left;
        let parts = [
            (&mut posture.pelvis, &self.pelvis),
            (&mut posture.trunk, &self.trunk),
            (&mut posture.head, &self.head),
        ];
        for (tilt, drifts) in parts {
            tilt.pitch += drifts[0].at(time);
            tilt.roll += drifts[1].at(time);
            tilt.yaw += drifts[2].at(time);
        }
        for (arm, drifts) in posture.arms.iter_mut().zip(&self.arms) {
            arm.flexion += drifts[0].at(time);
            arm.abduction += drifts[1].at(time);
            arm.elbow = (arm.elbow + drifts[2].at(time)).max(degrees(2.0));
        }
    }
}

impl ArmHabit {
    fn put_on(&self, arm: &mut Arm, time: f64) {
        /// An elbow never straightens beyond this, nor bends more than this.
        const ELBOW: [f64; 2] = [degrees(4.0), degrees(145.0)];
        let [wrist, turn, elbow] = [0, 1, 2].map(|i| self.waves[i].at(time));
        arm.elbow = (arm.elbow + self.elbow + elbow).clamp(ELBOW[0], ELBOW[1]);
        arm.abduction += self.abduction;
        arm.wrist += self.wrist + wrist;
        arm.pronation += self.pronation + turn;
    }
}
