//! Real recordings below `MOCAP_DATA`; skipped without it.

use std::time::Instant;

use edm_mds::{Edm, EdmParams, EdmSolver};
use metrics::score;
use mocap_core::GapFiller;
use mocap_testkit::ninety_trials;

/// The bar is that of an independent implementation in another language, rounded up.
#[test]
fn ninety_trials_stay_below_the_bar() {
    let Some(trials) = ninety_trials() else { return };
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
