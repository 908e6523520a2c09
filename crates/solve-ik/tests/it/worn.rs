//! The body and layout of `mocap-synth` as a body file, with the bones of another person than the one who is solved.

use std::fmt::Write;

use mocap_synth::{Activity, Synth, SynthParams, SyntheticTake, marker_sites};
use solve_ik::Body;

/// Standard deviations of the joints in degrees; about one axis and across it for hinges.
const SPREADS: [(&str, &str); 14] = [
    ("spine", "10"),
    ("neck", "12"),
    ("head", "12"),
    ("left_clavicle", "12"),
    ("right_clavicle", "12"),
    ("shoulder", "60"),
    ("elbow", "60 30 0 1 0"),
    ("wrist", "30"),
    ("hip", "40"),
    ("knee", "60 8 0 1 0"),
    ("ankle", "25"),
    ("toe", "15 3 0 1 0"),
    ("pelvis", "60"),
    ("pelvis", "60"),
];

pub fn record(motion: Activity, frames: usize, seed: u64) -> SyntheticTake {
    let params = SynthParams { motion, frames, seed, ..SynthParams::default() };
    Synth::new(params).unwrap().take().unwrap()
}

/// The true layout on the mean bones of many other bodies.
pub fn synthetic_body() -> Body {
    const BODIES: u64 = 40;
    let others: Vec<SyntheticTake> =
        (0..BODIES).map(|seed| record(Activity::Walk, 1, 900 + seed)).collect();
    let mut joints = others[0].motion().skeleton().joints().to_vec();
    for (j, joint) in joints.iter_mut().enumerate() {
        joint.offset_m = std::array::from_fn(|a| {
            let sum: f64 =
                others.iter().map(|o| o.motion().skeleton().joints()[j].offset_m[a]).sum();
            sum / BODIES as f64
        });
    }
    let mut text = String::from("name synthetic body\n");
    for joint in &joints {
        let [x, y, z] = joint.offset_m;
        match joint.parent {
            None => {
                writeln!(text, "joint {}", joint.name).unwrap();
            }
            Some(p) => {
                writeln!(text, "joint {} {} {x} {y} {z}", joint.name, joints[p].name).unwrap();
            }
        }
        let spread = SPREADS.iter().find(|(part, _)| joint.name.contains(part)).unwrap().1;
        writeln!(text, "spread {} {spread}", joint.name).unwrap();
    }
    for site in marker_sites() {
        let (mut near, mut place, (far, share)) = (site.joint, site.offset_m, site.pull);
        let mut pull = (share > 0.0).then_some((far, share));
        if share > 0.0 && joints[near].parent == Some(far) {
            // Written from the upper of the two joints.
            (0..3).for_each(|a| place[a] += joints[near].offset_m[a]);
            pull = Some((near, 1.0 - share));
            near = far;
        }
        let [x, y, z] = place;
        write!(text, "marker {} {} {x} {y} {z}", site.label, joints[near].name).unwrap();
        if let Some((far, share)) = pull {
            write!(text, " share {} {share}", joints[far].name).unwrap();
        }
        text.push_str(" spread 0.015\n");
    }
    Body::parse(&text, "synthetic.body").unwrap()
}
