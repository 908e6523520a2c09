//! `mocap solve`: markers in, motion out.

use mocap_io::{MotionFile, ReadOptions};

use crate::{Bench, exists};

#[test]
fn a_gappy_walk_becomes_motion_in_every_format() {
    let bench = Bench::with_gap("c3d");
    let report = bench.json(
        "solve gap.c3d -o walk.bvh --json --plot still.svg --animate film.svg --markers clean.trc \
         --save-body me.body --threads 1",
    );
    assert_eq!(report["frames"], 200);
    assert!(report["mean_residual_mm"].as_f64().unwrap() < 8.0, "{report}");
    assert!((1..=200).contains(&report["largest_residual_frame"].as_i64().unwrap()), "{report}");
    assert!(report["largest_residual_marker"].is_string(), "{report}");
    let clean = bench.json("inspect clean.trc --json");
    assert_eq!(clean["gaps"].as_array().map(Vec::len), Some(0), "{clean}");
    for (name, word) in [("still.svg", "<polyline"), ("film.svg", "<animate ")] {
        let svg = String::from_utf8(bench.read(name)).unwrap();
        assert!(svg.contains(word), "{name}");
    }
    // The kept body fits as it is, and the same bits come out on two threads.
    let kept = bench.json("solve gap.c3d -o kept.amc --json --skeleton me.body --no-calibration");
    assert!(kept["mean_residual_mm"].as_f64().unwrap() < 8.0, "{kept}");
    bench.ok("solve gap.c3d -o again.bvh --threads 2");
    assert_eq!(bench.read("walk.bvh"), bench.read("again.bvh"));
    let read = |name: &str| {
        let file = MotionFile::read(&bench.path(name), None, &ReadOptions::default()).unwrap();
        let motion = file.motion();
        (0..200)
            .map(|t| motion.skeleton().positions(&motion.poses()[t]).unwrap()[0])
            .collect::<Vec<_>>()
    };
    let (bvh, amc) = (read("walk.bvh"), read("kept.amc"));
    for (a, b) in bvh.iter().zip(&amc) {
        // y is up: a walker's pelvis stays at its height. The two calibrations differ by a little.
        assert!((0.7..1.2).contains(&a[1]), "{a:?}");
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 0.03), "{a:?} {b:?}");
    }
    bench.ok("solve gap.c3d -o known.json --skeleton kept.asf");
    let json: serde_json::Value = serde_json::from_slice(&bench.read("known.json")).unwrap();
    assert_eq!(json["frames"].as_array().map(Vec::len), Some(200));
    assert_eq!(json["frames"][0]["rotations"][0].as_array().map(Vec::len), Some(4));
}

#[test]
fn what_cannot_be_solved_is_refused_before_anything_is_written() {
    let bench = Bench::with_gap("csv");
    for (line, words) in [
        ("solve gap.csv -o out.c3d", ".bvh, .amc, .asf or .json"),
        (
            "solve gap.csv -o out.bvh --skeleton nobody.body",
            "cannot read the body nobody.body; built-in ones are cmu-41, front_waist-53, production-57",
        ),
        ("solve gap.csv -o out.bvh --skeleton walk.csv", "holds markers"),
        ("solve gap.csv -o out.bvh --markers m.bvh", "markers go into"),
        ("solve gap.csv -o out.bvh --animate film.png", "an animation is an .svg file"),
        ("solve gap.csv -o out.bvh --threads 0", "at least 1"),
        ("solve gap.csv -o gap.csv", "is an input"),
        ("solve gap.csv -o out.bvh --learn-from walk.csv", "--motion"),
        ("solve gap.csv -o out.bvh --calibrate-on 0..9", "do not lie in the take's 1..200"),
        ("solve gap.csv -o out.bvh --calibrate-on 1..9 --no-calibration", "cannot be used with"),
        ("solve gap.csv -o out.bvh --t-pose 1..9 --calibrate-on 1..9", "cannot be used with"),
        ("solve gap.csv -o out.bvh --t-pose 1..200", "stands still"),
        ("solve gap.csv -o out.bvh --t-pose 1", "arms straight out to the sides"),
    ] {
        let error = bench.fails(line);
        assert!(error.contains(words), "{line}: {error}");
        assert!(!exists(&bench.path("out.bvh")), "{line}");
    }
    std::fs::write(bench.path("dots.csv"), "a-x,a-y,a-z\n1,2,3\n2,3,4\n").unwrap();
    let error = bench.fails("solve dots.csv -o out.bvh");
    assert!(error.contains("cannot solve dots.csv") && error.contains("LFWT"), "{error}");
    assert!(error.contains("the take has a;"), "{error}");
}

#[test]
fn markers_that_are_not_on_the_body_are_named() {
    let bench = Bench::with_gap("csv");
    let text = String::from_utf8(bench.read("gap.csv")).unwrap();
    std::fs::write(bench.path("hat.csv"), text.replace("LFHD", "HAT")).unwrap();
    let told = bench.ok("solve hat.csv -o out.bvh");
    assert!(told.contains("not on the body") && told.contains("HAT"), "{told}");
    let error = bench.fails("solve hat.csv -o strict.bvh --strict");
    assert!(error.contains("does not know HAT") && error.contains("`alias` lines"), "{error}");
    assert!(!exists(&bench.path("strict.bvh")));
    bench.ok("solve gap.csv -o strict.bvh --strict");
}

#[test]
fn bodies_are_learnt_and_kept() {
    let bench = Bench::with_gap("c3d");
    // A motion stands for one from another program; the body that it shows explains the markers as it is.
    bench.ok("solve gap.c3d -o walk.amc --save-body fitted.body");
    let learn = "--learn-from gap.c3d --motion walk.amc --skeleton walk.asf";
    let learnt =
        bench.json(&format!("solve gap.c3d -o learnt.bvh {learn} --json --save-body learnt.body"));
    assert!(learnt["mean_residual_mm"].as_f64().unwrap() < 8.0, "{learnt}");
    assert_eq!(learnt["calibration"].as_array().map(Vec::len), Some(0));
    let kept =
        bench.json("solve gap.c3d -o kept.bvh --skeleton learnt.body --no-calibration --json");
    assert!(kept["mean_residual_mm"].as_f64().unwrap() < 8.0, "{kept}");
    let part = bench.json("solve gap.c3d -o part.bvh --calibrate-on 1..100 --json");
    assert!(part["mean_residual_mm"].as_f64().unwrap() < 10.0, "{part}");
    bench.ok("synth --motion jump --frames 150 -o other.c3d");
    let error = bench.fails("solve gap.c3d -o out.bvh --learn-from other.c3d --motion walk.amc");
    assert!(error.contains("teach no body") && error.contains("200 frames"), "{error}");
    assert!(!exists(&bench.path("out.bvh")));
}

#[test]
fn every_layout_of_synth_is_solved_without_options() {
    let bench = Bench::new();
    for layout in ["front_waist-53 --hands 5", "production-57"] {
        let name = layout.split(' ').next().unwrap();
        bench.ok(&format!("synth --motion walk --frames 120 --layout {layout} -o {name}.c3d"));
        let report = bench.json(&format!("solve {name}.c3d -o {name}.bvh --json"));
        assert_eq!(report["unmapped_markers"].as_array().map(Vec::len), Some(0), "{report}");
        assert!(report["mean_residual_mm"].as_f64().unwrap() < 6.0, "{report}");
    }
}
