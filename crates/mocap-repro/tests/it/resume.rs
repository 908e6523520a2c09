use std::{
    fs,
    sync::atomic::{AtomicUsize, Ordering},
};

use mocap_repro::{Matrix, Store, run};

use crate::{run_in, same_results, small_matrix};

fn lines(folder: &std::path::Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("cells.jsonl")).unwrap();
    text.lines().map(str::to_owned).collect()
}

#[test]
fn threads_change_no_result() {
    let matrix = small_matrix();
    let [one, four] = [1, 4].map(|threads| {
        let folder = tempfile::tempdir().unwrap();
        run_in(&matrix, folder.path(), threads)
    });
    assert!(same_results(&one, &four));
}

#[test]
fn a_killed_run_goes_on_where_it_was() {
    let matrix = small_matrix();
    let folder = tempfile::tempdir().unwrap();
    let whole = run_in(&matrix, folder.path(), 1);
    let cells = lines(folder.path());
    // Killed half way, in the middle of a line.
    let kept = cells.len() / 2;
    let half = cells[..kept].join("\n") + "\n" + &cells[kept][..40];
    fs::write(folder.path().join("cells.jsonl"), half).unwrap();

    let mut store = Store::open(&folder.path().join("cells.jsonl")).unwrap();
    assert_eq!(store.dropped(), 1);
    let computed = AtomicUsize::new(0);
    let count = |_| {
        computed.fetch_add(1, Ordering::Relaxed);
    };
    let again = run(std::slice::from_ref(&matrix), &mut store, 2, &count).unwrap();
    assert_eq!(computed.into_inner(), cells.len() - kept);
    assert!(same_results(&whole, &again));
    // Reused cells keep even their time.
    let (before, after) = (&cells[..kept], &lines(folder.path())[..kept]);
    assert_eq!(before, after);

    let idle = AtomicUsize::new(0);
    let count = |_| {
        idle.fetch_add(1, Ordering::Relaxed);
    };
    assert_eq!(run(std::slice::from_ref(&matrix), &mut store, 2, &count).unwrap(), again);
    assert_eq!(idle.into_inner(), 0, "a finished matrix computes nothing");
}

#[test]
fn a_broken_line_is_computed_again() {
    let matrix = small_matrix();
    let folder = tempfile::tempdir().unwrap();
    let whole = run_in(&matrix, folder.path(), 1);
    let mut cells = lines(folder.path());
    cells[0] = "{\"key\":".to_owned();
    fs::write(folder.path().join("cells.jsonl"), cells.join("\n") + "\n").unwrap();
    assert!(same_results(&whole, &run_in(&matrix, folder.path(), 1)));
    assert_eq!(lines(folder.path()).len(), cells.len() + 1);
}

#[test]
fn a_cell_is_reused_only_for_the_same_question() {
    let folder = tempfile::tempdir().unwrap();
    let matrix = small_matrix();
    run_in(&matrix, folder.path(), 1);
    let before = lines(folder.path()).len();
    let more = Matrix { iterations: Some(3), ..matrix };
    run_in(&more, folder.path(), 1);
    // Only the rows that iterate are asked anew by the number of iterations; a key holds it for all.
    assert!(lines(folder.path()).len() > before);
}

/// The program itself, killed in the middle: what was finished is kept, and the results are those of a
/// run that nothing disturbed.
#[test]
fn a_killed_program_goes_on_where_it_was() {
    use std::process::{Command, Stdio};
    let start = |out: &std::path::Path| {
        let arguments =
            ["leaderboard", "--quick", "--json", "--threads", "1", "--protocol", "multi"];
        let mut program = Command::new(env!("CARGO_BIN_EXE_mocap-repro"));
        program.args(arguments).args([
            "--methods",
            "linear,dynammo,ridge",
            "--iterations",
            "3",
            "--out",
        ]);
        program.arg(out).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    };
    let folder = tempfile::tempdir().unwrap();
    let (killed, whole) = (folder.path().join("killed"), folder.path().join("whole"));
    let cells = |out: &std::path::Path| -> usize {
        fs::read_to_string(out.join("cells.jsonl")).map_or(0, |text| text.lines().count())
    };
    let mut first = start(&killed);
    while cells(&killed) < 5 && first.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    first.kill().unwrap();
    first.wait().unwrap();
    let kept = lines(&killed);
    assert!(start(&killed).wait().unwrap().success());
    assert!(start(&whole).wait().unwrap().success());
    assert_eq!(cells(&killed), cells(&whole), "no cell is computed twice");
    // The last line that was found may have been cut off.
    let sure = kept.len().saturating_sub(1);
    assert_eq!(lines(&killed)[..sure], kept[..sure], "finished cells keep even their time");
    let untimed = |out: &std::path::Path| {
        // All columns but the last, which is the time.
        let text = fs::read_to_string(out.join("leaderboard.csv")).unwrap();
        let rows = text.lines().map(|row| row.rsplit_once(',').unwrap().0.to_owned());
        rows.collect::<Vec<_>>()
    };
    assert_eq!(untimed(&killed), untimed(&whole));
}
