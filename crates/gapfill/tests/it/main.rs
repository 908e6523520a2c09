//! Every method of the registry keeps the contract, and wrong options are refused early.
#![allow(clippy::unwrap_used)] // tests

mod auto;
mod properties;
mod session;

use std::ops::ControlFlow;

use gapfill::{
    Body, Bones, Borders, BuildError, Coordinates, DEFAULT, Joined, METHODS, Options, build,
};
use mocap_core::{
    Estimates, FillError, FillReport, Filled, GapFiller, IterReport, MarkerKnowledge, MarkerSet,
    Take, Termination, geometry::distance,
};
use mocap_testkit::{Claims, articulated_take, conformance, with_gaps};
use ndarray::Array3;
use proptest::prelude::*;

#[test]
fn every_method_conforms() {
    let bodies = vec![segments(["A0", "A1", "A2", "A3", "B0", "B1", "B2", "B3"])];
    let options = Options { iterations: Some(5), bodies, ..Options::default() };
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
    let plain = Options {
        borders: Some(Borders::Join),
        known: known.clone(),
        bones: Bones::Auto(known),
        bodies: vec![segments(["p0", "p1", "p2", "p3", "p4", "p5", "p6", "p7"])],
        ..plain
    };
    let changes = [
        ("max-error", Options { max_error_m: Some(1e-9), ..plain.clone() }),
        ("hidden", Options { hidden: Some(4), ..plain.clone() }),
        ("iterations", Options { iterations: Some(6), ..plain.clone() }),
        ("bones", Options { bones: Bones::None, ..plain.clone() }),
        ("lambda", Options { lambda: Some(10.0), ..plain.clone() }),
        ("borders", Options { borders: Some(Borders::Keep), ..plain.clone() }),
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

/// The two segments of the articulated take, with these markers.
fn segments(names: [&str; 8]) -> Body {
    let places = ["0.05 0.04 -0.05", "-0.05 0.03 -0.15", "0.04 -0.05 -0.28", "-0.03 -0.04 -0.40"];
    let marker = |(m, name): (usize, &&str)| {
        let segment = if m < 4 { "upper" } else { "lower" };
        format!("marker {name} {segment} {}", places[m % 4])
    };
    let markers: Vec<String> = names.iter().enumerate().map(marker).collect();
    let text = format!("joint upper\njoint lower upper 0 0 -0.45\n{}", markers.join("\n"));
    Body::parse(&text, "segments").unwrap()
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

/// A filler that is off by a constant or a slope is put right by joining.
struct Askew([f64; 3], [f64; 3]);

impl GapFiller for Askew {
    fn name(&self) -> &'static str {
        "askew"
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let mut positions = take.positions().to_owned();
        for gap in take.gaps() {
            for t in gap.frames {
                let truth = path(t);
                for a in 0..3 {
                    let off = self.0[a] + t as f64 * self.1[a];
                    positions[(t, gap.marker, a)] = truth[a] + off;
                }
            }
        }
        let report = FillReport::new("askew", Termination::ClosedForm);
        Ok(Filled::merge(take, Estimates { positions, sigma_m: None }, report)?)
    }
}

/// A marker that accelerates evenly, so that its own border step is zero.
fn path(t: usize) -> [f64; 3] {
    let x = t as f64 / 100.0;
    [x * x, 1.0 - x, 0.5 + 3.0 * x * x]
}

proptest! {
    #[test]
    fn joining_takes_out_an_offset(
        offset in prop::array::uniform3(-0.1..0.1_f64),
        start in 2_usize..20,
        length in 1_usize..20,
    ) {
        let joined = filled_by(Askew(offset, [0.0; 3]), start, length);
        for t in start..start + length {
            let p = joined.take().position(t, 0).unwrap();
            // Differences of numbers of order one, a dozen roundings.
            prop_assert!(distance(p, path(t)) < 1e-14 * 20.0, "frame {}", t);
        }
    }

    /// A sloping offset tilts the fill's own moves too; what is left at a border is half a frame's tilt.
    #[test]
    fn joining_leaves_half_a_frame_of_a_slope(
        slope in prop::array::uniform3(-0.01..0.01_f64),
        start in 3_usize..20,
        length in 4_usize..20,
    ) {
        let joined = filled_by(Askew([0.0; 3], slope), start, length);
        let tilt = slope.iter().map(|c| c * c).sum::<f64>().sqrt();
        for t in start..start + length {
            let p = joined.take().position(t, 0).unwrap();
            prop_assert!(distance(p, path(t)) <= 0.5 * tilt + 1e-12, "frame {}", t);
        }
    }
}

#[test]
fn a_one_sided_gap_is_shifted_as_a_whole() {
    let joined = filled_by(Askew([0.02, 0.0, 0.0], [0.0; 3]), 30, 10);
    assert!((30..40).all(|t| distance(joined.take().position(t, 0).unwrap(), path(t)) < 1e-14));
}

/// Forty frames of the path with a gap, filled and joined.
fn filled_by(filler: Askew, start: usize, length: usize) -> Filled {
    let xyz = Array3::from_shape_fn((40, 1, 3), |(t, _, a)| {
        if (start..start + length).contains(&t) { f64::NAN } else { path(t)[a] }
    });
    let take = Take::from_positions(MarkerSet::new(["C7"]).unwrap(), 100.0, xyz).unwrap();
    Joined::new(filler).fill(&take).unwrap()
}
