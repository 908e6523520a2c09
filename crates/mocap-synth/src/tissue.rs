use crate::math::TAU;

/// How skin and fat under a marker swing: a damped mass on a spring that the bone shakes.
///
/// With x the place that bone and skin share at rest, the displacement s obeys
/// `s″ + 2ζω s′ + ω² s = −g x″`, so that at slow motion it grows with the acceleration, `s ≈ −g x″/ω²`.
/// Sampled by the bilinear transform, which is stable at every rate.
pub(crate) struct Tissue {
    /// Weight of the places' second difference.
    high: f64,
    /// Weights of the last two displacements.
    displacements: [f64; 2],
}

/// What the filter of one marker remembers.
#[derive(Clone, Copy)]
pub(crate) struct Memory {
    places: [[f64; 3]; 2],
    displacements: [[f64; 3]; 2],
}

/// Natural frequency of loose tissue in Hz, and its damping ratio.
const NATURAL_HZ: f64 = 6.5;
const DAMPING: f64 = 0.4;
/// Skin goes no further than this, in metres.
const FURTHEST_M: f64 = 0.035;

impl Tissue {
    pub(crate) fn new(rate_hz: f64) -> Self {
        let omega = TAU * NATURAL_HZ;
        let k = 2.0 * rate_hz;
        let norm = k * k + 2.0 * DAMPING * omega * k + omega * omega;
        Self {
            high: k * k / norm,
            displacements: [
                -(2.0 * omega * omega - 2.0 * k * k) / norm,
                -(k * k - 2.0 * DAMPING * omega * k + omega * omega) / norm,
            ],
        }
    }

    /// Displacement in metres of a marker with this slack, whose unshaken place is `place`.
    pub(crate) fn shake(&self, memory: &mut Memory, place: [f64; 3], slack: f64) -> [f64; 3] {
        let [p1, p2] = memory.places;
        let [s1, s2] = memory.displacements;
        let [a1, a2] = self.displacements;
        // Relative to the last place, so that distance from the origin costs no digits.
        let swing: [f64; 3] = std::array::from_fn(|a| {
            let bend = (p1[a] - place[a]) + (p1[a] - p2[a]);
            self.high * bend + a1 * s1[a] + a2 * s2[a]
        });
        memory.places = [place, p1];
        memory.displacements = [swing, s1];
        let [x, y, z] = swing.map(|c| slack * c / FURTHEST_M);
        // Stretched skin pulls back: the displacement saturates.
        let share = slack / (1.0 + x * x + y * y + z * z).sqrt();
        swing.map(|c| share * c)
    }
}

impl Memory {
    /// A marker that rested at a place.
    pub(crate) fn at_rest(place: [f64; 3]) -> Self {
        Self { places: [place; 2], displacements: [[0.0; 3]; 2] }
    }
}
