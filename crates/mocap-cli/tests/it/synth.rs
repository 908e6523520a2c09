use mocap_io::{MarkerFile, MotionFile, ReadOptions};

use crate::{Bench, exists};

#[test]
fn a_person_in_full_dress_is_written_with_all_that_is_true() {
    let bench = Bench::new();
    let report = bench.json(
        "synth --motion reach --frames 90 --layout production-57 --hands 10 --body-seed 7 -o reach.c3d --json \
         --truth clean.csv --joints reach.bvh --plot still.svg --animate film.svg --occlusion 0.1",
    );
    assert_eq!(report["markers"], 77);
    assert_eq!(report["joints"], 52);
    let stature = report["stature_m"].as_f64().unwrap();
    assert!((1.4..2.1).contains(&stature), "{report}");
    let read = |name: &str| {
        let options = ReadOptions { rate_hz: Some(120.0), ..ReadOptions::default() };
        MarkerFile::read(&bench.path(name), &options).unwrap().take().clone()
    };
    let (seen, truth) = (read("reach.c3d"), read("clean.csv"));
    assert!(truth.gaps().is_empty() && !seen.gaps().is_empty());
    assert_eq!(Some(seen.gaps().len() as u64), report["gaps"].as_u64());
    for (t, m) in seen.observed().iter() {
        let (p, q) = (seen.position(t, m).unwrap(), truth.position(t, m).unwrap());
        // Noise of 0.25 mm a coordinate, and files that round.
        assert!((0..3).all(|a| (p[a] - q[a]).abs() < 0.002), "frame {t} marker {m}");
    }
    let file = MotionFile::read(&bench.path("reach.bvh"), None, &ReadOptions::default()).unwrap();
    assert_eq!(file.motion().poses().len(), 90);
    // Readers of BVH expect y up: the head is above the pelvis.
    let places = file.motion().skeleton().positions(&file.motion().poses()[0]).unwrap();
    let find = |name: &str| file.motion().skeleton().find(name).unwrap();
    assert!(places[find("head")][1] > places[find("pelvis")][1] + 0.3);
    for (name, word) in [("still.svg", "<polyline"), ("film.svg", "<animate ")] {
        assert!(String::from_utf8(bench.read(name)).unwrap().contains(word), "{name}");
    }
}

#[test]
fn the_same_options_give_the_same_bytes_and_another_body_others() {
    let bench = Bench::new();
    for (body, name) in [(3, "a.c3d"), (3, "b.c3d"), (4, "c.c3d")] {
        bench.ok(&format!("synth --motion kick --frames 60 --body-seed {body} -o {name}"));
    }
    assert_eq!(bench.read("a.c3d"), bench.read("b.c3d"));
    assert_ne!(bench.read("a.c3d"), bench.read("c.c3d"));
}

#[test]
fn a_recorded_motion_goes_onto_another_body() {
    let bench = Bench::new();
    bench.ok("synth --motion throw --frames 120 -o throw.c3d --joints throw.amc");
    let report = bench.json(
        "synth --motion throw.amc --skeleton throw.asf --body-seed 2 --layout front_waist-53 -o other.c3d --json",
    );
    assert_eq!((report["frames"].as_u64(), report["markers"].as_u64()), (Some(120), Some(53)));
    let half = bench.json("synth --motion throw.amc --rate 60 -o half.c3d --json");
    assert_eq!(half["frames"], 60);
}

#[test]
fn what_cannot_be_made_is_refused_with_the_way_out() {
    let bench = Bench::new();
    bench.ok("synth --motion walk --frames 20 -o walk.c3d --joints walk.amc");
    let whole = String::from_utf8(bench.read("walk.amc")).unwrap();
    // One joint of one frame is missing.
    let cut = whole.replacen("\nleft_knee ", "\n# left_knee ", 5).replacen(
        "\n# left_knee ",
        "\nleft_knee ",
        4,
    );
    std::fs::write(bench.path("cut.amc"), cut).unwrap();
    let asf = String::from_utf8(bench.read("walk.asf")).unwrap();
    std::fs::write(bench.path("odd.asf"), asf.replace("left_knee", "kneecap")).unwrap();
    std::fs::write(bench.path("odd.amc"), whole.replace("left_knee", "kneecap")).unwrap();
    for (line, words) in [
        ("synth --motion swim -o out.c3d", "choose one of walk, run"),
        ("synth --motion walk --layout helen -o out.c3d", "front_waist-53"),
        ("synth --motion walk --hands 3 -o out.c3d", "0, 5 or 10"),
        ("synth --motion walk --noise 11 -o out.c3d", "noise_m"),
        ("synth --motion walk --rate 1 -o out.c3d", "rate_hz"),
        ("synth --motion walk -o out.bvh", "markers go into"),
        ("synth --motion walk -o out.c3d --joints j.c3d", "joint motion goes into"),
        ("synth --motion walk -o out.c3d --animate film.png", "an animation is an .svg file"),
        ("synth --motion walk -o out.c3d --truth out.c3d", "named twice"),
        ("synth --motion walk -o out.c3d --occlusion 1.5", "occlusion"),
        ("synth --motion walk.c3d -o out.c3d", "holds markers"),
        ("synth --motion walk --skeleton walk.asf -o out.c3d", "goes with a motion"),
        ("synth --motion nothing.amc -o out.c3d", "nothing.amc"),
        ("synth --motion cut.amc --skeleton walk.asf -o out.c3d", "cut.amc"),
        ("synth --motion odd.amc --skeleton odd.asf -o out.c3d", "left_knee"),
    ] {
        let error = bench.fails(line);
        assert!(error.contains(words), "{line}: {error}");
        assert!(!exists(&bench.path("out.c3d")), "{line}");
    }
}
