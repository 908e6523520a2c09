//! Real recordings below `MOCAP_DATA` with injected faults; skipped without it.

use marker_faults::FaultDetector;

use crate::bench::{CHOSEN_ON, Scenario, Score, recordings};

/// The bars of the project for shifts of 3 cm and more, and for false alarms on recordings that were cleaned.
#[test]
fn shifts_are_found_and_clean_recordings_pass() {
    let detector = FaultDetector::default();
    let takes = recordings(CHOSEN_ON);
    if takes.is_empty() {
        return;
    }
    let (mut shifts, mut stays) = (Score::default(), Score::default());
    let (mut alarms, mut seconds) = (0.0, 0.0);
    for (seed, (_, take)) in (1_u64..).zip(&takes) {
        let faults = detector.detect(take);
        alarms += faults.list().len() as f64;
        seconds += take.observed().count() as f64 / take.rate_hz();
        shifts.add(&detector, (take, faults.mask()), Scenario::Shifts(0.05), seed);
        stays.add(&detector, (take, faults.mask()), Scenario::Stays(1, 48), seed);
    }
    println!("shifts {shifts}; stays {stays}; {alarms} alarms in {seconds:.0} marker-seconds");
    assert!(alarms < 0.01 * seconds);
    for score in [shifts, stays] {
        assert!(score.recall() >= 0.95 && score.precision() >= 0.95, "{score}");
    }
}
