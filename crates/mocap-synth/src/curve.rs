use crate::{
    dice::Dice,
    math::{TAU, exp, ln, sin},
};

/// From 0 to 1 with velocity and acceleration zero at both ends; constant outside of `[0, 1]`.
pub(crate) fn ease(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

/// From 0 over 1, at u = 0.43, back to 0, with velocity and acceleration zero at both ends.
pub(crate) fn hop(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    let v = 1.0 - u;
    HOP * (u * u * u) * (v * v * v * v)
}

/// 7⁷ / (3³ · 4⁴), the inverse of the peak of u³(1 − u)⁴.
const HOP: f64 = 823_543.0 / 6_912.0;

pub(crate) fn lerp(a: f64, b: f64, share: f64) -> f64 {
    a + share * (b - a)
}

/// A slow random function of time: a sum of three waves of incommensurate frequencies.
pub(crate) struct Wobble {
    waves: [Wave; 3],
}

struct Wave {
    amplitude: f64,
    pulsation: f64,
    phase: f64,
}

impl Wobble {
    /// Zero mean, `deviation` RMS, frequencies between `low` and `high` per unit of the argument.
    pub(crate) fn new(dice: &mut Dice, deviation: f64, low: f64, high: f64) -> Self {
        // Three waves of amplitude a have variance 3 a² / 2.
        let amplitude = deviation * (2.0_f64 / 3.0).sqrt();
        Self {
            waves: std::array::from_fn(|_| Wave {
                amplitude,
                pulsation: TAU * dice.uniform(low, high),
                phase: dice.uniform(0.0, TAU),
            }),
        }
    }

    pub(crate) fn at(&self, x: f64) -> f64 {
        self.waves.iter().map(|w| w.amplitude * sin(w.pulsation * x + w.phase)).sum()
    }
}

/// A restless random function of time: waves whose heights fall as their frequencies rise, as in the sway of someone who
/// stands. Made for many at once: its sine costs a fifth of libm's.
pub(crate) struct Drift {
    waves: [Wave; 4],
}

impl Drift {
    /// Zero mean, `deviation` RMS, frequencies from `low` to `high` Hz, spaced evenly in their logarithm.
    pub(crate) fn new(dice: &mut Dice, deviation: f64, low: f64, high: f64) -> Self {
        let span = ln(high / low);
        let frequencies: [f64; 4] =
            std::array::from_fn(|k| low * exp(span * 0.25 * (k as f64 + dice.unit())));
        // Half the sum of the squares is the variance.
        let power: f64 = frequencies.iter().map(|f| 0.5 / f).sum();
        let height = deviation / power.sqrt();
        Self {
            waves: frequencies.map(|hz| Wave {
                amplitude: height / hz.sqrt(),
                pulsation: hz,
                phase: dice.unit(),
            }),
        }
    }

    pub(crate) fn at(&self, seconds: f64) -> f64 {
        self.waves.iter().map(|w| w.amplitude * sine(w.pulsation * seconds + w.phase)).sum()
    }
}

/// The sine of so many turns, off by less than 6e-8.
fn sine(turns: f64) -> f64 {
    /// Taylor's series up to the eleventh power.
    const C: [f64; 6] = [
        TAU,
        -41.341_702_240_399_76,
        81.605_249_276_075_05,
        -76.705_859_753_061_39,
        42.058_693_944_897_65,
        -15.094_642_576_822_99,
    ];
    let x = turns - turns.round();
    // Folded at the crests.
    let x = if x.abs() > 0.25 { 0.5_f64.copysign(x) - x } else { x };
    let y = x * x;
    x * (C[0] + y * (C[1] + y * (C[2] + y * (C[3] + y * (C[4] + y * C[5])))))
}

/// Position, velocity and acceleration of N channels at a moment.
struct Knot<const N: usize> {
    time: f64,
    x: [f64; N],
    v: [f64; N],
    a: [f64; N],
}

/// N channels over time, twice continuously differentiable: quintic Hermite pieces between knots.
pub(crate) struct Timeline<const N: usize> {
    knots: Vec<Knot<N>>,
}

impl<const N: usize> Timeline<N> {
    /// Takes `(time, values)` with rising times; velocities follow from the neighbours and vanish
    /// at turning points, so that a channel stays between its keys.
    pub(crate) fn new(keys: &[(f64, [f64; N])]) -> Self {
        let slope = |i: usize, n: usize| {
            let ((s, x), (t, y)) = (keys[i], keys[i + 1]);
            (y[n] - x[n]) / (t - s)
        };
        let velocity = |i: usize, n: usize| {
            if i == 0 || i + 1 == keys.len() {
                return 0.0;
            }
            let (before, after) = (slope(i - 1, n), slope(i, n));
            if before * after <= 0.0 { 0.0 } else { 2.0 * before * after / (before + after) }
        };
        let knots = keys.iter().enumerate().map(|(i, &(time, x))| Knot {
            time,
            x,
            v: std::array::from_fn(|n| velocity(i, n)),
            a: [0.0; N],
        });
        Self { knots: knots.collect() }
    }

    /// Keys of one period, repeated so that the curve closes smoothly over `[0, period]`.
    pub(crate) fn periodic(keys: &[(f64, [f64; N])], period: f64) -> Self {
        let shifted = |turns: f64| keys.iter().map(move |&(t, x)| (t + turns * period, x));
        let all: Vec<_> = shifted(-1.0).chain(shifted(0.0)).chain(shifted(1.0)).collect();
        Self::new(&all)
    }

    /// Sets velocity and acceleration of one channel at one knot.
    pub(crate) fn pin(&mut self, knot: usize, channel: usize, velocity: f64, acceleration: f64) {
        self.knots[knot].v[channel] = velocity;
        self.knots[knot].a[channel] = acceleration;
    }

    /// The channels at a time; before the first and after the last knot they stand still.
    pub(crate) fn at(&self, time: f64) -> [f64; N] {
        let after = self.knots.partition_point(|k| k.time <= time);
        match (after.checked_sub(1).map(|i| &self.knots[i]), self.knots.get(after)) {
            (Some(k), Some(l)) => between(k, l, time),
            (Some(k), None) | (None, Some(k)) => k.x,
            (None, None) => [0.0; N],
        }
    }
}

fn between<const N: usize>(k: &Knot<N>, l: &Knot<N>, time: f64) -> [f64; N] {
    let h = l.time - k.time;
    let u = (time - k.time) / h;
    let (u2, u3) = (u * u, u * u * u);
    let (u4, u5) = (u2 * u2, u2 * u3);
    let x1 = 10.0 * u3 - 15.0 * u4 + 6.0 * u5;
    let v0 = h * (u - 6.0 * u3 + 8.0 * u4 - 3.0 * u5);
    let v1 = h * (-4.0 * u3 + 7.0 * u4 - 3.0 * u5);
    let a0 = 0.5 * h * h * (u2 - 3.0 * u3 + 3.0 * u4 - u5);
    let a1 = 0.5 * h * h * (u3 - 2.0 * u4 + u5);
    std::array::from_fn(|n| {
        (1.0 - x1) * k.x[n] + x1 * l.x[n] + v0 * k.v[n] + v1 * l.v[n] + a0 * k.a[n] + a1 * l.a[n]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_sine_is_a_sine() {
        for k in -4000..4000 {
            let turns = f64::from(k) / 1000.0 + 1e-4;
            assert!((sine(turns) - sin(TAU * turns)).abs() < 6e-8, "{turns}");
        }
    }
}
