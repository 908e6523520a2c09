use crate::math::degrees;

use super::FINGERS;

/// Angles of a hand: four of each finger and of the thumb.
pub(crate) const ANGLES: usize = 4 * (FINGERS + 1);

/// Angles of one hand in radians, finger by finger in the order of the joints, the thumb last: bending of the
/// first joint, its spreading, bending of the second and the third joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Grip(pub(crate) [f64; ANGLES]);

/// An angle of a finger's joint and how far it goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FingerAngle {
    /// Name of the joint without its side: `index1`.
    pub joint: &'static str,
    /// Whether it is the spreading of the joint rather than its bending.
    pub spreads: bool,
    /// Least and largest angle in radians.
    pub limits: [f64; 2],
}

const NAMES: [[&str; 3]; FINGERS + 1] = [
    ["index1", "index2", "index3"],
    ["middle1", "middle2", "middle3"],
    ["pinky1", "pinky2", "pinky3"],
    ["ring1", "ring2", "ring3"],
    ["thumb1", "thumb2", "thumb3"],
];

/// Ranges of a finger's and the thumb's angles in degrees, after the active ranges of [AAOS65]; the sideways
/// range of the knuckles is that of an open hand.
const FINGER: [[f64; 2]; 4] = [[-30.0, 90.0], [-20.0, 20.0], [0.0, 105.0], [0.0, 80.0]];
const THUMB: [[f64; 2]; 4] = [[-20.0, 50.0], [-10.0, 60.0], [-5.0, 60.0], [-15.0, 80.0]];

/// The angles of a hand with their limits, in the order in which the generator holds them.
pub fn finger_angles() -> impl Iterator<Item = FingerAngle> {
    (0..ANGLES).map(|n| FingerAngle {
        joint: NAMES[n / 4][[0, 0, 1, 2][n % 4]],
        spreads: n % 4 == 1,
        limits: limits(n),
    })
}

fn limits(n: usize) -> [f64; 2] {
    let table = if n / 4 == FINGERS { &THUMB } else { &FINGER };
    table[n % 4].map(degrees)
}

/// Index, middle, little, ring finger and thumb in degrees.
const fn grip(fingers: [[f64; 4]; FINGERS + 1]) -> Grip {
    let mut angles = [0.0; ANGLES];
    let mut n = 0;
    while n < ANGLES {
        angles[n] = degrees(fingers[n / 4][n % 4]);
        n += 1;
    }
    Grip(angles)
}

#[rustfmt::skip]
impl Grip {
    /// A hand that hangs.
    pub(crate) const REST: Self = grip([
        [22.0, 1.0, 26.0, 14.0], [26.0, 0.0, 30.0, 16.0], [30.0, -5.0, 32.0, 18.0], [28.0, -2.0, 32.0, 17.0],
        [8.0, 12.0, 12.0, 14.0],
    ]);
    /// Spread wide.
    pub(crate) const OPEN: Self = grip([
        [-4.0, 9.0, 4.0, 3.0], [-3.0, 1.0, 4.0, 3.0], [-4.0, -15.0, 5.0, 3.0], [-3.0, -6.0, 5.0, 3.0],
        [-12.0, 30.0, 2.0, 0.0],
    ]);
    /// Ready to close round something.
    pub(crate) const READY: Self = grip([
        [12.0, 6.0, 24.0, 12.0], [12.0, 0.0, 26.0, 13.0], [12.0, -10.0, 26.0, 13.0], [12.0, -4.0, 26.0, 13.0],
        [-2.0, 42.0, 8.0, 8.0],
    ]);
    /// A fist round a rod.
    pub(crate) const POWER: Self = grip([
        [62.0, 1.0, 82.0, 44.0], [66.0, 0.0, 84.0, 46.0], [74.0, -6.0, 76.0, 42.0], [70.0, -3.0, 82.0, 46.0],
        [30.0, 44.0, 28.0, 42.0],
    ]);
    /// Round a bottle.
    const CYLINDER: Self = grip([
        [34.0, 4.0, 46.0, 24.0], [38.0, 0.0, 48.0, 25.0], [42.0, -8.0, 46.0, 24.0], [40.0, -3.0, 48.0, 25.0],
        [16.0, 50.0, 18.0, 22.0],
    ]);
    /// Round a ball.
    const SPHERE: Self = grip([
        [28.0, 12.0, 36.0, 22.0], [28.0, 1.0, 38.0, 22.0], [34.0, -17.0, 36.0, 22.0], [30.0, -7.0, 38.0, 22.0],
        [10.0, 46.0, 16.0, 24.0],
    ]);
    /// Carries a bag.
    const HOOK: Self = grip([
        [18.0, 1.0, 84.0, 46.0], [16.0, 0.0, 88.0, 48.0], [20.0, -5.0, 80.0, 42.0], [18.0, -2.0, 86.0, 46.0],
        [4.0, 14.0, 12.0, 12.0],
    ]);
    /// Points at something.
    const POINT: Self = grip([
        [4.0, 2.0, 6.0, 4.0], [62.0, 0.0, 78.0, 42.0], [72.0, -5.0, 74.0, 40.0], [68.0, -2.0, 80.0, 44.0],
        [22.0, 46.0, 22.0, 30.0],
    ]);
    /// Turns a key: the thumb's pad on the side of the index finger.
    const KEY: Self = grip([
        [48.0, 0.0, 62.0, 32.0], [56.0, 0.0, 66.0, 34.0], [66.0, -5.0, 66.0, 34.0], [62.0, -2.0, 68.0, 36.0],
        [22.0, 22.0, 12.0, 8.0],
    ]);
    /// From where a pinch of the thumb and a finger closes.
    pub(crate) const PINCH: Self = grip([
        [46.0, 2.0, 42.0, 22.0], [44.0, 0.0, 42.0, 22.0], [36.0, -10.0, 30.0, 18.0], [40.0, -4.0, 38.0, 22.0],
        [18.0, 48.0, 18.0, 20.0],
    ]);
    /// Grasps that a hand closes into.
    pub(crate) const GRASPS: [Self; 6] =
        [Self::POWER, Self::CYLINDER, Self::SPHERE, Self::HOOK, Self::POINT, Self::KEY];
}

impl Grip {
    /// Bending and spreading of the first joint, bending of the others.
    pub(crate) fn finger(&self, finger: usize) -> [f64; 4] {
        std::array::from_fn(|i| self.0[4 * finger + i])
    }

    /// The nearest grip within the limits of the joints.
    pub(crate) fn limited(mut self) -> Self {
        for (n, angle) in self.0.iter_mut().enumerate() {
            let [low, high] = limits(n);
            *angle = angle.clamp(low, high);
        }
        self
    }

    /// Moved along the two synergies that explain most of how hands grasp: all joints closing together, and
    /// knuckles straightening while the others bend.
    ///
    /// Source: [Santello98], whose first two principal components take up over four fifths of the variance;
    /// the coefficients here are round numbers of their kind.
    pub(crate) fn along_synergies(mut self, closing: f64, hooking: f64) -> Self {
        const CLOSING: [f64; 4] = [0.60, -0.08, 0.75, 0.45];
        const HOOKING: [f64; 4] = [-0.55, 0.05, 0.65, 0.35];
        const THUMB_CLOSING: [f64; 4] = [0.30, 0.15, 0.35, 0.45];
        for finger in 0..FINGERS {
            for i in 0..4 {
                self.0[4 * finger + i] += closing * CLOSING[i] + hooking * HOOKING[i];
            }
        }
        for (i, share) in THUMB_CLOSING.iter().enumerate() {
            self.0[4 * FINGERS + i] += closing * share;
        }
        self.limited()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_grasp_is_within_the_limits() {
        let all = [Grip::REST, Grip::OPEN, Grip::READY, Grip::PINCH];
        for grip in Grip::GRASPS.into_iter().chain(all) {
            assert_eq!(grip, grip.limited());
        }
        assert_eq!(finger_angles().count(), ANGLES);
    }
}
