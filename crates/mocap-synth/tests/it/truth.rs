use mocap_core::{MarkerKnowledge, geometry::distance};
use mocap_synth::{Activity, SynthParams};

use crate::{params, record};

#[test]
fn labels_are_those_of_the_cmu_set() {
    let recorded = record(params(Activity::Walk, 0));
    assert_eq!(recorded.take().markers().names(), MarkerKnowledge::cmu_41().markers());
    assert_eq!(recorded.bones().len(), 47);
}

#[test]
fn joints_are_the_forward_kinematics_of_the_motion() {
    for activity in Activity::ALL {
        let recorded = record(SynthParams { frames: 300, ..params(activity, 4) });
        let motion = recorded.motion();
        for (t, pose) in motion.poses().iter().enumerate() {
            let positions = motion.skeleton().positions(pose).unwrap();
            for (j, expected) in positions.into_iter().enumerate() {
                let found = [0, 1, 2].map(|a| recorded.joints()[(t, j, a)]);
                // Two ways to multiply the same rotations, 22 deep, at metre scale.
                assert!(distance(expected, found) < 1e-12);
            }
        }
    }
}

#[test]
fn noise_has_the_deviation_that_was_asked_for() {
    let recorded = record(SynthParams { noise_m: 0.001, ..params(Activity::Throw, 9) });
    let (take, truth) = (recorded.take(), recorded.truth());
    let (mut sum, mut squares, mut n) = (0.0, 0.0, 0.0);
    for t in 0..take.frames() {
        for m in 0..take.marker_count() {
            let (p, q) = (take.position(t, m).unwrap(), truth.position(t, m).unwrap());
            for a in 0..3 {
                sum += p[a] - q[a];
                squares += (p[a] - q[a]).powi(2);
                n += 1.0;
            }
        }
    }
    // 147 600 draws: the standard error is 2.6e-6 of the mean and 1.9e-6 of the deviation.
    assert!((sum / n).abs() < 1.1e-5);
    assert!(((squares / n).sqrt() - 0.001).abs() < 8e-6);
}

#[test]
fn without_soft_tissue_and_noise_a_head_is_rigid() {
    let params = SynthParams { noise_m: 0.0, soft_tissue: 0.0, ..params(Activity::Jump, 2) };
    let take = record(params).into_take();
    let [front, back] = ["LFHD", "RBHD"].map(|name| take.markers().find(name).unwrap());
    let first = take.distance(0, front, back).unwrap();
    for t in 0..take.frames() {
        assert!((take.distance(t, front, back).unwrap() - first).abs() < 1e-12);
    }
}

#[test]
fn soft_tissue_moves_more_where_the_body_shakes_more() {
    let sliding = |activity: Activity| {
        let loose = record(params(activity, 8));
        let glued = record(SynthParams { soft_tissue: 0.0, ..params(activity, 8) });
        let thigh = loose.take().markers().find("RTHI").unwrap();
        let n = loose.take().frames();
        let apart = |t: usize| {
            let at = |k: &mocap_synth::SyntheticTake| k.truth().position(t, thigh).unwrap();
            distance(at(&loose), at(&glued)).powi(2)
        };
        ((0..n).map(apart).sum::<f64>() / n as f64).sqrt()
    };
    let (walk, run) = (sliding(Activity::Walk), sliding(Activity::Run));
    // Skin over the thigh slides by some millimetres in walking and by 1 to 2 cm in running.
    assert!((0.001..0.015).contains(&walk), "{walk}");
    assert!((1.3 * walk..0.03).contains(&run), "{run}");
}

#[test]
fn a_jumper_in_the_air_falls_freely() {
    let recorded = record(params(Activity::Jump, 3));
    let z = |t: usize| recorded.joints()[(t, 0, 2)];
    let falling = |t: usize| {
        let acceleration = (z(t + 1) - 2.0 * z(t) + z(t - 1)) * 120.0 * 120.0;
        (acceleration + 9.81).abs() < 0.05
    };
    let mut longest = 0;
    let mut run = 0;
    for t in 1..1199 {
        run = if falling(t) { run + 1 } else { 0 };
        longest = longest.max(run);
    }
    // A rise of 17 cm, the least that is drawn, takes 0.37 s.
    assert!(longest >= 40, "{longest} frames");
}

#[test]
fn stature_scales_the_body() {
    let crown = |stature_m: f64| {
        let take = record(SynthParams { stature_m, ..params(Activity::Throw, 1) }).into_take();
        let head = take.markers().find("LFHD").unwrap();
        (0..take.frames()).map(|t| take.position(t, head).unwrap()[2]).fold(0.0, f64::max)
    };
    for stature_m in [1.2, 1.5, 1.75, 2.2] {
        // The front of the head sits 6 to 10 % below the crown; the stance lowers it a little.
        let share = crown(stature_m) / stature_m;
        assert!((0.86..0.98).contains(&share), "{stature_m}: {share}");
    }
}
