use mocap_io::c3d::{C3d, C3dOptions};

use crate::Bench;

#[test]
fn the_same_format_gives_identical_bytes() {
    let bench = Bench::with_gap("c3d");
    bench.ok("convert gap.c3d copy.c3d");
    assert_eq!(bench.read("copy.c3d"), bench.read("gap.c3d"));
    let bench = Bench::with_gap("trc");
    bench.ok("convert gap.trc copy.trc");
    assert_eq!(bench.read("copy.trc"), bench.read("gap.trc"));
}

#[test]
fn a_round_trip_through_every_format_keeps_samples_and_gaps() {
    let bench = Bench::with_gap("c3d");
    for (from, to) in [("c3d", "trc"), ("trc", "csv"), ("csv", "tsv"), ("tsv", "c3d")] {
        let target = if to == "c3d" { "back.c3d".into() } else { format!("gap.{to}") };
        bench.ok(&format!("convert gap.{from} {target}"));
    }
    let (first, last) =
        (bench.json("inspect gap.c3d --json"), bench.json("inspect back.c3d --json"));
    assert_eq!(first["gaps"], last["gaps"]);
    bench.ok("fill gap.c3d -o filled.c3d --method linear");
    bench.ok("fill back.c3d -o filled_back.c3d --method linear");
    let score = bench.json("score filled.c3d filled_back.c3d --occluded gap.c3d --json");
    // Single precision at 2 m resolves 0.0002 mm; text carries more.
    assert!(score["max_mm"].as_f64().unwrap() < 0.001, "{score}");
}

#[test]
fn a_fill_changes_only_the_filled_samples_bytes() {
    let bench = Bench::with_gap("c3d");
    bench.ok("fill gap.c3d -o filled.c3d --method spline");
    let (before, after) = (bench.read("gap.c3d"), bench.read("filled.c3d"));
    assert_eq!(before.len(), after.len());
    let file = C3d::parse(before.clone(), &C3dOptions::default()).unwrap();
    let points = file.points().len();
    let hidden: Vec<usize> = ["RKNE", "RSHN"]
        .iter()
        .map(|name| file.points().iter().position(|p| p.label == *name).unwrap())
        .collect();
    let start = 512 * (usize::from(file.header().data_block) - 1);
    let mut changed = 0;
    for at in (0..before.len()).filter(|&at| before[at] != after[at]) {
        let sample = (at - start) / 16;
        let (frame, point) = (sample / points, sample % points);
        assert!((59..90).contains(&frame) && hidden.contains(&point), "byte {at} changed");
        changed += 1;
    }
    assert!(changed > 62 * 4, "only {changed} bytes changed");
    let filled = C3d::parse(after, &C3dOptions::default()).unwrap().decode_points();
    for frame in 59..90 {
        assert_eq!(
            filled.words[filled.index(frame, hidden[0])],
            0,
            "residual and camera mask are 0"
        );
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let bench = Bench::with_gap("c3d");
    for threads in [1, 2] {
        bench.ok(&format!(
            "fill gap.c3d -o {threads}.c3d --method bolero-sc --iterations 10 --threads {threads}"
        ));
    }
    assert_eq!(bench.read("1.c3d"), bench.read("2.c3d"));
}
