//! How a person moves in their own way, whatever they do.

use crate::{
    curve::Wobble,
    dice::Dice,
    math::degrees,
    rig::{Arm, Posture},
};

/// Angles that a person's postures always differ by, and slow waves on top.
pub(crate) struct Habits {
    /// Of the trunk and the head, ahead.
    lean: f64,
    nod: f64,
    head: [Wobble; 2],
    trunk: [Wobble; 2],
    /// Left, right.
    arms: [ArmHabit; 2],
}

struct ArmHabit {
    elbow: f64,
    abduction: f64,
    wrist: f64,
    pronation: f64,
    /// Of the wrist, of the forearm's turn and of the elbow.
    waves: [Wobble; 3],
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
            head: [5.0, 4.0].map(|rms| Wobble::new(dice, degrees(rms), 0.05, 0.5)),
            trunk: [1.6, 1.6].map(|rms| Wobble::new(dice, degrees(rms), 0.08, 0.6)),
            arms: [0, 1].map(|_| ArmHabit {
                elbow: elbow + degrees(dice.jitter(3.0)),
                abduction: degrees(dice.jitter(3.0)),
                wrist: wrist + degrees(dice.jitter(4.0)),
                pronation: pronation + degrees(dice.jitter(6.0)),
                waves: [6.0, 6.0, 3.0].map(|rms| Wobble::new(dice, degrees(rms), 0.1, 1.1)),
            }),
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
