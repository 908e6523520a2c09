use super::track::Spot;
use crate::{
    curve::ease,
    dice::Dice,
    math::{degrees, sin_cos},
};

/// A path of straight legs and sharp corners, walked at unit speed.
pub(crate) struct Corners {
    legs: Vec<Leg>,
}

/// A straight way and the corner at its end. Lengths in metres, angles in radians.
struct Leg {
    /// Arc length at which it begins.
    start: f64,
    place: [f64; 2],
    heading: f64,
    straight: f64,
    /// Length of the corner, and how far it turns to the left.
    bend: f64,
    turn: f64,
}

impl Corners {
    /// Legs for so many metres; before the first the path is straight.
    pub(crate) fn new(size: f64, heading: f64, length: f64, dice: &mut Dice) -> Self {
        let mut leg = Leg::sample(size, 0.0, [0.0; 2], heading, dice);
        let mut legs = Vec::new();
        while leg.start < length {
            let end = leg.start + leg.straight + leg.bend;
            let next = Leg::sample(size, end, leg.at(end).place, leg.heading + leg.turn, dice);
            legs.push(std::mem::replace(&mut leg, next));
        }
        legs.push(leg);
        Self { legs }
    }

    /// The same path from another origin.
    pub(crate) fn moved(mut self, by: [f64; 2]) -> Self {
        for leg in &mut self.legs {
            leg.place = [leg.place[0] + by[0], leg.place[1] + by[1]];
        }
        self
    }

    /// The place at an arc length in metres.
    pub(crate) fn at(&self, s: f64) -> Spot {
        self.legs[self.legs.partition_point(|leg| leg.start <= s).saturating_sub(1)].at(s)
    }
}

impl Leg {
    fn sample(size: f64, start: f64, place: [f64; 2], heading: f64, dice: &mut Dice) -> Self {
        Self {
            start,
            place,
            heading,
            straight: size * dice.uniform(0.8, 3.2),
            bend: size * dice.uniform(1.2, 1.9),
            turn: dice.sign() * degrees(90.0 + dice.jitter(12.0)),
        }
    }

    fn at(&self, s: f64) -> Spot {
        let along = s - self.start;
        let inside = along - self.straight;
        let step = along.min(self.straight);
        let (sin, cos) = sin_cos(self.heading);
        let place = [self.place[0] + cos * step, self.place[1] + sin * step];
        if inside <= 0.0 {
            return Spot { place, heading: self.heading, curvature: 0.0 };
        }
        let u = (inside / self.bend).min(1.0);
        let heading = |u: f64| self.heading + self.turn * ease(u);
        let [dx, dy] = way(inside, |share| heading(share * u));
        // The slope of `ease`.
        let slope = 30.0 * u * u * (1.0 - u) * (1.0 - u);
        let curvature = self.turn * slope / self.bend;
        Spot { place: [place[0] + dx, place[1] + dy], heading: heading(u), curvature }
    }
}

/// Where a way of this length leads whose heading is known at each share of it: Gauss–Legendre of ten points, good to
/// 0.1 µm for corners as sharp as these.
fn way(length: f64, heading: impl Fn(f64) -> f64) -> [f64; 2] {
    const NODES: [(f64, f64); 5] = [
        (0.148_874_338_981_631_2, 0.295_524_224_714_752_8),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_5),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_4),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_1),
    ];
    let mut sum = [0.0; 2];
    for (node, weight) in NODES {
        for x in [-node, node] {
            let (s, c) = sin_cos(heading(0.5 * (1.0 + x)));
            sum = [sum[0] + weight * c, sum[1] + weight * s];
        }
    }
    sum.map(|w| 0.5 * length * w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dice::Stream;

    /// The path has unit speed and goes where its heading says, through corners and from leg to leg.
    #[test]
    fn the_path_follows_its_heading() {
        const STEP_M: f64 = 1e-3;
        let path = Corners::new(1.0, 0.3, 30.0, &mut Dice::new(4, Stream::Motion));
        for k in -1000..30_000 {
            let s = f64::from(k) * STEP_M;
            let [p, q] = [path.at(s - STEP_M).place, path.at(s + STEP_M).place];
            let spot = path.at(s);
            let (sin, cos) = sin_cos(spot.heading);
            for (found, expected) in [(q[0] - p[0], cos), (q[1] - p[1], sin)] {
                // Central differences are off by a sixth of the step's square times the third derivative.
                assert!((0.5 * found / STEP_M - expected).abs() < 1e-5, "at {s} m");
            }
        }
    }
}
