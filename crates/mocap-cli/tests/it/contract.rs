use crate::{Bench, exists};

#[test]
fn fill_keeps_its_contract() {
    for extension in ["c3d", "csv", "trc", "tsv"] {
        let bench = Bench::with_gap(extension);
        let line = format!("fill gap.{extension} -o filled.{extension} --method linear --json");
        let object = bench.json(&line);
        for key in ["method", "termination", "iterations", "seconds", "seconds_per_iteration"] {
            assert!(object.get(key).is_some(), "{extension}: no `{key}` in {object}");
        }
        let gaps = object["gaps"].as_array().unwrap();
        assert_eq!(gaps.len(), 2);
        for gap in gaps {
            assert_eq!(gap["first_frame"], 60, "{extension}");
            assert_eq!(gap["last_frame"], 90, "{extension}");
            assert_eq!(gap["method"], "linear");
            assert!(gap["border_step_mm"].as_f64().unwrap() >= 0.0);
            assert!(gap["refused"].is_null());
        }
        let sidecar = bench.read(&format!("filled.{extension}.fill.json"));
        let sidecar: serde_json::Value = serde_json::from_slice(&sidecar).unwrap();
        assert_eq!(sidecar["gaps"], object["gaps"]);
    }
}

#[test]
fn every_method_beats_standing_still_and_scores_in_json() {
    let bench = Bench::with_gap("c3d");
    for method in bench.json("methods --json").as_array().unwrap() {
        let id = method["id"].as_str().unwrap();
        bench.ok(&format!("fill gap.c3d -o {id}.c3d --method {id} --iterations 20"));
        let score = bench.json(&format!("score walk.c3d {id}.c3d --occluded gap.c3d --json"));
        assert_eq!(score["hidden_samples"], 62);
        // Neighbours that go missing together may be each other's donors, which the rules of Nexus refuse.
        if id.starts_with("vicon-") && score["unfilled_samples"] != 0 {
            continue;
        }
        assert_eq!(score["unfilled_samples"], 0);
        // A knee that stood still for a quarter of a second of walking would be off by 20 cm and more.
        let mean = score["mean_mm"].as_f64().unwrap();
        assert!(mean > 0.0 && mean < 200.0, "{id}: {mean} mm");
    }
}

#[test]
fn other_takes_of_the_session_are_learnt_from_and_listed() {
    let bench = Bench::with_gap("c3d");
    bench.ok("synth --motion walk --frames 300 --seed 3 -o other.csv");
    let object = bench.json("fill gap.c3d -o filled.c3d --session walk.c3d other.csv --json");
    // The walk itself is among them, so that the gap has been seen.
    let shares = object["gaps"][0]["mixture"].as_array().unwrap();
    assert!(shares.iter().any(|share| share["method"] == "session"), "{shares:?}");
    let sidecar: serde_json::Value =
        serde_json::from_slice(&bench.read("filled.c3d.fill.json")).unwrap();
    assert_eq!(sidecar["session"][1]["file"], "other.csv");
    assert_eq!(sidecar["session"][0]["sha256"].as_str().unwrap().len(), 64);

    let refused = |line: &str| bench.fails(&format!("fill gap.c3d -o no.c3d {line}"));
    let error = refused("--session walk.c3d --method spline");
    assert!(error.contains("`auto` does"), "{error}");
    let error = refused("--session gap.c3d");
    assert!(error.contains("the recording to fill"), "{error}");
    bench.ok("synth --motion walk --frames 50 --rate 60 -o slow.c3d");
    let error = refused("--session slow.c3d");
    assert!(error.contains("slow.c3d has 60 Hz, not 120 Hz"), "{error}");
    assert!(!exists(&bench.path("no.c3d")));
}

#[test]
fn long_gaps_stay_open_when_asked() {
    let bench = Bench::with_gap("c3d");
    let line = "fill gap.c3d -o filled.c3d --method linear --max-gap 0.2 --json";
    let object = bench.json(line);
    for gap in object["gaps"].as_array().unwrap() {
        assert!(gap["refused"].as_str().unwrap().contains("0.200 s"), "{gap}");
    }
    assert_eq!(bench.read("filled.c3d"), bench.read("gap.c3d"), "an open gap changes no byte");
}

#[test]
fn inspect_tells_what_is_there() {
    let bench = Bench::with_gap("c3d");
    let object = bench.json("inspect gap.c3d --json");
    assert_eq!(object["frames"], 200);
    assert_eq!(object["markers"], 41);
    assert_eq!(object["unit"], "mm");
    assert_eq!(object["up_axis"], "Z");
    assert_eq!(object["gaps"].as_array().unwrap().len(), 2);
    let text = bench.ok("inspect gap.c3d");
    assert!(text.contains("RKNE") && text.contains("41 markers"), "{text}");
}

#[test]
fn bones_are_listed_and_read_back() {
    let bench = Bench::with_gap("c3d");
    let list = bench.ok("bones gap.c3d");
    assert!(list.starts_with("marker_a,marker_b,length_mm\n"));
    assert!(list.lines().count() > 40, "{list}");
    std::fs::write(bench.path("bones.csv"), &list).unwrap();
    bench.ok("fill gap.c3d -o filled.c3d --method bolero-sc --bones bones.csv --iterations 5");
    std::fs::write(bench.path("wrong.csv"), "marker_a,marker_b,length_mm\nRKNE,ELBOW,3\n").unwrap();
    let error = bench.fails("fill gap.c3d -o x.c3d --bones wrong.csv");
    assert!(
        error.contains("wrong.csv") && error.contains("line 2") && error.contains("ELBOW"),
        "{error}"
    );
}

#[test]
fn plots_are_pictures() {
    let bench = Bench::with_gap("csv");
    bench.ok("fill gap.csv -o filled.csv --method spline --report report");
    bench.ok("plot gap.csv filled.csv -o fill.svg");
    bench.ok("plot gap.csv -o gap.png");
    let svg = String::from_utf8(bench.read("fill.svg")).unwrap();
    assert!(svg.contains("<svg") && svg.contains("RKNE"));
    assert_eq!(&bench.read("gap.png")[..8], b"\x89PNG\r\n\x1a\n");
    assert!(exists(&bench.path("report").join("index.html")));
}

#[test]
fn the_demo_runs_and_says_where_its_plot_is() {
    let bench = Bench::new();
    let text = bench.ok("demo -o here --quick");
    assert!(text.contains("linear") && text.contains("bolero-sc"), "{text}");
    assert!(text.contains("fill.svg"), "{text}");
    assert!(exists(&bench.path("here").join("fill.svg")));
}
