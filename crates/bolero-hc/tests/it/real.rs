//! Reconstruction of the paper's motions.

use std::time::Instant;

use bolero_hc::{BoleroHc, BoleroHcParams};
use lds_kalman::filler::LdsFillerParams;
use mocap_core::{BoneReport, BoneSource, GapFiller, Holdout};
use mocap_testkit::{hide, motion, mse, oracle_bones};

fn knee_and_shin() -> Option<Holdout> {
    Some(hide(motion("127_07")?, &["RKNE", "RSHN"], 25, 90))
}

fn elbow_and_forearm() -> Option<Holdout> {
    Some(hide(motion("132_43")?, &["RELB", "RFRM"], 100, 500))
}

/// These settings with the lengths of the whole motion.
fn oracle(holdout: &Holdout, params: BoleroHcParams, iterations: usize) -> BoleroHcParams {
    BoleroHcParams {
        model: LdsFillerParams { iterations, tolerance: 0.0, seed: 1, ..params.model },
        bones: BoneSource::Given(oracle_bones(holdout.truth())),
        ..params
    }
}

/// Mean squared error in m², and what became of the bones.
fn error(params: BoleroHcParams, holdout: &Holdout) -> (f64, BoneReport) {
    let start = Instant::now();
    let filler = BoleroHc::new(params).unwrap();
    let filled = filler.fill(holdout.visible()).unwrap();
    let report = filled.report().bones.clone().unwrap();
    let mse = mse(holdout, filled.take());
    let worst = report.infeasible.iter().map(|broken| broken.residual_m).fold(0.0, f64::max);
    println!(
        "{mse:.3e} m², {} of {} frames infeasible, worst by {worst:.1e} m, {} iterations, {:.2} s",
        report.infeasible.len(),
        report.constrained,
        filled.report().iterations,
        start.elapsed().as_secs_f64(),
    );
    (mse, report)
}

#[test]
fn published_settings_give_the_published_errors() {
    let (Some(knee), Some(elbow)) = (knee_and_shin(), elbow_and_forearm()) else { return };
    // The authors' code over five seeds: 1.6e-4 to 3.9e-4 and 2.3e-4 to 2.8e-4 m², the upper ends
    // where its iteration wanders off.
    let (knee_mse, report) = error(oracle(&knee, BoleroHcParams::published(), 100), &knee);
    assert!((1.5e-4..4e-4).contains(&knee_mse), "{knee_mse:e} m²");
    assert!(report.infeasible.is_empty(), "{report:?}");
    let (elbow_mse, _) = error(oracle(&elbow, BoleroHcParams::published(), 100), &elbow);
    assert!((2.0e-4..2.8e-4).contains(&elbow_mse), "{elbow_mse:e} m²");
}

#[test]
fn defaults_reconstruct_a_hidden_knee_from_what_is_visible() {
    let Some(holdout) = knee_and_shin() else { return };
    let (mse, report) = error(BoleroHcParams::default(), &holdout);
    // A straight line has 3.1e-2 m².
    assert!(mse < 6e-4, "{mse:e} m²");
    assert!(report.infeasible.is_empty(), "{report:?}");
}

#[test]
fn a_blackout_does_not_diverge() {
    let Some(truth) = motion("132_43") else { return };
    let all = truth.markers().clone();
    let names: Vec<&str> = all.names().iter().map(String::as_str).collect();
    let holdout = hide(truth, &names, 300, 324);
    let (mse, _) = error(oracle(&holdout, BoleroHcParams::published(), 30), &holdout);
    // The authors' code diverges to kilometres; their soft bones have 6.4e-3 m².
    assert!(mse < 2e-2, "{mse:e} m²");
}
