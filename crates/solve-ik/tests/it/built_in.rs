//! The bodies for the layouts of `mocap-synth`: files of means over people that it draws.

use std::{fmt::Write, path::Path};

use mocap_core::geometry::distance;
use mocap_synth::{Activity, Hands, Layout, Person, SynthParams, SyntheticTake};
use solve_ik::{Body, IkParams, IkSolver, Solution};

use crate::worn::{people_body, record_with};

const LAYOUTS: [Layout; 2] = [Layout::FrontWaist53, Layout::Production57];

/// Other names of markers: in Vicon's own body of 53 markers `LWRE` sits on the forearm and `LHIP` on the thigh.
const ALIASES: &str = "\
alias LFRM LWRE
alias RFRM RWRE
alias LTHI LHIP
alias RTHI RHIP
";

/// The body of a layout as a text, means over forty people.
fn means(layout: Layout) -> String {
    people_body(&SynthParams { layout, hands: Hands::Ten, ..SynthParams::default() }).to_string()
}

/// A line of it in the axes of the file.
fn converted(line: &str) -> String {
    let words: Vec<&str> = line.split(' ').collect();
    let first = match words[0] {
        "joint" | "marker" => 3,
        "spread" => 4,
        "t-pose" => 2,
        _ => words.len(),
    };
    let mut words: Vec<String> = words.into_iter().map(str::to_owned).collect();
    // The generator's people face x and have z up.
    if let Some(place) = words.get_mut(first..first + 3) {
        place.rotate_left(1);
        for c in place {
            *c = format!("{:.4}", c.parse::<f64>().unwrap() + 0.0);
        }
    }
    words.join(" ") + "\n"
}

/// The file of a layout.
fn written(layout: Layout) -> String {
    let mut text = format!(
        "# A body for the marker layout {layout}, with up to ten markers on each hand.\n\
         #\n\
         # Rest pose: upright with hanging arms, x to the left, y up, z ahead; metres. Bones and places of markers are means\n\
         # over forty people of mocap-synth. `SOLVE_IK_WRITE=1 cargo test -p solve-ik built_in` writes this file.\n"
    );
    for line in means(layout).lines() {
        if line.starts_with("name ") {
            writeln!(text, "name {layout}").unwrap();
        } else {
            text += &converted(line);
        }
    }
    if layout == Layout::FrontWaist53 {
        text += "# Worn on the sides of the waist by some, as in production-57.\n";
        let others = means(Layout::Production57);
        let sides = |line: &&str| {
            ["marker LMWT ", "marker RMWT "].iter().any(|name| line.starts_with(name))
        };
        text.extend(others.lines().filter(sides).map(converted));
    }
    text + ALIASES
}

/// Mean distance of the joints of the trunk and limbs from where they really are, in metres.
fn joints_off(solution: &Solution, truth: &SyntheticTake) -> f64 {
    let (found, real) = (&solution.motion, truth.motion());
    let pairs: Vec<(usize, usize)> = (0..22)
        .map(|j| (found.skeleton().find(&real.skeleton().joints()[j].name).unwrap(), j))
        .collect();
    let mut sum = 0.0;
    for (p, q) in found.poses().iter().zip(real.poses()) {
        let (p, q) =
            (found.skeleton().positions(p).unwrap(), real.skeleton().positions(q).unwrap());
        sum += pairs.iter().map(|&(a, b)| distance(p[a], q[b])).sum::<f64>();
    }
    sum / (pairs.len() * real.poses().len()) as f64
}

#[test]
fn built_in_bodies_are_means_over_people() {
    for layout in LAYOUTS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("data/{layout}.body"));
        let text = written(layout);
        if std::env::var_os("SOLVE_IK_WRITE").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        assert!(std::fs::read_to_string(&path).unwrap() == text, "{}", path.display());
    }
}

#[test]
fn a_take_of_a_known_layout_finds_its_body() {
    for (layout, hands) in [
        (Layout::Cmu41, Hands::None),
        (Layout::FrontWaist53, Hands::None),
        (Layout::FrontWaist53, Hands::Five),
        (Layout::Production57, Hands::Ten),
    ] {
        let params = SynthParams {
            motion: Activity::Throw,
            frames: 400,
            seed: 4,
            layout,
            hands,
            person: Some(Person::draw(11)),
            ..SynthParams::default()
        };
        let recorded = record_with(&params);
        let bodies = Body::for_markers(Body::built_in(), recorded.take().markers());
        let body = &bodies[0];
        let solver = IkSolver::new(body.clone(), IkParams::default()).unwrap();
        let solution = solver.solve(recorded.take()).unwrap();
        assert!(solution.unmapped.is_empty(), "{layout}: {:?}", solution.unmapped);
        if layout == Layout::Cmu41 {
            assert_eq!(*body, Body::cmu_41());
            continue;
        }
        let found = body.skeleton().joints().len();
        assert_eq!(found, 22 + 30);
        let off = joints_off(&solution, &recorded);
        println!("{layout}, {hands:?} on the hands: JPE {:.2} cm", 100.0 * off);
        assert!(off < 0.015, "{layout}: {off} m");
    }
}
