use mocap_core::geometry::{distance, sub};

use super::{FINGERS, grip::Grip, pad};
use crate::math::damped;

/// Angles that bring two pads together: bending of the finger's first and second joint (the third follows the
/// second), and the thumb's.
const MOVES: usize = 6;

/// The last joint of a finger cannot bend on its own: it follows the middle one by about this share.
const LAST_FOLLOWS: f64 = 0.55;

/// A grip in which the pads of the thumb and of a finger meet, from one near by: Gauss–Newton with a damping that
/// keeps the fingers near where they were, within the limits of the joints.
pub(crate) fn pinch(start: Grip, finger: usize) -> Grip {
    const ROUNDS: usize = 40;
    const STEP: f64 = 1e-4;
    let mut best = out_of_the_way(start, finger).limited();
    for _ in 0..ROUNDS {
        let apart = gap(&best, finger);
        let columns: [[f64; 3]; MOVES] = std::array::from_fn(|n| {
            let there = gap(&moved(&best, finger, n, STEP), finger);
            sub(there, apart).map(|c| c / STEP)
        });
        let mut next = best;
        for (n, turn) in damped(&columns, apart, 2e-5).into_iter().enumerate() {
            next = moved(&next, finger, n, turn.clamp(-0.3, 0.3));
        }
        let next = next.limited();
        if distance(gap(&next, finger), [0.0; 3]) >= distance(apart, [0.0; 3]) {
            break;
        }
        best = next;
    }
    best
}

/// The fingers that do not pinch stay straighter, so that the thumb finds its way past them.
fn out_of_the_way(mut grip: Grip, finger: usize) -> Grip {
    for other in (0..FINGERS).filter(|&other| other != finger) {
        for (i, share) in [(0, 0.45), (2, 0.5), (3, 0.5)] {
            grip.0[4 * other + i] *= share;
        }
    }
    grip
}

/// From the finger's pad to the thumb's.
pub(super) fn gap(grip: &Grip, finger: usize) -> [f64; 3] {
    sub(pad(grip, FINGERS, 0), pad(grip, finger, 0))
}

fn moved(grip: &Grip, finger: usize, n: usize, turn: f64) -> Grip {
    let mut grip = *grip;
    match n {
        0 => grip.0[4 * finger] += turn,
        1 => {
            grip.0[4 * finger + 2] += turn;
            grip.0[4 * finger + 3] += LAST_FOLLOWS * turn;
        }
        _ => grip.0[4 * FINGERS + n - 2] += turn,
    }
    grip
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap_core::geometry::norm;

    #[test]
    fn pads_meet() {
        for finger in 0..FINGERS {
            let grip = pinch(Grip::PINCH, finger);
            let apart = norm(gap(&grip, finger));
            // Skin yields by a few millimetres; the little finger reaches least.
            assert!(apart < 0.004, "finger {finger}: {apart} m apart, {grip:?}");
            assert_eq!(grip, grip.limited());
        }
    }
}
