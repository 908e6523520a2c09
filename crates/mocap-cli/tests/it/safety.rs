use crate::{Bench, exists};

#[test]
fn an_input_is_never_overwritten() {
    let bench = Bench::with_gap("c3d");
    let before = bench.read("gap.c3d");
    for line in [
        "fill gap.c3d -o gap.c3d --force",
        "fill gap.c3d -o ./../../../gap.c3d/../gap.c3d --force",
        "convert gap.c3d gap.c3d --force",
        "occlude gap.c3d -o gap.c3d --marker C7 --frames 1..2 --force",
    ] {
        bench.fails(line);
        assert_eq!(bench.read("gap.c3d"), before, "`{line}` altered its input");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(bench.path("gap.c3d"), bench.path("link.c3d")).unwrap();
        let error = bench.fails("fill gap.c3d -o link.c3d --force");
        assert!(error.contains("never overwritten"), "{error}");
    }
}

#[test]
fn an_output_is_replaced_only_when_asked() {
    let bench = Bench::with_gap("c3d");
    std::fs::write(bench.path("out.c3d"), "precious").unwrap();
    let error = bench.fails("fill gap.c3d -o out.c3d --method linear");
    assert!(error.contains("--force"), "{error}");
    assert_eq!(bench.read("out.c3d"), b"precious");
    bench.ok("fill gap.c3d -o out.c3d --method linear --force");
    assert_ne!(bench.read("out.c3d"), b"precious");
}

#[test]
fn a_cut_file_is_refused_unless_salvaged() {
    let bench = Bench::with_gap("c3d");
    let bytes = bench.read("gap.c3d");
    std::fs::write(bench.path("cut.c3d"), &bytes[..bytes.len() / 2]).unwrap();
    let error = bench.fails("inspect cut.c3d");
    assert!(error.contains("cut.c3d") && error.contains("frames"), "{error}");
    let text = bench.ok("inspect cut.c3d --salvage");
    assert!(text.contains("cut off"), "{text}");
}

#[test]
fn errors_name_what_is_wrong_and_the_way_out() {
    let bench = Bench::with_gap("c3d");
    for (line, words) in [
        ("fill gap.c3d -o x.c3d --method magic", "mocap methods"),
        ("fill gap.xyz -o x.c3d", "extension"),
        ("fill none.c3d -o x.c3d", "none.c3d"),
        ("occlude gap.c3d -o x.c3d --marker KNEE --frames 1..2", "mocap inspect"),
        ("occlude gap.c3d -o x.c3d --marker C7 --frames 190..201", "1..200"),
        ("occlude gap.c3d -o x.c3d", "--list"),
        ("fill gap.c3d -o x.bvh --method linear", "solving"),
        ("fill gap.c3d -o x.c3d --max-gap -1", "max-gap"),
        ("fill gap.c3d -o x.c3d --hidden 0", "hidden"),
    ] {
        let error = bench.fails(line);
        assert!(error.contains(words), "`{line}` says: {error}");
        assert!(!exists(&bench.path("x.c3d")), "`{line}` left an output");
    }
}

#[test]
#[cfg(unix)]
fn a_reader_who_stops_early_is_no_error() {
    let bench = Bench::with_gap("c3d");
    let script =
        format!("{} inspect gap.c3d | true; exit ${{PIPESTATUS[0]}}", env!("CARGO_BIN_EXE_mocap"));
    let output = std::process::Command::new("bash")
        .args(["-c", &script])
        .current_dir(bench.folder.path())
        .output()
        .unwrap();
    assert!(output.status.success());
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}
