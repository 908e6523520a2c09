//! One thing changed at a time: the weight of the bones, the start, the number of iterations.

use mocap_report::Entry;

use super::set;
use crate::{Finished, Matrix, Row, Section, Stats, Trial, Variant};

/// What is swept.
#[derive(Debug, Clone)]
pub(super) struct Sweeps {
    /// Powers of ten of lambda.
    lambdas: Vec<u32>,
    seeds: Vec<u64>,
    caps: Vec<usize>,
    iterations: usize,
}

/// The methods whose start is drawn, and what they are called then.
const SEEDED: [&str; 5] = [
    "dynammo+published",
    "bolero-sc+published+lambda=0",
    "bolero-sc+published",
    "bolero-sc+published+lambda=100",
    "bolero-hc+published",
];
const CAPPED: [&str; 6] = [
    "dynammo+published",
    "bolero-sc+published",
    "bolero-hc+published",
    "lds",
    "bolero-sc",
    "bolero-hc",
];

impl Sweeps {
    pub(super) fn full() -> Self {
        Self {
            lambdas: (0..=8).collect(),
            seeds: (1..=5).collect(),
            caps: vec![2, 5, 11, 20, 50, 100, 200],
            iterations: 100,
        }
    }

    pub(super) fn quick() -> Self {
        Self { lambdas: vec![0, 3, 6], seeds: vec![1, 2], caps: vec![2, 5, 20], iterations: 20 }
    }

    /// The sweeps of those of the methods that are run at all, on the running, the walking and the
    /// black-out case.
    pub(super) fn matrices(
        &self,
        variants: &[Variant],
        [running, walking, blackout]: [Option<&Trial>; 3],
        as_paper: impl Fn(&[Trial]) -> Matrix,
    ) -> Vec<Matrix> {
        let has = |label: &str| {
            let id = label.split('+').next();
            variants.iter().any(|variant| Some(variant.id()) == id)
        };
        let parsed = |labels: &[String]| -> Vec<Variant> {
            let own = labels.iter().filter(|label| has(label));
            own.filter_map(|label| Variant::parse(label).ok()).collect()
        };
        let with = |trials: Vec<Trial>, labels: Vec<String>| {
            let variants = parsed(&labels);
            (!variants.is_empty() && !trials.is_empty())
                .then(|| Matrix { variants, ..as_paper(&trials) })
        };
        let lambdas =
            self.lambdas.iter().map(|power| format!("bolero-sc+published+lambda=1e{power}"));
        let seeded = SEEDED.map(str::to_owned);
        let of_seed = |case: &Trial, seed: u64| Trial {
            set: set::SEEDS.to_owned(),
            name: format!("{}, seed {seed}", case.name),
            seed,
            iterations: Some(self.iterations),
            ..case.clone()
        };
        let capped = |case: &Trial, cap: usize| Trial {
            set: set::CAPS.to_owned(),
            class: format!("{}, iteration {cap}", case.name),
            name: format!("{}, iteration {cap}", case.name),
            iterations: Some(cap),
            ..case.clone()
        };
        let lambda = |case: &Trial| Trial {
            set: set::LAMBDA.to_owned(),
            iterations: Some(self.iterations),
            ..case.clone()
        };
        let seeds = [running, walking]
            .into_iter()
            .flatten()
            .flat_map(|case| self.seeds.iter().map(|&seed| of_seed(case, seed)).collect::<Vec<_>>())
            .collect();
        let caps = [running, blackout]
            .into_iter()
            .flatten()
            .flat_map(|case| self.caps.iter().map(|&cap| capped(case, cap)).collect::<Vec<_>>())
            .collect();
        [
            with(running.map(lambda).into_iter().collect(), lambdas.collect()),
            with(seeds, seeded.into()),
            with(caps, CAPPED.map(str::to_owned).into()),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

/// The tables of the sweeps.
pub(super) fn sections(rows: &[Row]) -> Vec<Section> {
    let of = |set: &str| rows.iter().filter(|row| row.set == set).collect::<Vec<_>>();
    let lambda = of(set::LAMBDA).into_iter().map(|row| {
        vec![
            Entry::text(&row.class),
            Entry::text(&row.method),
            Entry::scientific(row.stats.mse_mean),
            Entry::number(row.stats.bone_mm, 2),
        ]
    });
    let seeds = of(set::SEEDS).into_iter().map(|row| {
        vec![
            Entry::text(&row.class),
            Entry::text(&row.method),
            Entry::count(row.stats.trials),
            Entry::scientific(row.stats.mse_min),
            Entry::scientific(row.stats.mse_median),
            Entry::scientific(row.stats.mse_max),
        ]
    });
    let caps = of(set::CAPS).into_iter().map(|row| {
        vec![
            Entry::text(&row.class),
            Entry::text(&row.method),
            Entry::scientific(row.stats.mse_mean),
        ]
    });
    let sections = [
        Section::new(
            "lambda",
            "Weight of the bones",
            "mse in m² of the running case by the weight lambda of the soft bone lengths.",
            &["case", "method", "mse", "bone mm"],
            lambda,
        ),
        Section::new(
            "seeds",
            "Spread over random starts",
            "mse in m² over the seeds. The default start is computed from the data and has no spread.",
            &["case", "method", "seeds", "least mse", "median mse", "largest mse"],
            seeds,
        ),
        Section::new(
            "iterations",
            "Error by EM iteration",
            "mse in m² when EM is stopped after so many iterations.",
            &["case", "method", "mse"],
            caps,
        ),
    ];
    sections.into_iter().filter(|section| !section.table.is_empty()).collect()
}

/// Mean mse of a set of cells.
pub(super) fn mean_mse(cells: &[&Finished<'_>]) -> Option<f64> {
    Stats::of(cells.iter().map(|cell| &cell.outcome)).mse_mean
}
