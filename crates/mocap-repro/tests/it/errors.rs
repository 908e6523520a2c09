use std::{collections::BTreeMap, fs, path::Path, process::Command};

use mocap_repro::{
    Evaluation, Hide, Matrix, Motion, Protocol, ReproError, Store, Trial, Variant, read_trials, run,
};

use crate::{fixtures, small_matrix};

fn message(error: &dyn std::error::Error) -> String {
    match error.source() {
        Some(source) => format!("{error}: {}", message(source)),
        None => error.to_string(),
    }
}

#[test]
fn unknown_methods_and_options_are_refused_with_what_there_is() {
    let refused = |text: &str| message(&Variant::parse(text).unwrap_err());
    assert!(refused("bolero").contains("bolero-sc"), "names the methods that there are");
    assert!(refused("linear+lambda=3").contains("`lambda=3`"));
    assert!(refused("bolero-sc+beauty=1").contains("lambda, hidden, borders, start, published"));
    assert!(refused("bolero-sc+lambda=much").contains("lambda"));
    assert!(refused("bolero-sc+lambda=-1").contains("lambda"));
    assert!(refused("dynammo+hidden=0").contains("hidden"));
    assert!(refused("dynammo+published=1").contains("`published=1`"));
    assert!(refused("dynammo+start=zero").contains("`start=zero`"));
    assert!(matches!("all".parse::<Protocol>(), Err(ReproError::Protocol { .. })));
    assert_eq!(Variant::parse("bolero-sc+lambda=100").unwrap().label(), "bolero-sc+lambda=100");
    assert_eq!(Variant::parse_list(&[]).unwrap(), Variant::all());
}

#[test]
fn missing_recordings_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let error = Motion::read(folder.path(), "127_07").unwrap_err();
    assert!(message(&error).contains("`127_07`"));
    fs::write(folder.path().join("127_07.csv"), "a,b\n1,2\n").unwrap();
    assert!(matches!(Motion::read(folder.path(), "127_07"), Err(ReproError::Read(_))));
    assert!(matches!(Evaluation::of_paper(folder.path()), Err(ReproError::Io { .. })));
    assert!(matches!(Motion::read_aside(folder.path()), Err(ReproError::Motion { .. })));
}

fn list(text: &str) -> Result<Vec<Trial>, ReproError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("trials.csv");
    fs::write(&path, text).unwrap();
    read_trials(&path, "set", "class")
}

#[test]
fn a_list_of_trials_is_read_as_frames_from_one_with_the_last_included() {
    let trials = list("end,trial,motion,marker,start,init_seed\n94,7,127_07,T10,35,3\n").unwrap();
    assert_eq!(trials.len(), 1);
    assert_eq!((trials[0].name.as_str(), trials[0].seed), ("7", 3));
    assert_eq!(trials[0].hidden, [Hide { marker: "T10".to_owned(), start: 34, end: 94 }]);
}

#[test]
fn wrong_lists_of_trials_are_refused() {
    let refused = |text: &str| message(&list(text).unwrap_err());
    let text = refused("trial,motion,marker,begin,end\n1,a,b,1,2\n");
    assert!(text.contains("`start`") && text.contains("begin"), "{text}");
    let head = "trial,motion,marker,start,end,init_seed\n";
    for (row, named) in [
        ("1,a,b,0,2,1\n", "start `0`"),
        ("1,a,b,5,4,1\n", "end `4`"),
        ("1,a,b,x,4,1\n", "start `x`"),
        ("1,a,b,1,2,-1\n", "init_seed `-1`"),
        ("1,a,b,1,2,1\n1,a,b,3,4,1\n", "trial `1`"),
        ("1,a,b\n", "comma-separated"),
    ] {
        let text = refused(&format!("{head}{row}"));
        assert!(text.contains(named), "{row}: {text}");
    }
}

/// Nothing is computed: the file of cells stays empty.
fn refused_before_work(matrix: &Matrix) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cells.jsonl");
    let mut store = Store::open(&path).unwrap();
    let error = run(std::slice::from_ref(matrix), &mut store, 1, &|_| ()).unwrap_err();
    assert_eq!(path.metadata().unwrap().len(), 0);
    message(&error)
}

#[test]
fn a_trial_that_does_not_fit_stops_the_run_before_it_starts() {
    let matrix = small_matrix();
    let with = |change: &dyn Fn(&mut Trial)| {
        let mut matrix = matrix.clone();
        change(matrix.trials.last_mut().unwrap());
        refused_before_work(&matrix)
    };
    assert!(with(&|trial| trial.hidden[0].marker = "TAIL".to_owned()).contains("TAIL"));
    assert!(with(&|trial| trial.hidden[0].end = 100_000).contains("outside"));
    assert!(with(&|trial| trial.motion = "swim".to_owned()).contains("swim"));
    assert!(with(&|trial| trial.hidden.clear()).contains("hides nothing"));
    // The hard bones' first iterations are those of the plain system.
    let hard = vec![Variant::parse("bolero-hc+published").unwrap()];
    let one = Matrix { variants: hard, iterations: Some(1), ..matrix.clone() };
    assert!(refused_before_work(&one).contains("iterations"));
    let empty = Matrix { variants: Vec::new(), ..matrix.clone() };
    assert!(refused_before_work(&empty).contains("0 methods"));
    let nowhere = Matrix { motions: BTreeMap::new(), ..matrix };
    assert!(refused_before_work(&nowhere).contains("no motion"));
}

fn program(arguments: &[&str]) -> (bool, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_mocap-repro"))
        .args(arguments)
        .env_remove("MOCAP_DATA")
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.success(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn the_program_refuses_before_it_makes_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    for (arguments, said) in [
        (vec!["bolero", "--out", out], "MOCAP_DATA"),
        (vec!["bolero", "--out", out, "--data", "nowhere"], "nowhere"),
        (vec!["bolero", "--out", out, "--quick", "--methods", "magic"], "magic"),
        (vec!["leaderboard", "--out", out, "--quick", "--protocol", "hard"], "hard"),
    ] {
        let (good, _, words) = program(&arguments);
        assert!(!good && words.contains(said), "{arguments:?}: {words}");
        assert!(!Path::new(out).exists());
    }
}

#[test]
fn the_program_runs_a_small_matrix() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let arguments = ["--quick", "--json", "--methods", "linear,spline", "--out"];
    for task in ["bolero", "leaderboard"] {
        let mut all = vec![task];
        all.extend(arguments);
        all.push(out.to_str().unwrap());
        let (good, json, words) = program(&all);
        assert!(good, "{words}");
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert!(!json["rows"].as_array().unwrap().is_empty());
        assert!(out.join(format!("{task}.html")).is_file());
    }
    assert!(fixtures().is_dir());
}

#[test]
fn a_folder_without_captured_takes_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let refused = mocap_repro::synth_report(folder.path(), &mut |_| ()).unwrap_err();
    assert!(matches!(&refused, ReproError::NoTakes { folder: named } if named == folder.path()));
}
