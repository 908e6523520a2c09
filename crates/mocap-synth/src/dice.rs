use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};

use crate::math::ln;

/// What a stream of random numbers is for: one use never shifts the numbers of another.
#[derive(Clone, Copy)]
pub(crate) enum Stream {
    Body,
    Markers,
    Motion,
    Noise,
    Person,
    Hands,
    Habits,
}

/// Random numbers with the same bits on every platform.
pub(crate) struct Dice {
    rng: ChaCha8Rng,
    spare: Option<f64>,
}

impl Dice {
    pub(crate) fn new(seed: u64, stream: Stream) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(stream as u64);
        Self { rng, spare: None }
    }

    /// Numbers of their own, so that it does not matter how many of them are drawn.
    pub(crate) fn fork(&mut self) -> Self {
        Self::new(self.rng.next_u64(), Stream::Motion)
    }

    /// Uniform in `[0, 1)`, on the grid of 2⁻⁵³.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.rng.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Standard normal, by the polar method of Marsaglia.
    pub(crate) fn normal(&mut self) -> f64 {
        if let Some(z) = self.spare.take() {
            return z;
        }
        loop {
            let (u, v) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let s = u * u + v * v;
            if s > 0.0 && s < 1.0 {
                let radius = (-2.0 * ln(s) / s).sqrt();
                self.spare = Some(radius * v);
                return radius * u;
            }
        }
    }

    /// `mean · (1 + spread · z)` with z normal, cut at ±2.5: no draw leaves the plausible range.
    pub(crate) fn around(&mut self, mean: f64, spread: f64) -> f64 {
        mean * (1.0 + spread * self.normal().clamp(-2.5, 2.5))
    }

    /// Zero-mean normal of this standard deviation, cut at ±2.5 of it.
    pub(crate) fn jitter(&mut self, deviation: f64) -> f64 {
        deviation * self.normal().clamp(-2.5, 2.5)
    }

    /// A fair −1 or +1.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }
}
