//! Bounds come from the nine CMU recordings of [Li10]'s experiments (41 markers, 120 Hz, seven
//! subjects, from waving over walking to running, jumping and throwing), measured over their 42 to 47 named
//! bones and all markers, with central differences:
//!
//! | per recording | lowest | highest |
//! |---|---|---|
//! | median over bones of the length's deviation | 1.8 mm | 6.0 mm |
//! | 90 % quantile of the same | 8.9 mm | 19.0 mm |
//! | largest of the same | 16.4 mm | 34.7 mm |
//! | median over bones of the length's range | 8 mm | 30 mm |
//! | mean speed | 0.40 m/s | 4.4 m/s |
//! | 99 % quantile of speed | 2.0 m/s | 10.1 m/s |
//! | largest speed | 2.8 m/s | 15.7 m/s |
//! | 99 % quantile of acceleration | 19 m/s² | 229 m/s² |
//! | largest acceleration | 90 m/s² | 1771 m/s² |
//! | lowest toe, heel and fifth metatarsal | −4 mm | 50 mm |

use mocap_core::{MarkerKnowledge, Take, geometry::norm};
use mocap_synth::{Activity, Person, SynthParams};

use crate::{params, record};

const SEEDS: std::ops::Range<u64> = 0..5;

fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let index = (share * (values.len() - 1) as f64).round() as usize;
    values[index]
}

/// Deviation and range of each named bone's length, in metres.
fn bone_spread(take: &Take) -> (Vec<f64>, Vec<f64>) {
    let pairs = MarkerKnowledge::cmu_41().bone_pairs(take.markers());
    let spread = pairs.into_iter().map(|(a, b)| {
        let lengths: Vec<f64> =
            (0..take.frames()).map(|t| take.distance(t, a, b).unwrap()).collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        let variance = lengths.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
        let top = lengths.iter().copied().fold(0.0, f64::max);
        let low = lengths.iter().copied().fold(f64::INFINITY, f64::min);
        ((variance / lengths.len() as f64).sqrt(), top - low)
    });
    spread.unzip()
}

/// Speeds and accelerations of all markers.
fn rates(take: &Take) -> (Vec<f64>, Vec<f64>) {
    let hz = take.rate_hz();
    let (mut speeds, mut accelerations) = (Vec::new(), Vec::new());
    for m in 0..take.marker_count() {
        for t in 1..take.frames() - 1 {
            let [p, q, r] = [t - 1, t, t + 1].map(|t| take.position(t, m).unwrap());
            speeds.push(norm([0, 1, 2].map(|a| (r[a] - p[a]) * hz / 2.0)));
            accelerations.push(norm([0, 1, 2].map(|a| (r[a] - 2.0 * q[a] + p[a]) * hz * hz)));
        }
    }
    (speeds, accelerations)
}

fn takes() -> impl Iterator<Item = (Activity, u64, Take)> {
    Activity::ALL.into_iter().flat_map(|activity| {
        SEEDS.map(move |seed| (activity, seed, record(params(activity, seed)).into_take()))
    })
}

#[test]
fn bones_stretch_like_captured_ones() {
    for (activity, seed, take) in takes() {
        let (mut deviations, mut ranges) = bone_spread(&take);
        let named = format!("{activity} {seed}");
        let middle = quantile(&mut deviations, 0.5);
        // Someone who turns on the spot or reaches for a table hardly bends.
        let calm = matches!(activity, Activity::Turn | Activity::Reach);
        let least = if calm { 0.7 } else { 1.0 };
        assert!((least * 0.0014..0.007).contains(&middle), "{named}: median deviation {middle}");
        let high = quantile(&mut deviations, 0.9);
        assert!((least * 0.006..0.025).contains(&high), "{named}: 90 % deviation {high}");
        let top = quantile(&mut deviations, 1.0);
        assert!((least * 0.015..0.055).contains(&top), "{named}: largest deviation {top}");
        let range = quantile(&mut ranges, 0.5);
        assert!((least * 0.006..0.035).contains(&range), "{named}: median range {range}");
    }
}

#[test]
fn markers_move_as_fast_as_captured_ones() {
    for (activity, seed, take) in takes() {
        let (mut speeds, mut accelerations) = rates(&take);
        let named = format!("{activity} {seed}");
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        // Walking people cover 1.1 to 1.6 m/s, joggers 2.5 to 4; jumps and throws pause between.
        let usual = match activity {
            Activity::Walk | Activity::Corner => 1.1..1.8,
            Activity::Run => 2.5..4.4,
            // 141_04, jumps over distances: 1.6 m/s.
            Activity::Leap => 0.8..2.2,
            Activity::Turn | Activity::Reach => 0.15..0.6,
            _ => 0.3..1.6,
        };
        // The recordings hold nothing as calm as turning and reaching.
        let calm = matches!(activity, Activity::Turn | Activity::Reach);
        let least = if calm { 0.4 } else { 1.0 };
        assert!(usual.contains(&mean), "{named}: mean speed {mean}");
        let high = quantile(&mut speeds, 0.99);
        assert!((least * 2.0..11.0).contains(&high), "{named}: 99 % speed {high}");
        let top = quantile(&mut speeds, 1.0);
        assert!((least * 2.8..18.0).contains(&top), "{named}: largest speed {top}");
        let high = quantile(&mut accelerations, 0.99);
        assert!((least * 19.0..230.0).contains(&high), "{named}: 99 % acceleration {high}");
        let top = quantile(&mut accelerations, 1.0);
        assert!((least * 60.0..1771.0).contains(&top), "{named}: largest acceleration {top}");
    }
}

#[test]
fn feet_stay_above_the_floor_and_reach_it() {
    let feet = ["LHEE", "LMT5", "LTOE", "RHEE", "RMT5", "RTOE"];
    for activity in Activity::ALL {
        for (seed, stature_m) in [(0, 1.75), (1, 1.2), (2, 2.2), (3, 1.6), (4, 1.9)] {
            let take = record(SynthParams { stature_m, ..params(activity, seed) }).into_take();
            for name in feet {
                let marker = take.markers().find(name).unwrap();
                let low = (0..take.frames())
                    .map(|t| take.position(t, marker).unwrap()[2])
                    .fold(f64::INFINITY, f64::min);
                // Markers sit 2 to 6 cm over the sole; a fast swing may brush the floor.
                assert!((-0.01..0.08).contains(&low), "{activity} {seed} {name}: {low}");
            }
        }
    }
}

#[test]
fn standing_feet_do_not_skate() {
    // The fifth metatarsal rests until the heel rises: about 0.3 of a walking cycle at least, and
    // 0.1 of a running one.
    for (activity, rest) in [(Activity::Walk, 0.3), (Activity::Run, 0.08)] {
        for seed in SEEDS {
            let params = SynthParams { noise_m: 0.0, ..params(activity, seed) };
            let take = record(params).into_take();
            let marker = take.markers().find("LMT5").unwrap();
            let speed = |t: usize| {
                let (p, q) =
                    (take.position(t - 1, marker).unwrap(), take.position(t, marker).unwrap());
                (q[0] - p[0]).hypot(q[1] - p[1]) * take.rate_hz()
            };
            let resting = (1..take.frames()).filter(|&t| speed(t) < 0.1).count();
            let share = resting as f64 / take.frames() as f64;
            assert!(share > rest, "{activity} {seed}: at rest for {share} of the time");
        }
    }
}

#[test]
fn knees_and_elbows_bend_one_way() {
    for activity in Activity::ALL {
        for seed in SEEDS {
            let recorded = record(params(activity, seed));
            let skeleton = recorded.motion().skeleton();
            for (name, sign) in [
                ("left_knee", 1.0),
                ("right_knee", 1.0),
                ("left_elbow", -1.0),
                ("right_elbow", -1.0),
            ] {
                let joint = skeleton.find(name).unwrap();
                for pose in recorded.motion().poses() {
                    let (w, v) = pose.rotations[joint].quaternion();
                    let degrees = (2.0 * (sign * v[1]).atan2(w)).to_degrees();
                    assert!((0.0..150.0).contains(&degrees), "{activity} {seed} {name}: {degrees}");
                }
            }
        }
    }
}

/// Highest speed over the floor of the foot that is slower at each moment, and how long it lasts, for people.
#[test]
fn people_who_step_about_always_stand_on_a_foot() {
    for activity in
        [Activity::Walk, Activity::Corner, Activity::Throw, Activity::Kick, Activity::Reach]
    {
        for seed in SEEDS {
            let person = Some(Person::draw(seed));
            let params = SynthParams { noise_m: 0.0, person, ..params(activity, seed) };
            let take = record(params).into_take();
            let feet = ["LMT5", "RMT5"].map(|name| take.markers().find(name).unwrap());
            let speed = |t: usize, m: usize| {
                let (p, q) = (take.position(t - 1, m).unwrap(), take.position(t, m).unwrap());
                (q[0] - p[0]).hypot(q[1] - p[1]) * take.rate_hz()
            };
            let slower = |t: usize| feet.map(|m| speed(t, m)).into_iter().fold(f64::MAX, f64::min);
            let slipping = (1..take.frames()).filter(|&t| slower(t) > 0.35).count();
            let share = slipping as f64 / take.frames() as f64;
            // The change from foot to foot is a matter of frames.
            assert!(share < 0.05, "{activity} {seed}: no foot at rest for {share} of the time");
        }
    }
}

#[test]
fn people_never_stand_quite_still() {
    for activity in [Activity::Jump, Activity::Turn, Activity::Reach, Activity::Kick] {
        for seed in SEEDS {
            let person = Some(Person::draw(seed));
            let recorded = record(SynthParams { person, ..params(activity, seed) });
            let joints = recorded.joints();
            let head = recorded.motion().skeleton().find("head").unwrap();
            let mut speeds: Vec<f64> = (1..joints.dim().0)
                .map(|t| norm([0, 1, 2].map(|a| joints[(t, head, a)] - joints[(t - 1, head, a)])))
                .map(|step_m| step_m * recorded.take().rate_hz())
                .collect();
            // Heads of captured people who stand move at 1 cm/s and more nearly all the time.
            let slow = quantile(&mut speeds, 0.05);
            assert!((0.005..0.2).contains(&slow), "{activity} {seed}: {slow} m/s");
        }
    }
}
