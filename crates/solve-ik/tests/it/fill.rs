//! The kinematic fill keeps the contract of every filler, and holds limbs together.

use mocap_core::{GapFiller, Holdout, Mask, Refusal, geometry::distance};
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
