use std::ops::RangeInclusive;

use mocap_core::{
    Holdout, MarkerSet, Mask, Rotation, Take,
    geometry::{add, norm},
};
use ndarray::Array3;
use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};

/// Rate of the takes of this module in Hz.
pub const RATE_HZ: f64 = 120.0;

/// A rigid body of `markers` points within 0.4 m of its centre that moves and turns smoothly.
///
/// All distances between markers are constant up to rounding. Markers are called `R0`, `R1`, ….
///
/// # Panics
/// Never for any count.
///
/// ```
/// let take = mocap_testkit::rigid_take(4, 50, 1);
/// let stretch = take.distance(0, 0, 3).unwrap() - take.distance(49, 0, 3).unwrap();
/// assert!(stretch.abs() < 1e-12);
/// ```
#[must_use]
pub fn rigid_take(markers: usize, frames: usize, seed: u64) -> Take {
    let mut dice = Dice::new(seed);
    let shape: Vec<[f64; 3]> = (0..markers).map(|_| [0; 3].map(|_| dice.within(0.23))).collect();
    let path = [0; 3].map(|_| Smooth::new(&mut dice, 0.5));
    let turn = [0; 3].map(|_| Smooth::new(&mut dice, 0.8));
    let mut positions = Array3::zeros((frames, markers, 3));
    for t in 0..frames {
        let centre = at(&path, t);
        let rotation = exp(at(&turn, t));
        for (m, &p) in shape.iter().enumerate() {
            put(&mut positions, t, m, add([0.0, 0.0, 1.0], add(centre, rotation.apply(p))));
        }
    }
    complete((0..markers).map(|m| format!("R{m}")), positions)
}

/// Two segments of four markers each, joined by a ball joint, that move smoothly at random.
///
/// Markers `A0` … `A3` sit on the first segment, `B0` … `B3` on the second. White noise of 0.1 mm
/// lies on top, so that no covariance is exactly singular.
///
/// # Panics
/// Never for any count.
///
/// ```
/// let take = mocap_testkit::articulated_take(100, 7);
/// assert_eq!((take.frames(), take.marker_count()), (100, 8));
/// assert!(take.gaps().is_empty());
/// ```
#[must_use]
pub fn articulated_take(frames: usize, seed: u64) -> Take {
    const NOISE_M: f64 = 0.000_1;
    // Along −z from the joint that carries the segment; never in one plane.
    const SEGMENT: [[f64; 3]; 4] =
        [[0.05, 0.04, -0.05], [-0.05, 0.03, -0.15], [0.04, -0.05, -0.28], [-0.03, -0.04, -0.40]];
    const JOINT: [f64; 3] = [0.0, 0.0, -0.45];
    let mut dice = Dice::new(seed);
    let path = [0; 3].map(|_| Smooth::new(&mut dice, 0.4));
    let turns = [0.6, 0.9].map(|size| [0; 3].map(|_| Smooth::new(&mut dice, size)));
    let mut positions = Array3::zeros((frames, 2 * SEGMENT.len(), 3));
    for t in 0..frames {
        let upper = exp(at(&turns[0], t));
        let lower = upper.after(exp(at(&turns[1], t)));
        let origin = add([0.0, 0.0, 1.5], at(&path, t));
        let joint = add(origin, upper.apply(JOINT));
        for (segment, (start, rotation)) in [(origin, upper), (joint, lower)].iter().enumerate() {
            for (m, &p) in SEGMENT.iter().enumerate() {
                let noise = [0; 3].map(|_| NOISE_M * dice.bell());
                let place = add(noise, add(*start, rotation.apply(p)));
                put(&mut positions, t, segment * SEGMENT.len() + m, place);
            }
        }
    }
    let names = ["A", "B"].iter().flat_map(|s| (0..SEGMENT.len()).map(move |m| format!("{s}{m}")));
    complete(names, positions)
}

/// Hides `gaps` runs of one random marker each, with lengths drawn evenly from `lengths`.
///
/// Runs stay away from the first and the last frame where the take is long enough, may overlap, and
/// never hide a frame beyond the end. A take without cells, or an empty range, gets no gap.
///
/// # Panics
/// Never for any value.
///
/// ```
/// let take = mocap_testkit::articulated_take(200, 3);
/// let holdout = mocap_testkit::with_gaps(take, 3, 5, 10..=30);
/// assert!(holdout.visible().gaps().len() >= 1);
/// assert!(holdout.hidden().count() >= 10);
/// ```
#[must_use]
pub fn with_gaps(take: Take, seed: u64, gaps: usize, lengths: RangeInclusive<usize>) -> Holdout {
    let (frames, markers) = (take.frames(), take.marker_count());
    let mut dice = Dice::new(seed);
    let mut hidden = Mask::none(frames, markers);
    if frames > 0 && markers > 0 && !lengths.is_empty() {
        for _ in 0..gaps {
            let marker = dice.below(markers);
            let span = (lengths.end() - lengths.start()).saturating_add(1);
            let length = lengths.start() + dice.below(span);
            let first = usize::from(frames > length.saturating_add(1));
            let room = frames.saturating_sub(length.saturating_add(first));
            let start = first + dice.below(room.max(1));
            for frame in start..frames.min(start.saturating_add(length)) {
                hidden.insert(frame, marker).expect("the cell lies inside the take");
            }
        }
    }
    Holdout::new(take, &hidden).expect("the mask has the take's shape")
}

fn put(positions: &mut Array3<f64>, frame: usize, marker: usize, place: [f64; 3]) {
    for (axis, c) in place.into_iter().enumerate() {
        positions[(frame, marker, axis)] = c;
    }
}

fn complete(names: impl Iterator<Item = String>, positions: Array3<f64>) -> Take {
    let markers = MarkerSet::new(names).expect("the names are unique");
    Take::from_positions(markers, RATE_HZ, positions).expect("shape and rate are right")
}

/// The rotation about the direction of `v` by its length in radians.
fn exp(v: [f64; 3]) -> Rotation {
    Rotation::about(v, norm(v))
}

/// A sum of three slow waves, of standard deviation `size`.
struct Smooth {
    waves: [[f64; 3]; 3],
}

impl Smooth {
    fn new(dice: &mut Dice, size: f64) -> Self {
        let amplitude = size * (2.0_f64 / 3.0).sqrt();
        let wave = |dice: &mut Dice| {
            let pulsation = std::f64::consts::TAU * (0.5 + dice.within(0.4)) / RATE_HZ;
            [amplitude, pulsation, dice.within(std::f64::consts::PI)]
        };
        Self { waves: [0; 3].map(|_| wave(dice)) }
    }
}

fn at(curves: &[Smooth; 3], frame: usize) -> [f64; 3] {
    let value = |s: &Smooth| s.waves.iter().map(|[a, w, p]| a * (w * frame as f64 + p).sin()).sum();
    [value(&curves[0]), value(&curves[1]), value(&curves[2])]
}

struct Dice(ChaCha8Rng);

impl Dice {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Uniform in `[−limit, limit)`.
    fn within(&mut self, limit: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0;
        limit * (2.0 * unit - 1.0)
    }

    /// Close to standard normal: the sum of twelve uniforms.
    fn bell(&mut self) -> f64 {
        (0..12).map(|_| self.within(0.5)).sum()
    }

    /// Uniform below `n`, and 0 for `n` = 0.
    #[allow(clippy::cast_possible_truncation)]
    fn below(&mut self, n: usize) -> usize {
        (self.0.next_u64() % (n.max(1) as u64)) as usize
    }
}
