//! `mocap detect` and `fill --detect`.

use crate::{Bench, exists};

/// A walk in which one sample of a marker is 60 mm off: frame 101, column `x` of the marker.
fn with_spike() -> (Bench, String) {
    let bench = Bench::new();
    bench.ok("synth --motion walk --frames 200 --seed 3 -o walk.csv");
    let text = String::from_utf8(bench.read("walk.csv")).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let column = lines[0].split(',').position(|name| name.contains("RKNE")).unwrap();
    let mut fields: Vec<String> = lines[101].split(',').map(str::to_owned).collect();
    let moved = fields[column].parse::<f64>().unwrap() + 60.0;
    fields[column] = format!("{moved:.4}");
    lines[101] = fields.join(",");
    std::fs::write(bench.path("spike.csv"), lines.join("\n") + "\n").unwrap();
    (bench, fields[column].clone())
}

#[test]
fn a_made_walk_has_no_faults() {
    let bench = Bench::new();
    bench.ok("synth --motion walk --frames 200 --seed 3 -o walk.c3d");
    assert!(bench.ok("detect walk.c3d").starts_with("0 faults, 0 samples"));
}

#[test]
fn a_spike_is_listed_and_nothing_is_written() {
    let (bench, _) = with_spike();
    let before = bench.read("spike.csv");
    let found = bench.json("detect spike.csv --json");
    let fault = &found["faults"][0];
    assert_eq!(found["faults"].as_array().unwrap().len(), 1);
    assert_eq!((fault["kind"].as_str(), fault["first_frame"].as_i64()), (Some("spike"), Some(101)));
    assert!(fault["marker"].as_str().unwrap().ends_with("RKNE"));
    assert!((fault["size_mm"].as_f64().unwrap() - 60.0).abs() < 3.0);
    assert_eq!(bench.read("spike.csv"), before);
    assert_eq!(std::fs::read_dir(bench.folder.path()).unwrap().count(), 2);
    assert!(bench.ok("detect spike.csv --kind swap").starts_with("0 faults"));
    assert!(bench.ok("detect spike.csv --step 100").starts_with("0 faults"));
}

#[test]
fn apply_hides_the_sample_and_no_other() {
    let (bench, value) = with_spike();
    bench.ok("detect spike.csv --apply -o cleaned.csv");
    let (before, after) = (bench.read("spike.csv"), bench.read("cleaned.csv"));
    let (before, after) = (String::from_utf8(before).unwrap(), String::from_utf8(after).unwrap());
    let different: Vec<usize> = before
        .lines()
        .zip(after.lines())
        .enumerate()
        .filter(|(_, (a, b))| a != b)
        .map(|(k, _)| k)
        .collect();
    assert_eq!(different, [101]);
    assert!(!after.contains(&value));
    let sidecar: serde_json::Value =
        serde_json::from_slice(&bench.read("cleaned.csv.detect.json")).unwrap();
    assert_eq!(sidecar["faulty_samples"], 1);
    let again = bench.json("inspect cleaned.csv --json");
    assert_eq!(again["gaps"].as_array().unwrap().len(), 1);
}

#[test]
fn fill_fills_what_is_detected_with_consent_alone() {
    let (bench, value) = with_spike();
    bench.ok("fill spike.csv -o listed.csv --method ridge --detect");
    assert_eq!(bench.read("listed.csv"), bench.read("spike.csv"));
    let sidecar: serde_json::Value =
        serde_json::from_slice(&bench.read("listed.csv.fill.json")).unwrap();
    assert_eq!(
        (&sidecar["detected"]["applied"], &sidecar["detected"]["faulty_samples"]),
        (&false.into(), &1.into())
    );
    let filled = bench.json("fill spike.csv -o filled.csv --method ridge --detect --apply --json");
    assert_eq!(filled["detected"]["applied"], true);
    assert_eq!(filled["gaps"].as_array().unwrap().len(), 1);
    let text = String::from_utf8(bench.read("filled.csv")).unwrap();
    assert!(!text.contains(&value));
    // The fill lies where the marker was.
    bench.ok("detect spike.csv --apply -o cleaned.csv");
    let score = bench.json("score walk.csv filled.csv --occluded cleaned.csv --json");
    assert_eq!(score["hidden_samples"], 1);
    assert!(score["mean_mm"].as_f64().unwrap() < 5.0);
}

#[test]
fn faults_are_drawn() {
    let (bench, _) = with_spike();
    bench.ok("detect spike.csv --plot faults.svg");
    let svg = String::from_utf8(bench.read("faults.svg")).unwrap();
    assert!(svg.contains("spike, 6") && svg.contains("suspect") && svg.contains("1 fault"));
    bench.ok("detect spike.csv --plot faults.png");
    assert!(bench.read("faults.png").starts_with(b"\x89PNG"));
}

#[test]
fn what_cannot_be_is_refused_before_any_work() {
    let (bench, _) = with_spike();
    assert!(bench.fails("detect spike.csv --apply").contains("--output"));
    assert!(bench.fails("detect spike.csv -o cleaned.csv").contains("--apply"));
    assert!(
        bench.fails("detect spike.csv --apply -o spike.csv --force").contains("never overwritten")
    );
    assert!(bench.fails("detect spike.csv --apply -o cleaned.trc").contains("keeps the format"));
    assert!(bench.fails("detect spike.csv --step -1").contains("step_m"));
    assert!(bench.fails("fill spike.csv -o filled.csv --apply").contains("--detect"));
    assert!(!exists(&bench.path("cleaned.trc")) && !exists(&bench.path("cleaned.csv")));
}
