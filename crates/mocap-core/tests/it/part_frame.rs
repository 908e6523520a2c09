use mocap_core::{
    Alignment, CoreError, MarkerSet, Mask, PairAxis, PartFrame, PartMarkers, RigidTransform,
    Rotation, Side, Take,
    geometry::{add, cross, distance, dot, norm, scale, sub},
};
use ndarray::Array3;
use proptest::prelude::*;

const WAIST: [(&str, [f64; 3]); 8] = [
    ("LFWT", [0.12, 0.00, 0.11]),
    ("MFWT", [0.00, 0.01, 0.13]),
    ("RFWT", [-0.12, 0.00, 0.11]),
    ("LBWT", [0.06, 0.03, -0.10]),
    ("MBWT", [0.00, 0.02, -0.12]),
    ("RBWT", [-0.06, 0.03, -0.10]),
    ("STRN", [0.00, 0.30, 0.13]),
    ("T10", [0.00, 0.28, -0.09]),
];

fn tumbling(t: usize) -> RigidTransform {
    let t = t as f64;
    RigidTransform {
        rotation: Rotation::about([0.3, 1.0, -0.4], 0.21 * t)
            .after(Rotation::about([1.0, 0.2, 0.0], 0.13 * t)),
        translation: [0.05 * t, 1.0 + 0.2 * (0.3 * t).sin(), -0.03 * t],
    }
}

/// A waist that tumbles through every attitude, upside down too; its markers are off by a few millimetres.
fn waist(frames: usize) -> Take {
    let markers = MarkerSet::new(WAIST.iter().map(|m| m.0)).unwrap();
    let xyz = Array3::from_shape_fn((frames, 8, 3), |(t, m, a)| {
        let off = |k: usize| 0.003 * ((t * 7 + m * 3 + k) as f64).sin();
        tumbling(t).apply(add(WAIST[m].1, [off(0), off(1), off(2)]))[a]
    });
    Take::from_positions(markers, 120.0, xyz).unwrap()
}

fn frame(take: &Take) -> PartFrame {
    PartFrame::estimate(take, &PartMarkers::waist(take.markers()).unwrap()).unwrap()
}

#[test]
fn complete_frames_have_the_published_axes() {
    let take = waist(60);
    let local = frame(&take);
    assert!(local.alignment().iter().all(|a| *a == Alignment::Direct));
    for t in 0..60 {
        let at = |name: &str| take.position(t, take.markers().find(name).unwrap()).unwrap();
        let mean = |names: &[&str]| {
            scale(1.0 / names.len() as f64, names.iter().fold([0.0; 3], |s, n| add(s, at(n))))
        };
        let unit = |p: [f64; 3]| scale(1.0 / norm(p), p);
        let low = mean(&["LFWT", "MFWT", "RFWT", "LBWT", "MBWT", "RBWT"]);
        let up = unit(sub(mean(&["STRN", "T10"]), low));
        let pairs = [("STRN", "T10"), ("RFWT", "RBWT"), ("MFWT", "MBWT"), ("LFWT", "LBWT")];
        let ahead = pairs.iter().fold([0.0; 3], |s, (f, b)| add(s, sub(at(f), at(b))));
        let ahead = unit(sub(ahead, scale(dot(ahead, up), up)));
        let axes = [cross(up, ahead), up, ahead];
        let transform = local.to_world(t);
        for (k, axis) in axes.into_iter().enumerate() {
            let mut e = [0.0; 3];
            e[k] = 1.0;
            assert!(distance(transform.rotation.apply(e), axis) < 1e-14, "frame {t} axis {k}");
        }
        let all: Vec<&str> = WAIST.iter().map(|m| m.0).collect();
        assert!(distance(transform.translation, mean(&all)) < 1e-15);
    }
}

#[test]
fn the_other_layouts_and_the_wrists_are_known_too() {
    let production = ["LFWT", "LMWT", "LBWT", "RFWT", "RMWT", "RBWT", "STRN", "T10"];
    let cmu = ["LFWT", "RFWT", "LBWT", "RBWT", "STRN", "T10"];
    for names in [&production[..], &cmu[..]] {
        let markers = MarkerSet::new(names.iter().copied()).unwrap();
        assert_eq!(PartMarkers::waist(&markers).unwrap().all().len(), names.len());
    }
    assert_eq!(PartMarkers::waist(&MarkerSet::new(["LFWT", "STRN"]).unwrap()), None);
    // A right hand that points ahead, palm down: fingers along y, thumb to the left along x.
    let places = [
        ("RIWR", [0.03, 0.0, 0.0]),
        ("ROWR", [-0.03, 0.0, 0.0]),
        ("RIHAND", [0.03, 0.08, 0.0]),
        ("ROHAND", [-0.03, 0.07, 0.0]),
    ];
    let markers = MarkerSet::new(places.iter().map(|p| p.0)).unwrap();
    let xyz = Array3::from_shape_fn((1, 4, 3), |(_, m, a)| places[m].1[a]);
    let take = Take::from_positions(markers, 100.0, xyz).unwrap();
    assert_eq!(PartMarkers::wrist(take.markers(), Side::Left), None);
    let wrist = PartMarkers::wrist(take.markers(), Side::Right).unwrap();
    let local = PartFrame::estimate(&take, &wrist).unwrap();
    let x = local.to_world(0).rotation.apply([1.0, 0.0, 0.0]);
    assert!(distance(x, [1.0, 0.0, 0.0]) < 1e-12, "{x:?}");
}

#[test]
fn missing_markers_leave_the_frame_near_and_flagged() {
    let whole = waist(80);
    let truth = frame(&whole);
    // From frame 20 on one waist marker is gone, from 40 on five of eight, from 60 on all but two.
    let hidden = Mask::from_fn(80, 8, |t, m| match t {
        0..20 => false,
        20..40 => m == 1,
        40..60 => [0, 1, 4, 5, 7].contains(&m),
        _ => m > 1,
    });
    let local = frame(&whole.hide(&hidden).unwrap());
    for t in 0..80 {
        let expected = match t {
            0..20 => Alignment::Direct,
            20..60 => Alignment::Fitted,
            _ => Alignment::Lost,
        };
        assert_eq!(local.alignment()[t], expected, "frame {t}");
        let (found, true_one) = (local.to_world(t), truth.to_world(t));
        let turned = found.rotation.inverse().after(true_one.rotation).angle();
        // Markers scatter by 3 mm on a part of 10 to 30 cm.
        match t {
            0..20 => assert!(turned < 1e-12),
            20..40 => assert!(turned < 0.02, "frame {t}: {turned}"),
            40..60 => assert!(turned < 0.05, "frame {t}: {turned}"),
            _ => {}
        }
    }
    // What was lost stays where it was last seen.
    assert_eq!(local.to_world(79), local.to_world(59));
}

#[test]
fn a_gap_between_aligned_frames_is_bridged() {
    let whole = waist(30);
    let hidden = Mask::from_fn(30, 8, |t, _| (10..14).contains(&t));
    let local = frame(&whole.hide(&hidden).unwrap());
    let (before, after) = (local.to_world(9), local.to_world(14));
    let step = before.rotation.inverse().after(after.rotation).angle() / 5.0;
    for t in 9..14 {
        let turned = local.to_world(t).rotation.inverse().after(local.to_world(t + 1).rotation);
        assert!((turned.angle() - step).abs() < 1e-12);
    }
}

#[test]
fn what_spans_no_frame_is_refused() {
    let take = waist(5);
    let empty = PartMarkers::new(vec![], vec![1], vec![(0, 1)], PairAxis::Z);
    assert_eq!(empty, Err(CoreError::NoPartMarkers));
    // Up and ahead along one line.
    let flat = PartMarkers::new(vec![3], vec![0], vec![(3, 0)], PairAxis::Z).unwrap();
    assert_eq!(PartFrame::estimate(&take, &flat), Err(CoreError::NoPartFrame));
    let never = take.hide(&Mask::from_fn(5, 8, |t, m| m == t)).unwrap();
    let markers = PartMarkers::waist(take.markers()).unwrap();
    assert_eq!(PartFrame::estimate(&never, &markers), Err(CoreError::NoPartFrame));
    let other = frame(&waist(6)).localise(&take);
    assert!(matches!(other, Err(CoreError::Shape { .. })));
}

proptest! {
    #[test]
    fn there_and_back_is_exact(
        gaps in prop::collection::vec(any::<bool>(), 30 * 8),
        offset in prop::array::uniform3(-10.0..10.0),
    ) {
        let hidden = Mask::from_fn(30, 8, |t, m| t > 2 && gaps[8 * t + m]);
        let far = waist(30).map_positions(|_, _, p| add(p, offset)).unwrap();
        let take = far.hide(&hidden).unwrap();
        let local = frame(&take);
        let inside = local.localise(&take).unwrap();
        let mut back = inside.positions().to_owned();
        local.globalise(&mut back).unwrap();
        for (t, m) in take.observed().iter() {
            let p = take.position(t, m).unwrap();
            let q = [0, 1, 2].map(|a| back[(t, m, a)]);
            prop_assert!(distance(p, q) < 1e-12, "frame {t} marker {m}");
        }
    }

    #[test]
    fn local_places_do_not_depend_on_where_the_body_is(
        axis in prop::array::uniform3(-1.0..1.0),
        angle in -3.0..3.0,
        translation in prop::array::uniform3(-5.0..5.0),
        gaps in prop::collection::vec(any::<bool>(), 20 * 8),
    ) {
        let hidden = Mask::from_fn(20, 8, |t, m| t > 4 && m > 3 && gaps[8 * t + m]);
        let take = waist(20).hide(&hidden).unwrap();
        let by = RigidTransform { rotation: Rotation::about(axis, angle), translation };
        let moved = take.map_positions(|_, _, p| by.apply(p)).unwrap();
        let (a, b) = (frame(&take).localise(&take).unwrap(), frame(&moved).localise(&moved).unwrap());
        for (t, m) in take.observed().iter() {
            // The fit of few markers magnifies rounding.
            prop_assert!(distance(a.position(t, m).unwrap(), b.position(t, m).unwrap()) < 1e-10);
        }
    }
}
