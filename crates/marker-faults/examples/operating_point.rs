//! Precision, recall and false alarms of the detector on real recordings with injected faults.
//!
//! `MOCAP_DATA=DIR cargo run --release -p marker-faults --example operating_point`
#![allow(clippy::print_stdout, clippy::unwrap_used)] // a report for people

#[path = "../tests/it/bench.rs"]
mod bench;

use bench::{Score, recordings};
use marker_faults::FaultDetector;

fn main() {
    let detector = FaultDetector::default();
    // `--chosen` leaves out the recordings that figures are reported on.
    let sets = if std::env::args().any(|arg| arg == "--chosen") { 1 } else { 2 };
    for (set, names) in
        [("chosen on", bench::CHOSEN_ON), ("held out", bench::HELD_OUT)].into_iter().take(sets)
    {
        let takes = recordings(names);
        if takes.is_empty() {
            return;
        }
        let mut alarms = 0;
        let mut seconds = 0.0;
        let mut known = Vec::new();
        let started = std::time::Instant::now();
        for (name, take) in &takes {
            let faults = detector.detect(take);
            let own = take.observed().count() as f64 / take.rate_hz();
            alarms += faults.list().len();
            known.push(faults.mask().clone());
            seconds += own;
            println!(
                "{set}: {name}: {} faults in {own:.0} marker-seconds as recorded",
                faults.list().len()
            );
            if std::env::args().any(|arg| arg == "--list") {
                for fault in faults.list() {
                    let (marker, mm) = (take.markers().name(fault.marker), 1000.0 * fault.size_m);
                    println!("    {marker} {:?} {} {mm:.0} mm", fault.frames, fault.kind);
                }
            }
        }
        let elapsed = started.elapsed().as_secs_f64();
        println!(
            "{set}: {:.4} false alarms a marker-second ({alarms} in {seconds:.0}); {:.0} ns a sample",
            alarms as f64 / seconds,
            1e9 * elapsed / (120.0 * seconds)
        );
        println!(
            "| {set} | altered | recall from 3 cm | precision | with the recording's own | alarms | with its own |"
        );
        println!("|---|---|---|---|---|---|---|");
        for scenario in bench::SCENARIOS {
            let mut score = Score::default();
            for (seed, ((_, take), known)) in (1_u64..).zip(takes.iter().zip(&known)) {
                for seed in [seed, 100 + seed, 200 + seed] {
                    score.add(&detector, (take, known), *scenario, seed);
                }
            }
            println!("| {} | {score} |", scenario.name());
        }
    }
}
