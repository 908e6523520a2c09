//! Real recordings with injected faults, and how many of those are found.
#![allow(dead_code)] // the tests use a part, the example the rest

use std::fmt;

use augment::{
    GapSampler, GapSamplerParams, Preset, ShiftModel, ShiftParams, SwapParams, Unlisted,
    shift_markers, swap_markers,
};
use marker_faults::FaultDetector;
use mocap_core::{MarkerKnowledge, Mask, Take, geometry::norm};
use mocap_io::{MarkerFile, ReadOptions};
use mocap_testkit::{motion, recording};
use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};

/// Recordings that the thresholds were chosen on: HDM05 and the subjects 02, 127 and 132 of CMU.
pub const CHOSEN_ON: &[&str] = &[
    "hdm05/paired/HDM_dg_06-03_03_120.c3d",
    "cmu/paired/02_01.c3d",
    "127_07",
    "132_32",
    "132_43",
    "132_46",
];

/// Recordings that figures are reported on: the subjects 05, 80, 135, 141 and 143 of CMU.
pub const HELD_OUT: &[&str] = &[
    "cmu/paired/05_13.c3d",
    "cmu/paired/135_02.c3d",
    "80_10",
    "135_07",
    "141_04",
    "141_16",
    "143_22",
];

/// The recordings that are there, with the markers of the CMU set alone.
pub fn recordings(names: &[&'static str]) -> Vec<(&'static str, Take)> {
    let read = |name: &'static str| {
        let take = if name.contains('/') {
            let file = MarkerFile::read(&recording(name)?, &ReadOptions::default()).unwrap();
            let known = MarkerKnowledge::cmu_41();
            let markers: Vec<usize> =
                known.markers().iter().filter_map(|m| file.take().markers().find(m).ok()).collect();
            file.take().select(&markers).unwrap()
        } else {
            motion(name)?
        };
        Some((name, take))
    };
    names.iter().filter_map(|name| read(name)).collect()
}

/// A way of spoiling a take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scenario {
    /// Single samples as in [Pan23]: per coordinate within this many metres.
    Shifts(f64),
    /// Runs of so many frames, from and to, moved by 3 to 20 cm.
    Stays(usize, usize),
    /// Exchanged labels of near markers, for 1 to 120 frames.
    Swaps,
    /// Gaps, and nothing else.
    Gaps,
    /// Gaps with 1 to 5 samples beside every other border moved by 3 to 10 cm.
    Junk,
}

pub const SCENARIOS: &[Scenario] = &[
    Scenario::Shifts(0.05),
    Scenario::Shifts(0.25),
    Scenario::Stays(1, 3),
    Scenario::Stays(4, 48),
    Scenario::Swaps,
    Scenario::Gaps,
    Scenario::Junk,
];

impl Scenario {
    pub fn name(self) -> String {
        match self {
            Self::Shifts(range) => format!("shifts within ± {:.0} cm", 100.0 * range),
            Self::Stays(1, last) => format!("spikes of 1 to {last} frames"),
            Self::Stays(first, last) => format!("jumps of {first} to {last} frames"),
            Self::Swaps => "swaps of 1 to 120 frames".to_owned(),
            Self::Gaps => "gaps alone".to_owned(),
            Self::Junk => "junk beside gaps".to_owned(),
        }
    }

    /// The spoilt take, and by how many metres each of its samples was moved, `(T, M)`.
    pub fn spoil(self, take: &Take, seed: u64) -> (Take, Vec<Vec<f64>>) {
        let mut moved = vec![vec![0.0; take.marker_count()]; take.frames()];
        let spoilt = match self {
            Self::Shifts(range_m) => {
                let model = ShiftModel::PerFrame { deviation: 0.001 };
                let shifted = shift_markers(take, &ShiftParams { model, range_m, seed }).unwrap();
                for shift in &shifted.shifts {
                    moved[shift.frame][shift.marker] = norm(shift.offset_m);
                }
                shifted.take
            }
            Self::Swaps => {
                let params =
                    SwapParams { count: take.frames() / 120 + 1, seed, ..SwapParams::default() };
                let swapped = swap_markers(take, &params).unwrap();
                for swap in &swapped.swaps {
                    let (a, b) = swap.markers;
                    for t in swap.frames.clone() {
                        let apart = take.distance(t, a, b).unwrap_or(0.0);
                        (moved[t][a], moved[t][b]) = (apart, apart);
                    }
                }
                swapped.take
            }
            Self::Stays(first, last) => {
                let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
                let mut offsets = vec![vec![[0.0; 3]; take.marker_count()]; take.frames()];
                for _ in 0..=take.frames() / 30 {
                    let (marker, length) =
                        (dice.below(take.marker_count()), first + dice.below(last - first + 1));
                    let start = 8 + dice.below(take.frames() - length - 16);
                    // Another stay of the same marker nearby would join with it.
                    let around = start - 8..start + length + 8;
                    if around.clone().all(|t| moved[t][marker] <= 0.0) {
                        let offset = dice.direction().map(|c| c * (0.03 + 0.17 * dice.unit()));
                        for t in start..start + length {
                            offsets[t][marker] = offset;
                            moved[t][marker] = norm(offset);
                        }
                    }
                }
                take.map_positions(|t, m, p| std::array::from_fn(|a| p[a] + offsets[t][m][a]))
                    .unwrap()
            }
            Self::Gaps => gappy(take, seed),
            Self::Junk => {
                let gappy = gappy(take, seed);
                let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
                let mut offsets = vec![vec![[0.0; 3]; take.marker_count()]; take.frames()];
                for gap in gappy.gaps().iter().step_by(2) {
                    let length = 1 + dice.below(5);
                    let offset = dice.direction().map(|c| c * (0.03 + 0.07 * dice.unit()));
                    for t in gap.frames.end..(gap.frames.end + length).min(take.frames()) {
                        offsets[t][gap.marker] = offset;
                        moved[t][gap.marker] = norm(offset);
                    }
                }
                gappy
                    .map_positions(|t, m, p| std::array::from_fn(|a| p[a] + offsets[t][m][a]))
                    .unwrap()
            }
        };
        (spoilt, moved)
    }
}

fn gappy(take: &Take, seed: u64) -> Take {
    let params = GapSamplerParams {
        occlusion: 0.05,
        unlisted: Unlisted::Mean,
        seed,
        ..GapSamplerParams::default()
    };
    let model = Preset::Production.model().unwrap();
    let sampler = GapSampler::new(model, params).unwrap();
    sampler.sample(take).unwrap().holdout.visible().clone()
}

struct Dice(ChaCha8Rng);

impl Dice {
    #[allow(clippy::cast_possible_truncation)]
    fn below(&mut self, n: usize) -> usize {
        (self.0.next_u64() % n as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    fn direction(&mut self) -> [f64; 3] {
        loop {
            let v = [(); 3].map(|()| 2.0 * self.unit() - 1.0);
            let length = norm(v);
            if length > 0.1 && length <= 1.0 {
                return v.map(|c| c / length);
            }
        }
    }
}

/// How many of the spoilt samples were found, over some takes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Score {
    altered: usize,
    large: usize,
    found: usize,
    found_large: usize,
    alarms: usize,
    new_alarms: usize,
}

impl Score {
    /// Spoils a take, whose faults as it was recorded are `known`, and looks at it.
    pub fn add(
        &mut self,
        detector: &FaultDetector,
        (take, known): (&Take, &Mask),
        scenario: Scenario,
        seed: u64,
    ) {
        let (spoilt, moved) = scenario.spoil(take, seed);
        let faults = detector.detect(&spoilt);
        let mask: &Mask = faults.mask();
        for (t, m) in spoilt.observed().iter() {
            let (is_found, moved_m) = (mask.contains(t, m), moved[t][m]);
            if moved_m > 0.0 {
                self.altered += 1;
                self.found += usize::from(is_found);
                if moved_m >= 0.03 {
                    self.large += 1;
                    self.found_large += usize::from(is_found);
                }
            } else {
                self.alarms += usize::from(is_found);
                self.new_alarms += usize::from(is_found && !known.contains(t, m));
            }
        }
    }

    /// Share of the samples moved by 3 cm or more that were found.
    pub fn recall(&self) -> f64 {
        self.found_large as f64 / self.large as f64
    }

    /// Share of the samples found that were moved; faults of the recording itself are not counted.
    pub fn precision(&self) -> f64 {
        self.found as f64 / (self.found + self.new_alarms) as f64
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { altered, large, found, found_large, alarms, new_alarms } = *self;
        let share = |part: usize, whole: usize| match (altered, part as f64 / whole as f64) {
            (0, _) => "–".to_owned(),
            (_, share) => format!("{share:.3}"),
        };
        let recall = share(found_large, large);
        let (net, gross) = (share(found, found + new_alarms), share(found, found + alarms));
        write!(f, "{altered} | {recall} | {net} | {gross} | {new_alarms} | {alarms}")
    }
}
