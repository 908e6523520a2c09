use mocap_core::{Take, geometry::norm};

use crate::{
    Fault, FaultParams, Faults, ParameterError,
    deviation::{Deviations, part_local},
    ghosts, jumps, misplaced,
    neighbours::{Neighbour, steadiest},
    spikes, swaps,
};

/// Finds faulty samples of a take.
///
/// It looks, one after the other, for
/// 1. ghosts: runs that stand still while their distances to all moving markers change;
/// 2. spikes: samples off the path through their neighbours in time, also when the motion of the markers
///    around is taken out. The worst go first, and the rest is judged without them;
/// 3. swaps: pairs that step in the same frame, each to where the other was heading;
/// 4. jumps: a step away and a step back within half a second;
/// 5. junk at gaps: samples right beside a gap that the path behind them does not lead to;
/// 6. misplaced runs: between gaps, at distances to most neighbours that the marker never keeps elsewhere.
///
/// What an earlier step finds is not there for the later ones.
///
/// # Cost
/// Linear in the samples of the take; distances of all pairs in at most 200 frames.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaultDetector {
    params: FaultParams,
}

impl FaultDetector {
    /// A detector with these thresholds.
    ///
    /// # Errors
    /// [`ParameterError`] that names the field, its value and the rule.
    pub fn new(params: FaultParams) -> Result<Self, ParameterError> {
        params.validate()?;
        Ok(Self { params })
    }

    /// The thresholds.
    #[must_use]
    pub fn params(&self) -> &FaultParams {
        &self.params
    }

    /// Looks at a take.
    #[must_use]
    pub fn detect(&self, take: &Take) -> Faults {
        let mut scene = Scene::new(take, &self.params);
        for step in [
            ghosts::find,
            spikes::find,
            swaps::find,
            jumps::find_jumps,
            jumps::find_edges,
            misplaced::find,
        ] {
            let faults = step(&scene);
            scene.distrust(faults);
        }
        Faults::new(take, swaps::pair_up(&scene))
    }
}

/// How far around a sample its usual deviations are taken from, in seconds.
const AROUND_S: f64 = 0.15;
/// A deviation is a fault from so many times the usual one.
const UNUSUAL: f64 = 5.0;

/// A take, what is known about its markers, and what was found so far.
pub(crate) struct Scene<'a> {
    pub take: &'a Take,
    pub params: &'a FaultParams,
    pub neighbours: Vec<Vec<Neighbour>>,
    /// For each marker the frames whose samples are trusted, in rising order.
    pub trusted: Vec<Vec<usize>>,
    pub deviations: Vec<Deviations>,
    pub found: Vec<Fault>,
}

impl<'a> Scene<'a> {
    fn new(take: &'a Take, params: &'a FaultParams) -> Self {
        let trusted: Vec<Vec<usize>> = (0..take.marker_count())
            .map(|m| (0..take.frames()).filter(|&t| take.is_observed(t, m)).collect())
            .collect();
        let allowance = params.allowance(take.rate_hz());
        let of = |(m, frames): (usize, &Vec<usize>)| Deviations::of(take, m, frames, allowance);
        let deviations = trusted.iter().enumerate().map(of).collect();
        let neighbours = steadiest(take);
        Self { take, params, neighbours, trusted, deviations, found: Vec::new() }
    }

    /// Takes the samples of faults away from those to go by.
    pub fn distrust(&mut self, faults: Vec<Fault>) {
        let mut changed: Vec<usize> = faults.iter().map(|fault| fault.marker).collect();
        changed.sort_unstable();
        changed.dedup();
        for marker in changed {
            let mut faulty = vec![false; self.take.frames()];
            for fault in faults.iter().filter(|fault| fault.marker == marker) {
                faulty[fault.frames.clone()].fill(true);
            }
            self.trusted[marker].retain(|&t| !faulty[t]);
            self.deviations[marker] = self.deviations_without(marker, &self.trusted[marker]);
        }
        self.found.extend(faults);
    }

    /// Deviations of a marker where only these samples are trusted.
    pub fn deviations_without(&self, marker: usize, trusted: &[usize]) -> Deviations {
        let allowance = self.params.allowance(self.take.rate_hz());
        Deviations::of(self.take, marker, trusted, allowance)
    }

    /// The limit of a deviation that may be as small as `least_m`.
    pub fn limit_m(&self, least_m: f64) -> f64 {
        self.params.limit_m(least_m, self.take.rate_hz())
    }

    /// Seconds as frames, at least one.
    pub fn frames(&self, seconds: f64) -> usize {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded and positive
        let frames = (seconds * self.take.rate_hz()).round().min(1e9) as usize;
        frames.max(1)
    }

    /// A deviation without the motion of the part: `which` picks it from a marker's deviations.
    pub fn local(
        &self,
        marker: usize,
        t: usize,
        which: fn(&Deviations) -> &[Option<[f64; 3]>],
    ) -> Option<[f64; 3]> {
        let of = |m: usize| which(&self.deviations[m])[t];
        Some(part_local(of(marker)?, &self.neighbours[marker], of))
    }

    /// What such deviations may be around a frame: `least_m`, or a multiple of the middle one within 0.15 s of it where the
    /// marker moves so hard that its deviations are large all the time.
    pub fn limit_around(
        &self,
        marker: usize,
        t: usize,
        least_m: f64,
        which: fn(&Deviations) -> &[Option<[f64; 3]>],
    ) -> f64 {
        let reach = self.frames(AROUND_S);
        let around = t.saturating_sub(reach)..(t + reach + 1).min(self.take.frames());
        let mut sizes: Vec<f64> = around.filter_map(|s| self.size(marker, s, which)).collect();
        sizes.sort_by(f64::total_cmp);
        let middle = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        self.limit_m(least_m).max(UNUSUAL * middle)
    }

    /// The length of such a deviation.
    pub fn size(
        &self,
        marker: usize,
        t: usize,
        which: fn(&Deviations) -> &[Option<[f64; 3]>],
    ) -> Option<f64> {
        self.local(marker, t, which).map(norm)
    }
}
