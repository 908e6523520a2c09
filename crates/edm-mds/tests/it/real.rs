//! Real recordings below `MOCAP_DATA`; skipped without it.

use std::{collections::HashMap, path::PathBuf, time::Instant};

use edm_mds::{Edm, EdmParams, EdmSolver};
use metrics::score;
use mocap_core::{GapFiller, Holdout, Mask, Take};
use mocap_io::{MarkerFile, ReadOptions};

fn data(folder: &str) -> Option<PathBuf> {
    let found = std::env::var_os("MOCAP_DATA").map(|root| PathBuf::from(root).join(folder));
    if found.is_none() {
        println!("skipped: MOCAP_DATA is not set");
    }
    found
}

/// The 90 holdouts: motion, marker name, hidden frames (one-based, end inclusive in the list).
fn trials(folder: &std::path::Path) -> Vec<Holdout> {
    let mut takes: HashMap<String, Take> = HashMap::new();
    let list = std::fs::read_to_string(folder.join("trials90.csv")).unwrap();
    let rows = list.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    rows.map(|row| {
        let take = takes.entry(row[1].to_owned()).or_insert_with(|| {
            let options = ReadOptions { rate_hz: Some(120.0), ..ReadOptions::default() };
            let file = folder.join(format!("{}.csv.gz", row[1]));
            MarkerFile::read(&file, &options).unwrap().take().clone()
        });
        let named = |m: &usize| take.markers().name(*m).ends_with(&format!(":{}", row[2]));
        let marker = (0..take.marker_count()).find(named).unwrap();
        let (start, end): (usize, usize) = (row[3].parse().unwrap(), row[4].parse().unwrap());
        let hidden = Mask::from_fn(take.frames(), take.marker_count(), |t, m| {
            m == marker && (start - 1..end).contains(&t)
        });
        Holdout::new(take.clone(), &hidden).unwrap()
    })
    .collect()
}

/// The bar is that of an independent implementation in another language, rounded up.
#[test]
fn ninety_trials_stay_below_the_bar() {
    let Some(folder) = data("cmu/bolero-nine") else { return };
    let trials = trials(&folder);
    assert_eq!(trials.len(), 90);
    for solver in [EdmSolver::Scaling, EdmSolver::Trilateration] {
        let filler = Edm::new(EdmParams { solver, ..EdmParams::default() }).unwrap();
        let started = Instant::now();
        let scores: Vec<_> = trials
            .iter()
            .map(|trial| {
                let filled = filler.fill(trial.visible()).unwrap();
                score(trial.truth(), filled.take(), trial.hidden()).unwrap()
            })
            .collect();
        let seconds = started.elapsed().as_secs_f64() / 90.0;
        assert!(scores.iter().all(|s| s.unfilled_cells == 0));
        let mse = scores.iter().map(|s| s.mse_m2).sum::<f64>() / 90.0;
        let mut means: Vec<f64> = scores.iter().map(|s| s.mean_mm).collect();
        means.sort_by(f64::total_cmp);
        let mean = means.iter().sum::<f64>() / 90.0;
        let median = 0.5 * (means[44] + means[45]);
        println!(
            "{solver:?}: mse {mse:.3e} m², mean {mean:.3} mm, median {median:.3} mm, {seconds:.4} s a trial"
        );
        assert!(mse <= 4.3e-4);
    }
}
