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

#[test]
fn skeletons_go_from_bvh_to_acclaim_and_back() {
    let bench = Bench::new();
    let bvh = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\n\
        CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n\
        JOINT Knee\n{\nOFFSET 5 -40 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n\
        End Site\n{\nOFFSET 0 -40 0\n}\n}\n}\n\
        MOTION\nFrames: 2\nFrame Time: 0.0083333\n\
        1 90 3 10 20 30 0 0 45\n2 91 3 11 21 31 0 5 50\n";
    std::fs::write(bench.path("a.bvh"), bvh).unwrap();
    bench.ok("convert a.bvh b.amc");
    assert!(String::from_utf8(bench.read("b.asf")).unwrap().contains("name to_Knee"));
    bench.ok("convert b.amc c.bvh --unit in");
    let numbers = |name: &str| -> Vec<f64> {
        let text = String::from_utf8(bench.read(name)).unwrap();
        let motion = text.lines().skip_while(|line| !line.starts_with("Frame Time")).skip(1);
        motion.flat_map(str::split_whitespace).map(|word| word.parse().unwrap()).collect()
    };
    let (before, after) = (numbers("a.bvh"), numbers("c.bvh"));
    // The root and its stiff bone, then the knee; lengths in inches.
    let expected = |frame: usize| -> Vec<f64> {
        let row = &before[9 * frame..9 * frame + 9];
        let lengths = row[..3].iter().map(|cm| cm / 2.54);
        lengths
            .chain(row[3..6].iter().copied())
            .chain([0.0; 3])
            .chain(row[6..].iter().copied())
            .collect()
    };
    for (frame, row) in after.chunks(12).enumerate() {
        for (found, wanted) in row.iter().zip(expected(frame)) {
            // Six decimals of a degree are written twice.
            assert!((found - wanted).abs() < 3e-6, "{row:?} {:?}", expected(frame));
        }
    }
    let error = bench.fails("convert a.bvh b.amc");
    assert!(error.contains("b.amc exists"), "{error}");
    bench.ok("convert b.asf d.bvh");
    assert!(bench.fails("convert d.bvh e.amc").contains("no frame"));
    assert!(!crate::exists(&bench.path("e.asf")), "a refused conversion leaves nothing behind");
}
