//! How alike the target is taken to be in two frames.

/// Covariance of the target's local position in two frames, as a multiple of the same unit as `noise`.
///
/// With features `x` of unit mean square length and times `t`: `linear` x·x′ + `curved` + `drift`, and
/// `noise` where the frames are the same. With `linear` alone it is ridge regression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kernel {
    pub linear: f64,
    pub curved: Curved,
    pub drift: Drift,
    pub noise: f64,
}

/// Alike in like poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Curved {
    pub variance: f64,
    /// Distance of features over which it falls.
    pub length: f64,
    pub shape: Shape,
    /// Seconds after which a like pose counts less; infinite where it never does.
    pub fade_s: f64,
}

/// Of the distance of features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// exp(−d² / 2 length²)
    Gaussian,
    /// exp(−d / length)
    Exponential,
}

/// Alike at like times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drift {
    pub variance: f64,
    pub tau_s: f64,
    pub path: Path,
}

/// What a drifting target does between two frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Path {
    /// It wanders, with covariance exp(−|t − t′| / τ).
    Rough,
    /// It glides, twice differentiable: the Matérn covariance of order 5/2, [RW06] Eq. (4.17).
    Smooth,
}

/// Products and squared lengths of the features of two sets of frames, with the frames' numbers.
#[derive(Clone, Copy)]
pub(super) struct Pairs<'a> {
    /// `(rows, columns)` row-major.
    pub products: &'a [f64],
    pub rows: Side<'a>,
    pub columns: Side<'a>,
}

/// One set of frames.
#[derive(Clone, Copy)]
pub(super) struct Side<'a> {
    pub frames: &'a [usize],
    pub squares: &'a [f64],
}

/// What depends on time alone, by lag in frames.
struct ByLag {
    drift: Vec<f64>,
    /// Factor of the curved part.
    fade: Vec<f64>,
}

impl Kernel {
    /// Covariances `(rows, columns)` of different frames.
    pub fn between(&self, pairs: Pairs<'_>, rate_hz: f64) -> Vec<f64> {
        let by_lag = self.by_lag(&pairs, rate_hz);
        let mut out = vec![0.0; pairs.products.len()];
        for i in 0..pairs.rows.frames.len() {
            self.fill_row(&pairs, i, pairs.columns.frames.len(), &by_lag, &mut out);
        }
        out
    }

    /// Covariances of observations in a set of frames: the lower triangle, noise included.
    pub fn within(&self, pairs: Pairs<'_>, rate_hz: f64) -> Vec<f64> {
        let n = pairs.columns.frames.len();
        let by_lag = self.by_lag(&pairs, rate_hz);
        let mut out = vec![0.0; n * n];
        for i in 0..n {
            self.fill_row(&pairs, i, i + 1, &by_lag, &mut out);
            out[i * n + i] += self.noise;
        }
        out
    }

    fn by_lag(&self, pairs: &Pairs<'_>, rate_hz: f64) -> ByLag {
        let ends = |side: &Side<'_>| {
            let (min, max) = (side.frames.iter().min(), side.frames.iter().max());
            min.copied().zip(max.copied()).unwrap_or_default()
        };
        let (rows, columns) = (ends(&pairs.rows), ends(&pairs.columns));
        let lags = rows.1.max(columns.1) - rows.0.min(columns.0) + 1;
        let seconds = |lag: usize| lag as f64 / rate_hz;
        ByLag {
            drift: (0..lags).map(|lag| self.drift.at(seconds(lag))).collect(),
            fade: (0..lags).map(|lag| (-seconds(lag) / self.curved.fade_s).exp()).collect(),
        }
    }

    fn fill_row(&self, pairs: &Pairs<'_>, i: usize, until: usize, by_lag: &ByLag, out: &mut [f64]) {
        let n = pairs.columns.frames.len();
        let row = i * n..i * n + until;
        let (square, frame) = (pairs.rows.squares[i], pairs.rows.frames[i]);
        let cells = out[row.clone()].iter_mut().zip(&pairs.products[row]);
        for ((out, product), (other, at)) in
            cells.zip(pairs.columns.squares.iter().zip(pairs.columns.frames))
        {
            let lag = frame.abs_diff(*at);
            let apart = (square + other - 2.0 * product).max(0.0);
            *out = self.linear * product
                + by_lag.fade[lag] * self.curved.at(apart)
                + by_lag.drift[lag];
        }
    }
}

impl Curved {
    pub const NONE: Self =
        Self { variance: 0.0, length: 1.0, shape: Shape::Gaussian, fade_s: f64::INFINITY };

    /// At a squared distance.
    fn at(&self, square: f64) -> f64 {
        if self.variance == 0.0 {
            return 0.0;
        }
        let square = square / (self.length * self.length);
        self.variance
            * match self.shape {
                Shape::Gaussian => (-0.5 * square).exp(),
                Shape::Exponential => (-square.sqrt()).exp(),
            }
    }
}

impl Drift {
    fn at(&self, seconds: f64) -> f64 {
        let lags = seconds / self.tau_s;
        self.variance
            * match self.path {
                Path::Rough => (-lags).exp(),
                Path::Smooth => {
                    let a = 5.0_f64.sqrt() * lags;
                    (1.0 + a + a * a / 3.0) * (-a).exp()
                }
            }
    }
}
