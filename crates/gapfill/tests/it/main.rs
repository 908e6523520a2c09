//! Every method of the registry keeps the contract, and wrong options are refused early.
#![allow(clippy::unwrap_used)] // tests

use gapfill::{Bones, BuildError, Coordinates, DEFAULT, METHODS, Options, build};
use mocap_core::{MarkerKnowledge, MarkerSet, Take};
use mocap_testkit::{Claims, articulated_take, conformance, with_gaps};

#[test]
fn every_method_conforms() {
    let options = Options { iterations: Some(5), ..Options::default() };
    for method in METHODS {
        let filler = build(method.id, &options).unwrap();
        conformance(filler.as_ref(), &Claims::default());
    }
}

#[test]
fn ids_are_unique_and_the_default_is_one_of_them() {
    let mut ids: Vec<_> = METHODS.iter().map(|m| m.id).collect();
    ids.sort_unstable();
    assert!(ids.windows(2).all(|w| w[0] != w[1]));
    assert!(ids.contains(&DEFAULT));
    for method in METHODS {
        assert_eq!(build(method.id, &Options::default()).unwrap().name(), method.id);
    }
}

#[test]
fn wrong_options_are_refused_when_building() {
    assert!(matches!(refusal("magic", &Options::default()), BuildError::Unknown { .. }));
    for options in [
        Options { hidden: Some(0), ..Options::default() },
        Options { iterations: Some(0), ..Options::default() },
        Options { lambda: Some(-1.0), ..Options::default() },
        Options { lambda: Some(f64::NAN), ..Options::default() },
    ] {
        assert!(
            matches!(refusal("bolero-sc", &options), BuildError::Options { .. }),
            "{options:?}"
        );
    }
}

fn refusal(id: &str, options: &Options) -> BuildError {
    match build(id, options) {
        Err(error) => error,
        Ok(filler) => panic!("{} was built", filler.name()),
    }
}

/// The options that `METHODS` says a method reads change its result or its refusals, and the others do not.
#[test]
fn methods_read_the_options_they_name() {
    let plain = Options { iterations: Some(4), hidden: Some(6), ..Options::default() };
    let holdout = with_gaps(dressed(&articulated_take(80, 3)), 3, 3, 4..=9);
    let known = vec![MarkerKnowledge::parse(BODY, "body").unwrap()];
    let plain = Options { known: known.clone(), bones: Bones::Auto(known), ..plain };
    let changes = [
        ("hidden", Options { hidden: Some(4), ..plain.clone() }),
        ("iterations", Options { iterations: Some(6), ..plain.clone() }),
        ("bones", Options { bones: Bones::None, ..plain.clone() }),
        ("lambda", Options { lambda: Some(10.0), ..plain.clone() }),
        ("frame", Options { coordinates: Some(Coordinates::Body), ..plain.clone() }),
    ];
    for method in METHODS {
        let usual = fill(method.id, &plain, holdout.visible());
        for (name, options) in &changes {
            let changed = fill(method.id, options, holdout.visible());
            let reads = method.options.contains(name);
            assert_eq!(usual.bit_eq(&changed), !reads, "{} and `{name}`", method.id);
        }
    }
}

fn fill(id: &str, options: &Options, take: &Take) -> Take {
    build(id, options).unwrap().fill(take).unwrap().take().clone()
}

/// Names for the eight markers of the articulated take, and where it faces.
const BODY: &str = "marker p0\nmarker p1\nmarker p2\nmarker p3\nmarker p4\nmarker p5\nmarker p6\nmarker p7\n\
    bone p0 p1\nbone p1 p2\nbone p2 p3\nbone p4 p5\nbone p5 p6\nbone p6 p7\nbone p3 p4\nbone p0 p7\n\
    role back p0 p1\nrole front p2 p3\n";

fn dressed(take: &Take) -> Take {
    let names = (0..take.marker_count()).map(|m| format!("p{m}"));
    Take::from_positions(
        MarkerSet::new(names).unwrap(),
        take.rate_hz(),
        take.positions().to_owned(),
    )
    .unwrap()
}
