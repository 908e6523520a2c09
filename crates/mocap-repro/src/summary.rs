use serde::Serialize;

use crate::{Coordinates, Finished, Knowledge, Outcome, Sureness};

/// The trials of one group, by one method, under one set of conditions, taken together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Set of trials.
    pub set: String,
    /// Group within the set.
    pub class: String,
    /// Coordinates.
    pub coordinates: Coordinates,
    /// What the method was told.
    pub knowledge: Knowledge,
    /// The method.
    pub method: String,
    /// The figures.
    pub stats: Stats,
}

/// Figures over trials. Each trial counts once, however many samples it hides; trials of which nothing
/// was filled are in no error figure, so read these together with `unfilled` and `failed`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Stats {
    /// Trials.
    pub trials: usize,
    /// Trials on which the method could not run at all.
    pub failed: usize,
    /// Hidden samples of all trials.
    pub hidden: usize,
    /// Hidden samples that were left open.
    pub unfilled: usize,
    /// Mean over trials of the mean square error in m².
    pub mse_mean: Option<f64>,
    /// Median over trials.
    pub mse_median: Option<f64>,
    /// Third quartile over trials.
    pub mse_p75: Option<f64>,
    /// Worst trial.
    pub mse_max: Option<f64>,
    /// Mean over trials of the mean 3-D error in mm.
    pub mm_mean: Option<f64>,
    /// Median over trials of the mean 3-D error in mm.
    pub mm_median: Option<f64>,
    /// Mean over trials of the 95 % quantile of the 3-D error in mm.
    pub mm_p95: Option<f64>,
    /// Mean over trials of the deviation from bone length in mm.
    pub bone_mm: Option<f64>,
    /// Smallest trial.
    pub mse_min: Option<f64>,
    /// Mean over trials of the step at the borders of gaps in mm.
    pub border_mm: Option<f64>,
    /// Median over trials of the root mean square acceleration, fill by truth.
    pub acceleration_ratio: Option<f64>,
    /// Median over trials of the root mean square jerk, fill by truth.
    pub jerk_ratio: Option<f64>,
    /// What became of the stated sigmas, over the samples of all trials.
    pub sureness: Sureness,
    /// Mean seconds a trial, on one thread.
    pub seconds: Option<f64>,
}

impl Stats {
    /// Takes outcomes together.
    #[must_use]
    pub fn of<'a>(outcomes: impl IntoIterator<Item = &'a Outcome>) -> Self {
        let all: Vec<&Outcome> = outcomes.into_iter().collect();
        let sorted = |value: fn(&Outcome) -> Option<f64>| {
            let mut values: Vec<f64> = all.iter().filter_map(|outcome| value(outcome)).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let mse = sorted(|outcome| outcome.mse_m2);
        let mm = sorted(|outcome| outcome.mean_mm);
        Self {
            trials: all.len(),
            failed: all.iter().filter(|outcome| outcome.error.is_some()).count(),
            hidden: all.iter().map(|outcome| outcome.hidden).sum(),
            unfilled: all.iter().map(|outcome| outcome.unfilled).sum(),
            mse_mean: mean(&mse),
            mse_median: median(&mse),
            mse_p75: metrics::quantile(&mse, 0.75),
            mse_max: mse.last().copied(),
            mm_mean: mean(&mm),
            mm_median: median(&mm),
            mm_p95: mean(&sorted(|outcome| outcome.p95_mm)),
            bone_mm: mean(&sorted(|outcome| outcome.bone_mm)),
            mse_min: mse.first().copied(),
            border_mm: mean(&sorted(|outcome| outcome.border_mm)),
            acceleration_ratio: median(&sorted(|outcome| outcome.acceleration_ratio)),
            jerk_ratio: median(&sorted(|outcome| outcome.jerk_ratio)),
            sureness: Sureness::sum(&all.iter().map(|o| o.sureness()).collect::<Vec<_>>()),
            seconds: mean(&sorted(|outcome| Some(outcome.seconds))),
        }
    }

    /// The figure that reference tables call by this name.
    pub(crate) fn named(&self, name: &str) -> Option<f64> {
        match name {
            "mse_mean" => self.mse_mean,
            "mse_median" => self.mse_median,
            "mse_p75" => self.mse_p75,
            "mse_min" => self.mse_min,
            "mse_max" => self.mse_max,
            "mm_mean" => self.mm_mean,
            "mm_median" => self.mm_median,
            "seconds" => self.seconds,
            _ => None,
        }
    }
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

fn median(ascending: &[f64]) -> Option<f64> {
    metrics::quantile(ascending, 0.5)
}

/// One row for each group, condition and method, in the order of the cells.
#[must_use]
pub fn summarise(cells: &[Finished<'_>]) -> Vec<Row> {
    group(cells, |cell| {
        (
            cell.trial.set.as_str(),
            cell.trial.class.as_str(),
            cell.coordinates,
            cell.knowledge,
            cell.variant.label(),
        )
    })
    .into_iter()
    .map(|((set, class, coordinates, knowledge, method), cells)| Row {
        set: set.to_owned(),
        class: class.to_owned(),
        coordinates,
        knowledge,
        method: method.to_owned(),
        stats: Stats::of(cells.into_iter().map(|cell| &cell.outcome)),
    })
    .collect()
}

/// Cells with the same key together; the keys in the order in which they first come.
pub(crate) fn group<'a, 'b, K: PartialEq>(
    cells: &'a [Finished<'b>],
    key: impl Fn(&'a Finished<'b>) -> K,
) -> Vec<(K, Vec<&'a Finished<'b>>)> {
    let mut groups: Vec<(K, Vec<&Finished<'_>>)> = Vec::new();
    for cell in cells {
        let key = key(cell);
        match groups.iter_mut().find(|(other, _)| *other == key) {
            Some((_, members)) => members.push(cell),
            None => groups.push((key, vec![cell])),
        }
    }
    groups
}

/// How often one method is better than another on the same trials.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Duel {
    /// Set of trials.
    pub set: String,
    /// Coordinates.
    pub coordinates: Coordinates,
    /// What the methods were told.
    pub knowledge: Knowledge,
    /// One method.
    pub method: String,
    /// The other.
    pub against: String,
    /// Trials on which the first has the smaller mean square error.
    pub wins: usize,
    /// Trials that both filled.
    pub trials: usize,
    /// Median over trials of the other's mean square error by the first's.
    pub median_ratio: Option<f64>,
}

/// Every pair of a method in `methods` and one in `against`, set by set.
#[must_use]
pub fn duels(cells: &[Finished<'_>], methods: &[&str], against: &[&str]) -> Vec<Duel> {
    let mut duels = Vec::new();
    let conditions =
        group(cells, |cell| (cell.trial.set.as_str(), cell.coordinates, cell.knowledge));
    for ((set, coordinates, knowledge), members) in conditions {
        let errors = |method: &str| -> Vec<(&str, f64)> {
            let of_method = members.iter().filter(|cell| cell.variant.label() == method);
            of_method
                .filter_map(|cell| Some((cell.trial.name.as_str(), cell.outcome.mse_m2?)))
                .collect()
        };
        for (method, other) in methods.iter().flat_map(|m| against.iter().map(move |o| (*m, *o))) {
            let (ours, theirs) = (errors(method), errors(other));
            let pairs: Vec<(f64, f64)> = ours
                .iter()
                .filter_map(|(name, x)| {
                    theirs.iter().find(|(other, _)| other == name).map(|(_, y)| (*x, *y))
                })
                .collect();
            if method == other || pairs.is_empty() {
                continue;
            }
            let mut ratios: Vec<f64> = pairs.iter().map(|(x, y)| y / x).collect();
            ratios.sort_by(f64::total_cmp);
            duels.push(Duel {
                set: set.to_owned(),
                coordinates,
                knowledge,
                method: method.to_owned(),
                against: other.to_owned(),
                wins: pairs.iter().filter(|(x, y)| x < y).count(),
                trials: pairs.len(),
                median_ratio: metrics::quantile(&ratios, 0.5).filter(|ratio| ratio.is_finite()),
            });
        }
    }
    duels
}
