use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};

/// What a stream of random numbers is for: one use never shifts the numbers of another.
#[derive(Clone, Copy)]
pub(crate) enum Stream {
    Counts,
    Places,
    Occluders,
    PerFrame,
    Shifts,
    Swaps,
    Segments,
}

/// Random numbers with the same bits on every platform.
pub(crate) struct Dice {
    rng: ChaCha8Rng,
}

impl Dice {
    pub(crate) fn new(seed: u64, stream: Stream) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(stream as u64);
        Self { rng }
    }

    /// Uniform in `[0, 1)`, on the grid of 2⁻⁵³.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.rng.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Uniform in `0..count`; 0 if `count` is 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        // The high half of a 128-bit product: without division, and biased by less than 2⁻³² for
        // any count of frames that fits in memory.
        let wide = u128::from(self.rng.next_u64()) * count as u128;
        usize::try_from(wide >> 64).unwrap_or(0)
    }

    /// Standard normal, by the polar method of Marsaglia.
    pub(crate) fn normal(&mut self) -> f64 {
        loop {
            let (u, v) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let s = u * u + v * v;
            if s > 0.0 && s < 1.0 {
                return u * (-2.0 * libm::log(s) / s).sqrt();
            }
        }
    }

    /// The probability of one frame: `min(|α|, 2 deviation)` with α normal of zero mean, at most 1.
    ///
    /// Its mean is 0.781 times the deviation while the deviation is below 0.5.
    pub(crate) fn frame_probability(&mut self, deviation: f64) -> f64 {
        (deviation * self.normal().abs()).min(2.0 * deviation).min(1.0)
    }
}
