//! Reconstruction of the paper's motions.

use bolero_sc::{BoleroSc, BoleroScParams};
use lds_kalman::{
    EStep,
    filler::{LdsFiller, LdsFillerParams},
};
use mocap_core::{BoneSource, GapFiller, Holdout};
use mocap_testkit::{hide, motion, mse, ninety_trials, oracle_bones};
use rayon::prelude::*;

fn knee_and_shin() -> Option<Holdout> {
    Some(hide(motion("127_07")?, &["RKNE", "RSHN"], 25, 90))
}

fn elbow_and_forearm() -> Option<Holdout> {
    Some(hide(motion("132_43")?, &["RELB", "RFRM"], 100, 500))
}

/// The settings of the paper, with the lengths of the whole motion.
fn published(holdout: &Holdout, iterations: usize) -> BoleroSc {
    let mut params = BoleroScParams::published();
    params.model = LdsFillerParams { iterations, tolerance: 0.0, seed: 1, ..params.model };
    params.bones = BoneSource::Given(oracle_bones(holdout.truth()));
    BoleroSc::new(params).unwrap()
}

fn error(filler: &dyn GapFiller, holdout: &Holdout) -> f64 {
    mse(holdout, filler.fill(holdout.visible()).unwrap().take())
}

#[test]
fn defaults_reconstruct_a_hidden_knee_from_what_is_visible() {
    let Some(holdout) = knee_and_shin() else { return };
    let mse = error(&BoleroSc::default(), &holdout);
    // A straight line has 3.1e-2 m². The defaults, chosen on other motions, have 4.1e-4 here, where the
    // published steps are among their best with 2.7e-4.
    assert!(mse < 6e-4, "{mse:e} m²");
}

#[test]
fn exact_em_beats_the_published_steps_without_knowing_the_hidden_lengths() {
    let Some(trials) = ninety_trials() else { return };
    let published = BoleroSc::new(BoleroScParams::published()).unwrap();
    let default = BoleroSc::default();
    // Ten of all nine motions: long and short, with and without bones.
    let (mut before, mut now): (Vec<f64>, Vec<f64>) = trials
        .par_iter()
        .step_by(9)
        .map(|holdout| (error(&published, holdout), error(&default, holdout)))
        .unzip();
    let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
    assert!(mean(&now) < 0.8 * mean(&before), "{:e} {:e}", mean(&now), mean(&before));
    let median = |errors: &mut Vec<f64>| {
        errors.sort_by(f64::total_cmp);
        errors[errors.len() / 2]
    };
    assert!(median(&mut now) < 0.8 * median(&mut before));
}

#[test]
fn published_settings_give_the_published_errors() {
    let Some(knee) = knee_and_shin() else { return };
    let Some(elbow) = elbow_and_forearm() else { return };
    // The authors' code: 2.7e-4 to 2.9e-4 and 2.2e-4 m². Seeds and an inner loop that stops early
    // account for a spread of ten per cent.
    let knee_mse = error(&published(&knee, 200), &knee);
    assert!((2.4e-4..3.2e-4).contains(&knee_mse), "{knee_mse:e} m²");
    let elbow_mse = error(&published(&elbow, 100), &elbow);
    assert!((2.0e-4..2.4e-4).contains(&elbow_mse), "{elbow_mse:e} m²");
    // The authors' code: 5.0e-3 to 5.8e-3 m² over five seeds.
    let plain =
        LdsFillerParams { e_step: EStep::Dynammo, ..published(&knee, 200).params().model.clone() };
    let plain = LdsFiller::new(plain).unwrap();
    let plain_mse = error(&plain, &knee);
    assert!((3.5e-3..7e-3).contains(&plain_mse), "{plain_mse:e} m²");
}

/// All markers hidden in the given frames, counted from 1.
fn black_out(name: &str, first: usize, frames: usize) -> Option<Holdout> {
    let truth = motion(name)?;
    let names: Vec<String> = truth.markers().names().iter().map(ToString::to_string).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Some(hide(truth, &names, first, first + frames - 1))
}

#[test]
fn a_black_out_is_filled_as_well_as_by_the_plain_system() {
    let cases = [("132_43", 300, 25), ("141_16", 100, 10), ("132_32", 300, 60)];
    for (name, first, frames) in cases {
        let Some(holdout) = black_out(name, first, frames) else { return };
        let plain = error(&LdsFiller::new(LdsFillerParams::default()).unwrap(), &holdout);
        let soft = error(&BoleroSc::default(), &holdout);
        // No bone has anything to hold on to: both are the same system.
        assert!(soft < 1.001 * plain, "{name}, {frames} frames: {soft:e} m², plain {plain:e} m²");
    }
    let Some(holdout) = black_out("132_43", 300, 25) else { return };
    let held = error(&BoleroSc::new(BoleroScParams::published()).unwrap(), &holdout);
    // The authors' code has 6.4e-3 m² there: fills that count hold on to what came first.
    assert!(held > 1e-3, "{held:e} m²");
}

#[test]
fn five_markers_of_an_arm_come_back_to_the_published_error() {
    let Some(truth) = motion("80_10") else { return };
    let arm = hide(truth, &["RELB", "RFRM", "RWRA", "RWRB", "RFIN"], 100, 300);
    let mse = error(&published(&arm, 100), &arm);
    // The authors' code: 6.9e-3 m², and 6.7e-3 to 7.0e-3 here over four seeds.
    assert!((6e-3..8e-3).contains(&mse), "{mse:e} m²");
}
