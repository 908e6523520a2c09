//! The hook between E- and M-step.

use std::collections::HashMap;

use lds_kalman::{MissingEntries, MissingUpdate, UpdateContext, filler::Columns};
use mocap_core::BoneSet;
use ndarray::{Array2, ArrayView2};
use rayon::prelude::*;

use crate::{
    params::Untied,
    problem::{End, Problem, Stick},
    solver::{Scratch, Solver},
};

/// The bones act from this iteration on, or in the last one: the prediction of the first may be that of
/// no model yet.
const FIRST_ITERATION: usize = 2;

/// So many seen markers tell more coordinates than the usual model has hidden dimensions, 16.
const ENOUGH_SEEN: usize = 6;

/// Chooses the missing markers of each frame so that they are close to the prediction and keep
/// the bone lengths, softly.
///
/// Frames are independent of each other and are solved in parallel; the result does not depend on
/// the number of threads. Markers without a bone take the prediction.
///
/// Implements [Li10] Eq. (11), third step of Algorithm 2.
#[derive(Debug, Clone)]
pub struct SoftBones {
    bones: Vec<Segment>,
    lambda: f64,
    solver: Solver,
    untied: Untied,
}

/// A bone between two triples of columns.
#[derive(Debug, Clone, Copy)]
struct Segment {
    ends: [usize; 2],
    length_m: f64,
}

/// The unknown markers of all frames that miss the same ones, and the bones at them.
#[derive(Debug, Default)]
struct Plan {
    unknown: Vec<usize>,
    segments: Vec<Segment>,
}

impl SoftBones {
    /// A hook for observations with these columns. Bones at markers that are never seen are left
    /// out. `lambda` is in m⁻⁴.
    #[must_use]
    pub fn new(columns: &Columns, bones: &BoneSet, lambda: f64, solver: Solver) -> Self {
        let place: HashMap<usize, usize> =
            columns.markers().iter().enumerate().map(|(k, &m)| (m, k)).collect();
        let segments = bones.bones().iter().filter_map(|bone| {
            let (a, b) = bone.markers();
            let ends = [*place.get(&a)?, *place.get(&b)?];
            Some(Segment { ends, length_m: bone.length_m() })
        });
        Self { bones: segments.collect(), lambda, solver, untied: Untied::default() }
    }

    /// The same hook with this choice about fills that no bone ties to a visible marker.
    #[must_use]
    pub fn with_untied(self, untied: Untied) -> Self {
        Self { untied, ..self }
    }

    /// The markers whose places count: all where enough are seen, else those that are seen and
    /// those that bones tie to a seen one, be it over hidden ones.
    fn tied(&self, seen: &[bool]) -> Vec<bool> {
        if seen.iter().filter(|&&seen| seen).count() >= ENOUGH_SEEN {
            return vec![true; seen.len()];
        }
        let mut tied = seen.to_vec();
        let mut grown = true;
        while grown {
            grown = false;
            for [a, b] in self.bones.iter().map(|segment| segment.ends) {
                if tied[a] != tied[b] {
                    (tied[a], tied[b], grown) = (true, true, true);
                }
            }
        }
        tied
    }

    /// A plan for each set of missing markers, and which frame has which; frames in which no
    /// missing marker has a bone have none.
    fn plans(&self, mask: ArrayView2<'_, bool>) -> (Vec<Plan>, Vec<(usize, usize)>) {
        let mut known: HashMap<Vec<bool>, Option<usize>> = HashMap::new();
        let mut plans = Vec::new();
        let mut jobs = Vec::new();
        for (t, row) in mask.rows().into_iter().enumerate() {
            let seen: Vec<bool> = row.iter().step_by(3).copied().collect();
            let plan = *known.entry(seen).or_insert_with_key(|seen| {
                let plan = self.plan(seen);
                (!plan.segments.is_empty()).then(|| {
                    plans.push(plan);
                    plans.len() - 1
                })
            });
            jobs.extend(plan.map(|plan| (t, plan)));
        }
        (plans, jobs)
    }

    fn plan(&self, seen: &[bool]) -> Plan {
        let counts = match self.untied {
            Untied::Missing => self.tied(seen),
            Untied::Observed => vec![true; seen.len()],
        };
        let loose = |segment: &&Segment| {
            segment.ends.iter().any(|&k| !seen[k]) && segment.ends.iter().all(|&k| counts[k])
        };
        let segments: Vec<Segment> = self.bones.iter().filter(loose).copied().collect();
        let ends = segments.iter().flat_map(|segment| segment.ends);
        let mut unknown: Vec<usize> = ends.filter(|&k| !seen[k]).collect();
        unknown.sort_unstable();
        unknown.dedup();
        Plan { unknown, segments }
    }

    /// The places of the unknown markers of a frame.
    fn solve(
        &self,
        plan: &Plan,
        row: &[f64],
        variances: &[f64],
        scratch: &mut Scratch,
    ) -> Vec<f64> {
        let columns = || plan.unknown.iter().flat_map(|&k| 3 * k..3 * k + 3);
        let prediction: Vec<f64> = columns().map(|j| row[j]).collect();
        let precision: Vec<f64> = columns().map(|j| variances[j].recip()).collect();
        let end = |k: usize| match plan.unknown.binary_search(&k) {
            Ok(i) => End::Unknown(i),
            Err(_) => End::Known(std::array::from_fn(|a| row[3 * k + a])),
        };
        let sticks: Vec<Stick> = plan
            .segments
            .iter()
            .map(|segment| Stick { ends: segment.ends.map(end), length_m: segment.length_m })
            .collect();
        let problem = Problem {
            prediction: &prediction,
            precision: &precision,
            sticks: &sticks,
            lambda: self.lambda,
        };
        let mut y = prediction.clone();
        self.solver.minimise(&problem, &mut y, scratch);
        y
    }
}

impl MissingUpdate for SoftBones {
    fn update(&mut self, context: &UpdateContext<'_>, missing: &mut MissingEntries<'_>) {
        missing.fill_from(context.prediction);
        if context.iteration < FIRST_ITERATION.min(context.iterations) || self.lambda <= 0.0 {
            return;
        }
        let (plans, jobs) = self.plans(context.mask);
        let now = missing.values();
        let variances = context.observation_noise.variances(now.ncols()).to_vec();
        let this = &*self;
        let solved: Vec<Vec<f64>> = jobs
            .par_iter()
            .map_init(Scratch::default, |scratch, &(t, plan)| {
                this.solve(&plans[plan], &now.row(t).to_vec(), &variances, scratch)
            })
            .collect();
        for (&(t, plan), places) in jobs.iter().zip(&solved) {
            for (k, place) in plans[plan].unknown.iter().zip(places.chunks_exact(3)) {
                (0..3).for_each(|a| missing.set(t, 3 * k + a, place[a]));
            }
        }
    }

    fn evidence(&self, mask: ArrayView2<'_, bool>) -> Option<Array2<bool>> {
        if self.untied == Untied::Observed || self.bones.is_empty() || self.lambda <= 0.0 {
            return None;
        }
        let mut known: HashMap<Vec<bool>, Vec<bool>> = HashMap::new();
        let mut evidence = mask.to_owned();
        for mut row in evidence.rows_mut() {
            let seen: Vec<bool> = row.iter().step_by(3).copied().collect();
            let tied = known.entry(seen).or_insert_with_key(|seen| self.tied(seen));
            row.iter_mut().enumerate().for_each(|(j, counts)| *counts = tied[j / 3]);
        }
        (!evidence.iter().all(|&counts| counts)).then_some(evidence)
    }
}
