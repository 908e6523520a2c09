use crate::math::{TAU, cos, sin, sin_cos};

/// A closed oval track, walked at unit speed: the heading at arc length s is `x + b sin 2x` with
/// `x = s / R`, which bends sharply twice a lap and runs nearly straight in between.
pub(crate) struct Track {
    /// Radius of the circle of the same length, in metres.
    radius: f64,
    heading: f64,
    origin: [f64; 2],
}

/// A place on the track.
pub(crate) struct Spot {
    pub(crate) place: [f64; 2],
    /// In radians, rising with each lap.
    pub(crate) heading: f64,
    /// Per metre, positive to the left.
    pub(crate) curvature: f64,
}

const BEND: f64 = -0.45;
/// Bessel functions J0, J1 and J2 of `BEND`: e^(ib sin 2x) = Σ Jn(b) e^(2inx).
const J: [f64; 3] = [0.950_012, -0.219_427, 0.024_892];

impl Track {
    pub(crate) fn new(radius: f64, heading: f64, origin: [f64; 2]) -> Self {
        Self { radius, heading, origin }
    }

    /// The place at an arc length in metres.
    pub(crate) fn at(&self, s: f64) -> Spot {
        let x = s / self.radius;
        // The integral of e^(i(x + b sin 2x)), term by term.
        let terms = [(1.0, J[0]), (-1.0, -J[1]), (3.0, J[1]), (5.0, J[2]), (-3.0, J[2])];
        let place = terms.iter().fold([0.0; 2], |[u, v], &(k, j)| {
            let (s, c) = sin_cos(k * x);
            [u + j * s / k, v - j * c / k]
        });
        let (s, c) = sin_cos(self.heading);
        let [u, v] = place.map(|p| self.radius * p);
        Spot {
            place: [self.origin[0] + c * u - s * v, self.origin[1] + s * u + c * v],
            heading: self.heading + x + BEND * sin(2.0 * x),
            curvature: (1.0 + 2.0 * BEND * cos(2.0 * x)) / self.radius,
        }
    }

    /// Arc length of a lap in metres.
    pub(crate) fn lap(&self) -> f64 {
        TAU * self.radius
    }
}

impl Spot {
    /// The place beside the track, `left` metres to the left and `ahead` along it.
    pub(crate) fn beside(&self, ahead: f64, left: f64) -> [f64; 2] {
        let (s, c) = sin_cos(self.heading);
        [self.place[0] + c * ahead - s * left, self.place[1] + s * ahead + c * left]
    }
}
