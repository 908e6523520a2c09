//! The hook between E- and M-step.

use std::collections::HashMap;

use lds_kalman::{MissingEntries, MissingUpdate, UpdateContext, filler::Columns};
use mocap_core::BoneSet;
use ndarray::{Array2, ArrayView2};
use rayon::prelude::*;

use crate::{
    plan::{Group, Segment, groups},
    problem::Problem,
    solver,
};

/// Markers that may fall on either side of the planes that mirror their bones, in almost any gap. Where
/// more are missing together they hold each other, and starts become dear: there are fewer.
const FEW: usize = 6;

/// Puts the missing markers of each frame where all bones have their length, as close to the
/// prediction as they get. Where the bones contradict each other, their least-squares compromise
/// stands.
///
/// Frames are independent of each other and are solved in parallel; the result does not depend on
/// the number of threads. Markers without a bone take the prediction.
///
/// Implements [Li10] third step of Algorithm 1.
#[derive(Debug, Clone)]
pub struct HardBones {
    bones: Vec<Segment>,
    first_iteration: usize,
}

impl HardBones {
    /// A hook for observations with these columns that acts from this iteration on, counted from
    /// 1, or in the last one. Bones at markers that are never seen are left out.
    #[must_use]
    pub fn new(columns: &Columns, bones: &BoneSet, first_iteration: usize) -> Self {
        let place: HashMap<usize, usize> =
            columns.markers().iter().enumerate().map(|(k, &m)| (m, k)).collect();
        let segments = bones.bones().iter().filter_map(|bone| {
            let (a, b) = bone.markers();
            let ends = [*place.get(&a)?, *place.get(&b)?];
            Some(Segment { ends, length_m: bone.length_m() })
        });
        Self { bones: segments.collect(), first_iteration }
    }

    /// The groups for each set of missing markers, and which frame has which; frames in which no
    /// missing marker has a bone are left out.
    fn plans(&self, mask: ArrayView2<'_, bool>) -> (Vec<Vec<Group>>, Vec<(usize, usize)>) {
        let mut known: HashMap<Vec<bool>, usize> = HashMap::new();
        let mut plans = Vec::new();
        let mut jobs = Vec::new();
        for (t, row) in mask.rows().into_iter().enumerate() {
            let seen: Vec<bool> = row.iter().step_by(3).copied().collect();
            let plan = *known.entry(seen).or_insert_with_key(|seen| {
                plans.push(groups(&self.bones, seen));
                plans.len() - 1
            });
            if !plans[plan].is_empty() {
                jobs.push((t, plan));
            }
        }
        (plans, jobs)
    }
}

/// What the frames are solved from.
struct Frames<'a> {
    /// Predictions where missing, `(T, m)`.
    predicted: ArrayView2<'a, f64>,
    /// The fill of the iteration before, `(T, m)`.
    before: ArrayView2<'a, f64>,
    /// Reciprocal noise over its mean, `(m,)`.
    weight: Vec<f64>,
    /// Starts to try around a solution.
    nudges: usize,
}

impl Frames<'_> {
    fn solve(&self, t: usize, group: &Group) -> Vec<f64> {
        let row = self.predicted.row(t).to_vec();
        let problem = Problem {
            centre: &group.gather(&row),
            weight: &group.gather(&self.weight),
            sticks: &group.sticks(&row),
            lowest: &group.lowest,
        };
        let last = self.before.nrows() - 1;
        let near = [t, t.saturating_sub(1), (t + 1).min(last)];
        let near = if self.nudges > 0 { &near[..] } else { &near[..1] };
        let others: Vec<Vec<f64>> =
            near.iter().map(|&near| group.gather(&self.before.row(near).to_vec())).collect();
        let nudges = self.nudges * FEW / group.unknown.len().max(FEW);
        solver::solve(&problem, &others, nudges).places
    }
}

impl MissingUpdate for HardBones {
    fn update(&mut self, context: &UpdateContext<'_>, missing: &mut MissingEntries<'_>) {
        let before: Array2<f64> = missing.values().to_owned();
        missing.fill_from(context.prediction);
        let first = self.first_iteration.min(context.iterations);
        if context.iteration < first {
            return;
        }
        let (plans, jobs) = self.plans(context.mask);
        let precision = context.observation_noise.variances(before.ncols()).mapv(f64::recip);
        let mean = precision.mean().unwrap_or(1.0);
        let frames = Frames {
            predicted: missing.values(),
            before: before.view(),
            weight: precision.iter().map(|p| p / mean).collect(),
            // Whether bones can be kept depends on what is seen alone: a search that has succeeded
            // lives on in the fill, from which later iterations start as well.
            nudges: if context.iteration == first { solver::WIDE } else { 0 },
        };
        let solved: Vec<Vec<Vec<f64>>> = jobs
            .par_iter()
            .map(|&(t, plan)| plans[plan].iter().map(|group| frames.solve(t, group)).collect())
            .collect();
        for (&(t, plan), places) in jobs.iter().zip(&solved) {
            for (group, places) in plans[plan].iter().zip(places) {
                for (k, place) in group.unknown.iter().zip(places.chunks_exact(3)) {
                    (0..3).for_each(|a| missing.set(t, 3 * k + a, place[a]));
                }
            }
        }
    }
}
