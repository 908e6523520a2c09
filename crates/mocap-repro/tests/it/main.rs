//! The matrix as a whole, its tables, and what it refuses.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_cmp)] // tests fail by panicking, and compare exactly

mod errors;
mod evaluation;
mod protocols;
mod raw;
mod resume;
mod tables;

use std::path::{Path, PathBuf};

use mocap_repro::{
    Coordinates, Finished, Knowledge, Matrix, Motion, Store, Variant, fixture_trials, run,
};

pub(crate) fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures")
}

/// Methods of all kinds, with so few iterations that the matrix takes a second.
pub(crate) fn small_matrix() -> Matrix {
    let trials = fixture_trials();
    Matrix {
        motions: Motion::read_all(&fixtures(), trials.iter().map(|t| t.motion.as_str())).unwrap(),
        trials,
        variants: ["linear", "dynammo", "bolero-sc+lambda=0"]
            .map(|text| Variant::parse(text).unwrap())
            .to_vec(),
        coordinates: vec![Coordinates::Body, Coordinates::World],
        knowledge: vec![Knowledge::Oracle, Knowledge::Visible],
        iterations: Some(2),
    }
}

pub(crate) fn run_in<'a>(matrix: &'a Matrix, folder: &Path, threads: usize) -> Vec<Finished<'a>> {
    let mut store = Store::open(&folder.join("cells.jsonl")).unwrap();
    run(std::slice::from_ref(matrix), &mut store, threads, &|_| ()).unwrap()
}

pub(crate) fn same_results(a: &[Finished<'_>], b: &[Finished<'_>]) -> bool {
    a.len() == b.len()
        && a.iter().zip(b).all(|(x, y)| {
            x.trial == y.trial && x.variant == y.variant && x.outcome.same_result(&y.outcome)
        })
}
