use mocap_core::{CoreError, MarkerKnowledge, MarkerSet};

#[test]
fn cmu_41_is_complete() {
    let known = MarkerKnowledge::cmu_41();
    assert_eq!(known.name(), "CMU-41");
    assert_eq!(known.markers().len(), 41);
    let set = MarkerSet::new(known.markers().iter().cloned()).unwrap();
    assert!((known.coverage(&set) - 1.0).abs() < 1e-15);
    // 60 pairs are known; 13 of them need a marker that only some sessions wear.
    assert_eq!(known.bone_pairs(&set).len(), 47);
    assert!(known.bone_pairs(&set).iter().all(|&(a, b)| a != b && a < 41 && b < 41));
}

#[test]
fn prefixes_aliases_and_case_do_not_matter() {
    let known = MarkerKnowledge::cmu_41();
    let set = MarkerSet::new(["jo:lasi", "jo:LPSI", "jo:STRN", "jo:LTHI"]).unwrap();
    let mut pairs = known.bone_pairs(&set);
    pairs.sort_unstable();
    assert_eq!(pairs, [(0, 1), (0, 2), (3, 0), (3, 1)]);
    assert_eq!(known.role("front", &set), [2, 0]);
}

#[test]
fn subjects_are_kept_apart() {
    let known = MarkerKnowledge::cmu_41();
    let set = MarkerSet::new(["a:LELB", "b:LUPA", "b:LELB"]).unwrap();
    assert_eq!(known.bone_pairs(&set), [(2, 1)]);
}

#[test]
fn an_own_name_wins_over_an_alias() {
    let known = MarkerKnowledge::parse("marker A\nmarker B\nalias A X\nbone A B", "t").unwrap();
    let set = MarkerSet::new(["X", "A", "B"]).unwrap();
    assert_eq!(known.bone_pairs(&set), [(1, 2)]);
}

#[test]
fn wrong_lines_name_file_line_and_rule() {
    for text in ["bone A B", "marker A\nbone A A", "marker A B", "colour red", "alias", "role x"] {
        let error = MarkerKnowledge::parse(text, "mine.markers").unwrap_err();
        let CoreError::MarkerSetLine { file, line, .. } = &error else { panic!("{error}") };
        assert_eq!(file, "mine.markers");
        assert_eq!(*line, text.lines().count());
    }
}
