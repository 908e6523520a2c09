//! The kinematic fill keeps the contract of every filler, and holds limbs together.

use mocap_core::{GapFiller, Holdout, Mask, Refusal, Take, geometry::distance};
use mocap_synth::Activity;
use mocap_testkit::{Claims, conformance};
use solve_ik::{Body, IkFiller, IkParams};

use crate::worn::{record, synthetic_body};

/// The two segments of `mocap_testkit::articulated_take`.
const SEGMENTS: &str = "joint upper\njoint lower upper 0 0 -0.45\n\
    marker A0 upper 0.05 0.04 -0.05\nmarker A1 upper -0.05 0.03 -0.15\n\
    marker A2 upper 0.04 -0.05 -0.28\nmarker A3 upper -0.03 -0.04 -0.40\n\
    marker B0 lower 0.05 0.04 -0.05\nmarker B1 lower -0.05 0.03 -0.15\n\
    marker B2 lower 0.04 -0.05 -0.28\nmarker B3 lower -0.03 -0.04 -0.40\n";

fn filler(body: Body) -> IkFiller {
    IkFiller::new(vec![Body::cmu_41(), body], IkParams::default()).unwrap()
}

#[test]
fn the_filler_conforms() {
    let filler = filler(Body::parse(SEGMENTS, "segments").unwrap());
    let claims = Claims { rigid_motion_m: Some(1e-4), permutation_m: Some(1e-4) };
    conformance(&filler, &claims);
}

#[test]
fn a_hidden_forearm_stays_on_its_elbow() {
    let recorded = record(Activity::Run, 400, 8);
    let take = recorded.take();
    let limb = ["LFRM", "LWRA", "LWRB", "LFIN"].map(|name| take.markers().find(name).unwrap());
    let hidden = Mask::from_fn(400, 41, |t, m| limb.contains(&m) && (150..210).contains(&t));
    let holdout = Holdout::new(take.clone(), &hidden).unwrap();
    let filler = IkFiller::new(vec![synthetic_body()], IkParams::default()).unwrap();
    let filled = filler.fill(holdout.visible()).unwrap();
    let elbow = take.markers().find("LELB").unwrap();
    let mut worst = 0.0_f64;
    for (t, m) in hidden.iter() {
        let bone = distance(
            filled.take().position(t, m).unwrap(),
            filled.take().position(t, elbow).unwrap(),
        );
        let truth = distance(take.position(t, m).unwrap(), take.position(t, elbow).unwrap());
        worst = worst.max((bone - truth).abs());
    }
    println!("{:.1} mm", 1e3 * worst);
    // The elbow's marker slides on the skin by some millimetres, and the hand bends by as much as it likes.
    assert!(worst < 0.05, "{worst} m");
}

#[test]
fn a_marker_that_the_map_does_not_know_rides_along() {
    let recorded = record(Activity::Walk, 300, 9);
    let body = synthetic_body().to_string();
    let without: String =
        body.split_inclusive('\n').filter(|line| !line.starts_with("marker LSHN")).collect();
    let filler =
        IkFiller::new(vec![Body::parse(&without, "x").unwrap()], IkParams::default()).unwrap();
    let take = recorded.take();
    let shin = take.markers().find("LSHN").unwrap();
    let hidden = Mask::from_fn(300, 41, |t, m| m == shin && (100..160).contains(&t));
    let holdout = Holdout::new(take.clone(), &hidden).unwrap();
    let filled = filler.fill(holdout.visible()).unwrap();
    for (t, m) in hidden.iter() {
        let off = distance(filled.take().position(t, m).unwrap(), take.position(t, m).unwrap());
        // Soft tissue of the shank.
        assert!(off < 0.02, "{t}: {off} m");
    }
    let never = Mask::from_fn(300, 41, |_, m| m == shin);
    let filled = filler.fill(&take.hide(&never).unwrap()).unwrap();
    assert_eq!(filled.report().refusals[0].reason, Refusal::NeverSeen);
}

/// Mean errors in metres of the kinematic fill and of straight lines, for a limb that is gone for half a second.
fn limb_errors(take: &Take, limb: &[&str], start: usize) -> [f64; 2] {
    let holdout = mocap_testkit::hide(take.clone(), limb, start + 1, start + 60);
    let filler = IkFiller::new(vec![Body::cmu_41()], IkParams::default()).unwrap();
    let filled = filler.fill(holdout.visible()).unwrap();
    let (mut by_body, mut by_line, mut count) = (0.0, 0.0, 0.0);
    for (t, m) in holdout.hidden().iter() {
        let truth = take.position(t, m).unwrap();
        let (a, b) = (take.position(start - 1, m).unwrap(), take.position(start + 60, m).unwrap());
        let share = (t + 1 - start) as f64 / 61.0;
        by_body += distance(filled.take().position(t, m).unwrap(), truth);
        by_line += distance(std::array::from_fn(|c| a[c] + share * (b[c] - a[c])), truth);
        count += 1.0;
    }
    [by_body / count, by_line / count]
}

#[test]
fn whole_limbs_of_real_takes_are_filled_better_than_by_straight_lines() {
    let limbs: [&[&str]; 2] = [
        &["LUPA", "LELB", "LFRM", "LWRA", "LWRB", "LFIN"],
        &["RTHI", "RKNE", "RSHN", "RANK", "RHEE", "RMT5", "RTOE"],
    ];
    let mut sums = [0.0; 2];
    let mut trials = 0;
    for name in ["127_07", "132_43"] {
        let Some(take) = mocap_testkit::motion(name) else { continue };
        for limb in limbs {
            let start = (take.frames() - 60) / 2;
            let [by_body, by_line] = limb_errors(&take, limb, start);
            println!("{name} {}: {:.1} mm, lines {:.1} mm", limb[0], 1e3 * by_body, 1e3 * by_line);
            sums = [sums[0] + by_body, sums[1] + by_line];
            trials += 1;
        }
    }
    let mean = sums.map(|sum| 1e3 * sum / f64::from(trials.max(1)));
    println!("{trials} trials: {:.1} mm, lines {:.1} mm on average", mean[0], mean[1]);
    assert!(trials == 0 || sums[0] < 0.4 * sums[1], "{sums:?}");
}
