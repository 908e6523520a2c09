use mocap_testkit::recording;

use crate::Bench;

/// The running motion of [Li10] Fig. 2 and 3, from visible samples alone.
#[test]
fn the_knee_of_a_runner_comes_back() {
    let Some(truth) = recording("cmu/bolero-nine/127_07.csv.gz") else { return };
    let bench = Bench::new();
    let truth = truth.display();
    bench.ok(&format!(
        "occlude {truth} -o gap.csv --marker RKNE --marker RSHN --frames 25..90 --rate 120"
    ));
    // The authors' code: 2.7e-4 to 2.9e-4 with its bones from the complete motion.
    let cases = [
        ("linear", "", 4e-2),
        ("bolero-sc", "--published --iterations 200", 4e-4),
        ("auto", "", 1e-4),
    ];
    for (method, options, limit) in cases {
        bench.ok(&format!("fill gap.csv -o {method}.csv --method {method} {options} --rate 120"));
        let score =
            bench.json(&format!("score {truth} {method}.csv --occluded gap.csv --json --rate 120"));
        let mse = score["mse_m2"].as_f64().unwrap();
        assert!(mse < limit, "{method}: {mse}");
        if method == "linear" {
            assert!(mse > 2e-2, "the case is harder than that: {mse}");
        }
    }
}

/// The same through a real C3D file.
#[test]
fn a_real_c3d_is_filled_in_place_of_its_gaps() {
    let Some(truth) = recording("cmu/paired/02_01.c3d") else { return };
    let bench = Bench::new();
    let truth = truth.display();
    bench.ok(&format!("occlude {truth} -o gap.c3d --marker RKNE --marker RSHN --frames 100..165"));
    bench.ok("fill gap.c3d -o filled.c3d --method bolero-sc");
    bench.ok("fill gap.c3d -o linear.c3d --method linear");
    let mse = |file: &str| {
        let score = bench.json(&format!("score {truth} {file} --occluded gap.c3d --json"));
        score["mse_m2"].as_f64().unwrap()
    };
    let (ours, linear) = (mse("filled.c3d"), mse("linear.c3d"));
    assert!(ours < 4e-4 && ours < linear / 10.0, "bolero-sc {ours}, linear {linear}");
}
