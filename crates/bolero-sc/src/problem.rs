//! The missing markers of one frame: an objective with two kinds of squares.

/// An end of a bone within a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum End {
    /// The unknown marker of this index among those of the frame.
    Unknown(usize),
    /// A marker whose place is known, in metres.
    Known([f64; 3]),
}

/// A bone with at least one unknown end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stick {
    pub(crate) ends: [End; 2],
    pub(crate) length_m: f64,
}

/// `½ Σ p (y − ŷ)² + ½ λ Σ (‖yᵢ − yⱼ‖² − d²)²` over the unknown coordinates `y`.
///
/// | symbol | here | meaning |
/// |---|---|---|
/// | `ŷ` | prediction | what the linear dynamical system expects, metres |
/// | `p` | precision | reciprocal of the observation noise, m⁻² |
/// | `d` | length of a stick, metres | |
/// | `λ` | lambda, m⁻⁴ | |
///
/// Implements [Li10] Eq. (11) up to a constant, the spread of the states. The authors' code
/// minimises twice this.
#[derive(Debug)]
pub(crate) struct Problem<'a> {
    pub(crate) prediction: &'a [f64],
    pub(crate) precision: &'a [f64],
    pub(crate) sticks: &'a [Stick],
    pub(crate) lambda: f64,
}

impl Problem<'_> {
    /// Number of unknown coordinates.
    pub(crate) fn len(&self) -> usize {
        self.prediction.len()
    }

    pub(crate) fn objective(&self, y: &[f64]) -> f64 {
        let prediction: f64 = (y.iter().zip(self.prediction).zip(self.precision))
            .map(|((y, c), p)| p * (y - c) * (y - c))
            .sum();
        let bones: f64 = self.sticks.iter().map(|stick| stretch(stick, y).1.powi(2)).sum();
        0.5 * (prediction + self.lambda * bones)
    }

    /// The gradient.
    ///
    /// Implements [Li10] Eq. (10).
    pub(crate) fn gradient(&self, y: &[f64], out: &mut [f64]) {
        for (i, g) in out.iter_mut().enumerate() {
            *g = self.precision[i] * (y[i] - self.prediction[i]);
        }
        for stick in self.sticks {
            let (apart, excess) = stretch(stick, y);
            for (sign, end) in [1.0, -1.0].into_iter().zip(stick.ends) {
                if let End::Unknown(k) = end {
                    for (g, d) in out[3 * k..3 * k + 3].iter_mut().zip(apart) {
                        *g += sign * 2.0 * self.lambda * excess * d;
                    }
                }
            }
        }
    }

    /// The Hessian, `(n, n)` row by row; indefinite where a bone is much too short.
    pub(crate) fn hessian(&self, y: &[f64], out: &mut [f64]) {
        let n = self.len();
        out.fill(0.0);
        (0..n).for_each(|i| out[i * n + i] = self.precision[i]);
        for stick in self.sticks {
            let (apart, excess) = stretch(stick, y);
            for (row_sign, row_end) in [1.0, -1.0].into_iter().zip(stick.ends) {
                for (column_sign, column_end) in [1.0, -1.0].into_iter().zip(stick.ends) {
                    let (End::Unknown(r), End::Unknown(c)) = (row_end, column_end) else {
                        continue;
                    };
                    let factor = 2.0 * self.lambda * row_sign * column_sign;
                    for a in 0..3 {
                        let row = &mut out[(3 * r + a) * n + 3 * c..][..3];
                        for (b, h) in row.iter_mut().enumerate() {
                            *h += factor * 2.0 * apart[a] * apart[b];
                        }
                        row[a] += factor * excess;
                    }
                }
            }
        }
    }
}

/// The vector from the second end to the first, and its squared length less that of the bone.
fn stretch(stick: &Stick, y: &[f64]) -> ([f64; 3], f64) {
    let place = |end| match end {
        End::Unknown(k) => [y[3 * k], y[3 * k + 1], y[3 * k + 2]],
        End::Known(p) => p,
    };
    let (p, q) = (place(stick.ends[0]), place(stick.ends[1]));
    let apart = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    (apart, mocap_core::geometry::dot(apart, apart) - stick.length_m * stick.length_m)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A random frame that owns what a [`Problem`] borrows.
    #[derive(Debug, Clone)]
    pub(crate) struct Frame {
        pub(crate) prediction: Vec<f64>,
        pub(crate) precision: Vec<f64>,
        pub(crate) sticks: Vec<Stick>,
        pub(crate) lambda: f64,
    }

    impl Frame {
        pub(crate) fn problem(&self) -> Problem<'_> {
            Problem {
                prediction: &self.prediction,
                precision: &self.precision,
                sticks: &self.sticks,
                lambda: self.lambda,
            }
        }
    }

    fn end(markers: usize) -> impl Strategy<Value = End> {
        prop_oneof![
            (0..markers).prop_map(End::Unknown),
            prop::array::uniform3(-1.0..1.0).prop_map(End::Known),
        ]
    }

    pub(crate) fn frames() -> impl Strategy<Value = Frame> {
        (1_usize..5).prop_flat_map(|markers| {
            let n = 3 * markers;
            let stick = (end(markers), end(markers), 0.05..1.0)
                .prop_map(|(a, b, length_m)| Stick { ends: [a, b], length_m });
            (
                prop::collection::vec(-1.0..1.0, n),
                prop::collection::vec(1.0..1e8, n),
                prop::collection::vec(stick, 0..7),
                prop_oneof![Just(0.0), 1.0..1e7],
            )
                .prop_map(|(prediction, precision, mut sticks, lambda)| {
                    let joined = |s: &Stick| match s.ends {
                        [End::Unknown(a), End::Unknown(b)] => a != b,
                        [End::Known(_), End::Known(_)] => false,
                        _ => true,
                    };
                    sticks.retain(joined);
                    Frame { prediction, precision, sticks, lambda }
                })
        })
    }

    /// The slope at zero of a polynomial of degree four, by a formula that is exact for those.
    fn slope(at: impl Fn(f64) -> f64, step: f64) -> f64 {
        (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step)
    }

    proptest! {
        #[test]
        fn gradient_and_hessian_are_the_slopes_of_what_they_derive(
            frame in frames(),
            shift in prop::collection::vec(-0.3..0.3, 15),
        ) {
            let problem = frame.problem();
            let y: Vec<f64> = frame.prediction.iter().zip(&shift).map(|(c, s)| c + s).collect();
            let n = y.len();
            let (mut gradient, mut hessian) = (vec![0.0; n], vec![0.0; n * n]);
            problem.gradient(&y, &mut gradient);
            problem.hessian(&y, &mut hessian);
            let moved = |i: usize, by: f64| {
                let mut y = y.clone();
                y[i] += by;
                y
            };
            // What is left is the rounding of the function over the step.
            let step = 1e-2;
            let tolerance = |value: f64| 64.0 * f64::EPSILON * (1.0 + value.abs()) / step;
            let largest = (0..n)
                .flat_map(|i| [-2.0, 2.0].map(|by| problem.objective(&moved(i, by * step))))
                .fold(0.0, f64::max);
            let size = gradient.iter().fold(largest, |a, g| a.max(g.abs()));
            for i in 0..n {
                let by_value = slope(|h| problem.objective(&moved(i, h)), step);
                prop_assert!((by_value - gradient[i]).abs() <= tolerance(size));
                for j in 0..n {
                    let by_gradient = slope(
                        |h| {
                            let mut gradient = vec![0.0; n];
                            problem.gradient(&moved(i, h), &mut gradient);
                            gradient[j]
                        },
                        step,
                    );
                    prop_assert!((by_gradient - hessian[i * n + j]).abs() <= tolerance(size));
                }
            }
        }
    }
}
