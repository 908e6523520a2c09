use mocap_synth::{Activity, Hands, Layout, Person, SynthParams, record_all};

use crate::{params, record};

#[test]
fn the_same_parameters_give_the_same_bits() {
    for activity in Activity::ALL {
        let (a, b) = (record(params(activity, 11)), record(params(activity, 11)));
        assert!(a.take().bit_eq(b.take()));
        assert!(a.truth().bit_eq(b.truth()));
        assert_eq!(a.motion(), b.motion());
    }
}

#[test]
fn another_seed_gives_another_body_and_another_motion() {
    for activity in Activity::ALL {
        let (a, b) = (record(params(activity, 1)), record(params(activity, 2)));
        assert_ne!(a.motion().skeleton(), b.motion().skeleton());
        let apart = |t: usize| {
            let (p, q) = (a.take().position(t, 0).unwrap(), b.take().position(t, 0).unwrap());
            mocap_core::geometry::distance(p, q)
        };
        assert!((0..1200).any(|t| apart(t) > 0.05));
    }
}

#[test]
fn a_longer_take_begins_like_a_shorter_one() {
    for activity in Activity::ALL {
        let long = record(params(activity, 5));
        let short = record(SynthParams { frames: 100, ..params(activity, 5) });
        for t in 0..100 {
            for m in 0..41 {
                assert_eq!(long.take().position(t, m), short.take().position(t, m));
            }
        }
    }
}

#[test]
fn the_motion_does_not_depend_on_the_rate() {
    for activity in Activity::ALL {
        let fast = record(params(activity, 6));
        let slow = record(SynthParams { frames: 600, rate_hz: 60.0, ..params(activity, 6) });
        // 2k/120 and k/60 round to the same number, so the poses agree to the last bit.
        for k in 0..600 {
            assert_eq!(fast.motion().poses()[2 * k], slow.motion().poses()[k]);
        }
    }
}

#[test]
fn no_cycle_of_a_gait_is_like_the_one_before() {
    for activity in [Activity::Walk, Activity::Run] {
        let recorded = record(SynthParams { soft_tissue: 0.0, ..params(activity, 3) });
        let ankle = recorded.take().markers().find("LANK").unwrap();
        let height = |t: usize| recorded.truth().position(t, ankle).unwrap()[2];
        let difference = |shift: usize| {
            let n = 600;
            let sum: f64 = (0..n).map(|t| (height(t + shift) - height(t)).powi(2)).sum();
            (sum / n as f64).sqrt()
        };
        // Shifts from half a second to 1.5 s hold exactly one cycle of either gait.
        let best = (60..180).map(difference).fold(f64::INFINITY, f64::min);
        // Ankles of one walker differ by 3 to 10 mm from step to step; an exact repeat shows 0.
        assert!((0.002..0.06).contains(&best), "{activity}: {best}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let crowd: Vec<SynthParams> = (0..9)
        .zip(0..)
        .map(|(seed, n): (u64, usize)| SynthParams {
            frames: 150,
            person: Some(Person::draw(seed)),
            layout: Layout::ALL[n % 3],
            hands: Hands::ALL[n % 3],
            ..params(Activity::ALL[n % Activity::ALL.len()], seed)
        })
        .collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| record_all(&crowd).unwrap())
    };
    let one = on(1);
    for threads in [2, 3] {
        for (a, b) in one.iter().zip(on(threads)) {
            assert!(a.take().bit_eq(b.take()) && a.truth().bit_eq(b.truth()));
            assert_eq!(a.motion(), b.motion());
        }
    }
}
