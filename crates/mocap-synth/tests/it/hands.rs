use mocap_core::{Rotation, geometry::norm};
use mocap_synth::{Activity, Hands, Layout, Person, SynthParams, SyntheticTake, finger_angles};
use proptest::prelude::*;

use crate::{params, record};

fn wearing(hands: Hands, seed: u64, frames: usize) -> SyntheticTake {
    let person = Some(Person::draw(seed));
    let layout = Layout::FrontWaist53;
    record(SynthParams { hands, person, layout, frames, ..params(Activity::Reach, seed) })
}

/// Spreading and bending of a finger's first joint, which turns about x first and about y then.
fn knuckle(rotation: Rotation, side: f64) -> [f64; 2] {
    let m = rotation.matrix();
    [-m[0][2].atan2(m[0][0]), -side * (-m[1][2]).atan2(m[1][1])]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn fingers_stay_within_the_limits_of_their_joints(seed in any::<u64>()) {
        let recorded = wearing(Hands::Five, seed, 600);
        let skeleton = recorded.motion().skeleton();
        for (word, side) in [("left", 1.0), ("right", -1.0)] {
            // The thumb's axes are its own: see the next test.
            for angle in finger_angles().filter(|a| !a.joint.starts_with("thumb")) {
                let joint = skeleton.find(&format!("{word}_{}", angle.joint)).unwrap();
                for pose in recorded.motion().poses() {
                    let [spread, bend] = knuckle(pose.rotations[joint], side);
                    let found = if angle.spreads { spread } else { bend };
                    let [low, high] = angle.limits;
                    // Sines and arc tangents there and back.
                    prop_assert!(
                        (low - 1e-9..=high + 1e-9).contains(&found),
                        "{word} {}: {found} not in {low} to {high}", angle.joint
                    );
                }
            }
        }
    }

    #[test]
    fn the_thumbs_hinges_turn_no_further_than_they_may(seed in any::<u64>()) {
        let recorded = wearing(Hands::Five, seed, 600);
        let skeleton = recorded.motion().skeleton();
        for angle in finger_angles().filter(|a| ["thumb2", "thumb3"].contains(&a.joint)) {
            for word in ["left", "right"] {
                let joint = skeleton.find(&format!("{word}_{}", angle.joint)).unwrap();
                let most = angle.limits[1].max(-angle.limits[0]);
                for pose in recorded.motion().poses() {
                    prop_assert!(pose.rotations[joint].angle() <= most + 1e-9);
                }
            }
        }
    }
}

#[test]
fn tips_touch_now_and_then() {
    // Over two minutes a hand pinches a dozen times.
    let recorded = wearing(Hands::Ten, 4, 14_400);
    let take = recorded.truth();
    let [thumb, index] = ["RTHM6", "RIDX6"].map(|name| take.markers().find(name).unwrap());
    let mut nearest = f64::INFINITY;
    let mut farthest: f64 = 0.0;
    for t in 0..take.frames() {
        let apart = take.distance(t, thumb, index).unwrap();
        nearest = nearest.min(apart);
        farthest = farthest.max(apart);
    }
    // The markers sit on the nails: two fingers' thickness lies between when the pads meet.
    assert!((0.010..0.040).contains(&nearest), "{nearest}");
    assert!((0.09..0.20).contains(&farthest), "{farthest}");
}

#[test]
fn finger_markers_keep_to_their_bones() {
    let recorded = wearing(Hands::Ten, 9, 600);
    for attachment in recorded.attachments().iter().skip(53) {
        let [near, _] = attachment.local_m;
        // The tip is the farthest: two thirds of the last bone along and its thickness up.
        assert!(norm(near) < 0.035, "{}: {near:?}", attachment.label);
    }
}
