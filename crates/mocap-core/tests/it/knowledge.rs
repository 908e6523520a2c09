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
fn the_full_body_sets_are_complete_and_the_same_on_both_sides() {
    for (known, count) in
        [(MarkerKnowledge::front_waist_53(), 53), (MarkerKnowledge::production_57(), 57)]
    {
        let set = MarkerSet::new(known.markers().iter().cloned()).unwrap();
        assert_eq!(set.len(), count, "{}", known.name());
        let name = |m: usize| set.name(m).to_owned();
        let mirrored = |m: usize| match name(m).split_at(1) {
            // In the middle.
            (_, "FWT" | "BWT") if name(m).starts_with('M') => name(m),
            ("C" | "A" | "S" | "T", _) => name(m),
            ("L", stem) => format!("R{stem}"),
            ("R", stem) => format!("L{stem}"),
            _ => panic!("{} lies on no side", name(m)),
        };
        let sorted = |a: String, b: String| if a < b { (a, b) } else { (b, a) };
        let pairs = known.bone_pairs(&set);
        let bones: Vec<_> = pairs.iter().map(|&(a, b)| sorted(name(a), name(b))).collect();
        for &(a, b) in &pairs {
            let other = sorted(mirrored(a), mirrored(b));
            assert!(bones.contains(&other), "{}: no {other:?}", known.name());
        }
        // Toes bend, and carry no bone in the CMU set either.
        for m in (0..count).filter(|&m| !name(m).ends_with("TOE")) {
            let is_worn = pairs.iter().any(|&(a, b)| a == m || b == m);
            assert!(is_worn, "{}: {} has no bone", known.name(), name(m));
        }
        for (role, least) in [("back", 5), ("front", 4), ("top", 5), ("bottom", 6)] {
            assert!(known.role(role, &set).len() >= least, "{}: {role}", known.name());
        }
    }
}

#[test]
fn a_take_is_known_by_the_set_of_which_it_has_most() {
    for known in MarkerKnowledge::built_in() {
        let worn = known.markers().iter().map(|m| format!("kim:{m}"));
        let set = MarkerSet::new(worn).unwrap();
        assert_eq!(MarkerKnowledge::for_markers(&set).name(), known.name());
    }
    let foreign = MarkerSet::new(["m1", "m2"]).unwrap();
    assert_eq!(MarkerKnowledge::best(&MarkerKnowledge::built_in(), &foreign), None);
    assert_eq!(MarkerKnowledge::for_markers(&foreign).name(), "CMU-41");
    // A set of one's own that fits as well goes first.
    let own = MarkerKnowledge::parse("name mine\nmarker C7\nmarker T10\nbone C7 T10", "t").unwrap();
    let sets = [vec![own], MarkerKnowledge::built_in()].concat();
    let all = MarkerSet::new(MarkerKnowledge::cmu_41().markers().iter().cloned()).unwrap();
    assert_eq!(MarkerKnowledge::best(&sets, &all).unwrap().name(), "mine");
}

/// Vicon's own body of 53 markers: `LWRE` sits on the forearm, as far from the elbow in every frame, and `LHIP` on the thigh.
#[test]
fn other_names_of_forearm_and_thigh_are_known() {
    let known = MarkerKnowledge::front_waist_53();
    let set = MarkerSet::new(["LELB", "LWRE", "LOWR", "LKNE", "LHIP", "LFWT", "LMWT"]).unwrap();
    let pairs = known.bone_pairs(&set);
    for bone in [(1, 0), (1, 2), (3, 4), (4, 5), (6, 5)] {
        assert!(pairs.contains(&bone), "{bone:?} of {pairs:?}");
    }
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
