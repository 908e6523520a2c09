//! Recordings with gaps of their own.

use mocap_core::Mask;
use mocap_io::{Edit, MarkerFile, ReadOptions};
use mocap_repro::{ReproError, Variant, raw_fills, raw_table};

use crate::fixtures;

/// A folder with the fixture that walks, a knee and a shin hidden for half a second, and the one that jumps, complete.
fn data() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("captures")).unwrap();
    let read =
        |name: &str| MarkerFile::read(&fixtures().join(name), &ReadOptions::default()).unwrap();
    let walk = read("walk.c3d");
    let take = walk.take();
    let hidden: Vec<usize> =
        ["RKNE", "RSHN"].iter().map(|m| take.markers().find(m).unwrap()).collect();
    let mask = Mask::from_fn(take.frames(), take.marker_count(), |t, m| {
        hidden.contains(&m) && (60..120).contains(&t)
    });
    let bytes = walk.patched(&Edit::hides(take, &mask)).unwrap();
    std::fs::write(folder.path().join("captures/lab__walk.c3d"), bytes).unwrap();
    std::fs::write(folder.path().join("captures/lab__jump.c3d"), read("jump.c3d").bytes()).unwrap();
    std::fs::write(folder.path().join("captures/notes.txt"), "no recording").unwrap();
    folder
}

#[test]
fn every_method_leaves_the_measured_samples() {
    let folder = data();
    let mut told = 0;
    let fills = raw_fills(folder.path(), &Variant::all(), Some(2), |_| told += 1).unwrap();
    assert_eq!((fills.len(), told), (Variant::all().len(), fills.len()));
    for fill in &fills {
        assert_eq!((fill.recording.as_str(), fill.gaps, fill.altered), ("walk", 2, 0), "{fill:?}");
        assert_eq!(fill.filled + fill.refused, 2);
        assert_eq!(fill.failed, None);
    }
    let by = |method: &str| fills.iter().find(|fill| fill.method == method).unwrap();
    assert_eq!((by("ridge").filled, by("linear").filled), (2, 2));
    // A straight line across half a second of a step bends at its ends and stretches the shank.
    assert!(by("linear").border_max_mm > by("ridge").border_max_mm);
    assert!(by("linear").bones_filled_mm > by("ridge").bones_filled_mm);
    let markdown = raw_table(&fills).to_markdown();
    assert!(markdown.contains("| walk | ridge |"), "{markdown}");
}

#[test]
fn a_folder_without_gaps_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let error = raw_fills(folder.path(), &Variant::all(), None, |_| ()).unwrap_err();
    assert!(matches!(error, ReproError::Motion { .. }), "{error}");
}
