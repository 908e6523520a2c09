//! The missing markers of one frame that bones join: a quadratic under quadratic constraints.

use mocap_core::geometry::dot;

/// An end of a bone within a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum End {
    /// The unknown marker of this index among those of the problem.
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

/// `½ Σ w (y − ŷ)²` over the unknown coordinates `y`, subject to `‖yᵢ − yⱼ‖² = d²`.
///
/// | symbol | here | meaning |
/// |---|---|---|
/// | `ŷ` | centre | what the linear dynamical system expects, metres |
/// | `w` | weight | reciprocal of the observation noise over the mean of all reciprocals |
/// | `d` | length of a stick, metres | |
///
/// A constraint is measured as `c = (‖yᵢ − yⱼ‖² − d²) / 2d`, which is the excess length in metres to
/// first order, so that short and long bones count alike where they contradict each other.
///
/// Implements [Li10] Eq. (5) for one frame, the states and the model being fixed.
#[derive(Debug)]
pub(crate) struct Problem<'a> {
    pub(crate) centre: &'a [f64],
    pub(crate) weight: &'a [f64],
    pub(crate) sticks: &'a [Stick],
    /// For each unknown marker, the lowest one that a stick joins it to, or itself.
    pub(crate) lowest: &'a [usize],
}

/// Bones shorter than this share of the longest are measured in the unit of that share.
const SHORTEST: f64 = 0.01;

impl Problem<'_> {
    /// Number of unknown coordinates.
    pub(crate) fn len(&self) -> usize {
        self.centre.len()
    }

    /// Length of the longest stick, metres.
    pub(crate) fn size(&self) -> f64 {
        self.sticks.iter().map(|stick| stick.length_m).fold(0.0, f64::max)
    }

    /// `½ Σ w (y − ŷ)²`, m².
    pub(crate) fn objective(&self, y: &[f64]) -> f64 {
        let terms = y.iter().zip(self.centre).zip(self.weight);
        0.5 * terms.map(|((y, c), w)| w * (y - c) * (y - c)).sum::<f64>()
    }

    /// The constraints, metres.
    pub(crate) fn constraints(&self, y: &[f64], out: &mut [f64]) {
        let size = self.size();
        for (c, stick) in out.iter_mut().zip(self.sticks) {
            let apart = apart(stick, y);
            let d = stick.length_m;
            *c = 0.5 * (dot(apart, apart) - d * d) / unit(stick, size);
        }
    }

    /// Largest difference between a distance and the length it should have, metres.
    pub(crate) fn residual(&self, y: &[f64]) -> f64 {
        let excess = |stick: &Stick| {
            let apart = apart(stick, y);
            (dot(apart, apart).sqrt() - stick.length_m).abs()
        };
        self.sticks.iter().map(excess).fold(0.0, f64::max)
    }

    /// The gradient `α w (y − ŷ) + Σ τ ∇c`. With `α` 1 and `τ` the multipliers it is that of the
    /// Lagrangian.
    ///
    /// Implements [Li10] Eq. (37), first line.
    pub(crate) fn gradient(&self, y: &[f64], alpha: f64, tension: &[f64], out: &mut [f64]) {
        for (i, g) in out.iter_mut().enumerate() {
            *g = alpha * self.weight[i] * (y[i] - self.centre[i]);
        }
        let size = self.size();
        for (stick, tension) in self.sticks.iter().zip(tension) {
            let slope = tension / unit(stick, size);
            let apart = apart(stick, y);
            for (sign, end) in [1.0, -1.0].into_iter().zip(stick.ends) {
                if let End::Unknown(k) = end {
                    (0..3).for_each(|a| out[3 * k + a] += sign * slope * apart[a]);
                }
            }
        }
    }

    /// `α w + Σ τ ∇²c`, plus `Σ ∇c ∇cᵀ` where `squares` asks for it; `(n, n)` row by row.
    ///
    /// Implements [Li10] Eq. (38), upper left block.
    pub(crate) fn hessian(
        &self,
        y: &[f64],
        alpha: f64,
        tension: &[f64],
        squares: bool,
        out: &mut [f64],
    ) {
        let n = self.len();
        out.fill(0.0);
        (0..n).for_each(|i| out[i * n + i] = alpha * self.weight[i]);
        let size = self.size();
        for (stick, tension) in self.sticks.iter().zip(tension) {
            let unit = unit(stick, size);
            let apart = apart(stick, y).map(|d| if squares { d / unit } else { 0.0 });
            for (row_sign, row_end) in [1.0, -1.0].into_iter().zip(stick.ends) {
                for (column_sign, column_end) in [1.0, -1.0].into_iter().zip(stick.ends) {
                    let (End::Unknown(r), End::Unknown(c)) = (row_end, column_end) else {
                        continue;
                    };
                    let sign = row_sign * column_sign;
                    for a in 0..3 {
                        let row = &mut out[(3 * r + a) * n + 3 * c..][..3];
                        for (h, d) in row.iter_mut().zip(apart) {
                            *h += sign * apart[a] * d;
                        }
                        row[a] += sign * tension / unit;
                    }
                }
            }
        }
    }
}

/// What a constraint is divided by, metres.
fn unit(stick: &Stick, size: f64) -> f64 {
    stick.length_m.max(SHORTEST * size)
}

/// The vector from the second end to the first.
fn apart(stick: &Stick, y: &[f64]) -> [f64; 3] {
    let place = |end| match end {
        End::Unknown(k) => [y[3 * k], y[3 * k + 1], y[3 * k + 2]],
        End::Known(p) => p,
    };
    let (p, q) = (place(stick.ends[0]), place(stick.ends[1]));
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}
