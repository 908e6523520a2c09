//! The body and layouts of `mocap-synth` as body files, with the mean bones and marker places of many other people than the one
//! who is solved.

use std::fmt::Write;

use augment::{GapSampler, GapSamplerParams, Preset, Unlisted};
use metrics::JointPoses;
use mocap_core::{
    Holdout, Motion, Rotation, Take,
    geometry::{add, scale},
};
use mocap_synth::{Activity, Attachment, Hands, Person, Synth, SynthParams, SyntheticTake};
use ndarray::{Array3, Array4};
use solve_ik::Body;

/// Standard deviations of the joints in degrees; about one axis and across it for hinges. The first part of a name that
/// fits counts.
const SPREADS: [(&str, &str); 19] = [
    ("thumb1", "25"),
    ("left_thumb", "35 5 0.036 0.892 -0.451"),
    ("right_thumb", "35 5 -0.036 0.892 0.451"),
    ("2", "45 3 1 0 0"),
    ("3", "30 3 1 0 0"),
    ("index", "45 12 1 0 0"),
    ("middle1", "45 12 1 0 0"),
    ("pinky", "45 12 1 0 0"),
    ("ring", "45 12 1 0 0"),
    ("spine", "10"),
    ("neck", "12"),
    ("head", "12"),
    ("clavicle", "12"),
    ("shoulder", "60"),
    ("elbow", "60 30 0 1 0"),
    ("wrist", "30"),
    ("knee", "60 8 0 1 0"),
    ("toe", "15 3 0 1 0"),
    ("", "40"),
];

/// Degrees by which hinges turn about their axes; the generator's people face x and have z up.
const LIMITS: [(&str, &str); 6] = [
    ("knee", "-5 165"),
    ("elbow", "-165 10"),
    // Fingers of hanging hands bend towards the thighs.
    ("left_finger2", "-125 5"),
    ("left_finger3", "-95 10"),
    ("right_finger2", "-5 125"),
    ("right_finger3", "-10 95"),
];

pub fn record(motion: Activity, frames: usize, seed: u64) -> SyntheticTake {
    record_with(&SynthParams { motion, frames, seed, ..SynthParams::default() })
}

pub fn record_with(params: &SynthParams) -> SyntheticTake {
    Synth::new(*params).unwrap().take().unwrap()
}

/// The generic body of the CMU layout.
pub fn synthetic_body() -> Body {
    generic_body(&SynthParams::default())
}

/// The generic body of a layout: its means over forty bodies of the template's size.
pub fn generic_body(params: &SynthParams) -> Body {
    mean_body(params, |_| None)
}

/// The body of a layout for people of all sizes: its means over forty of them.
pub fn people_body(params: &SynthParams) -> Body {
    mean_body(params, |seed| Some(Person::draw(seed)))
}

fn mean_body(params: &SynthParams, person: impl Fn(u64) -> Option<Person>) -> Body {
    const PEOPLE: u64 = 40;
    let record =
        |seed| record_with(&SynthParams { frames: 1, seed, person: person(seed), ..*params });
    let others: Vec<SyntheticTake> = (900..900 + PEOPLE).map(record).collect();
    let mean = |value: &dyn Fn(&SyntheticTake) -> [f64; 3]| {
        scale(1.0 / PEOPLE as f64, others.iter().map(value).fold([0.0; 3], add))
    };
    let bone = |j: usize| mean(&|o| o.motion().skeleton().joints()[j].offset_m);
    let place = |m: usize, k: usize| mean(&|o| o.attachments()[m].local_m[k]);
    body(&others[0], params.hands, &bone, &place, "0.02")
}

/// A generic body with the true places of one person's markers.
pub fn true_layout(truth: &SyntheticTake, generic: &Body) -> Body {
    let joints = generic.skeleton().joints();
    let bone = |j: usize| joints[j].offset_m;
    let place = |m: usize, k: usize| truth.attachments()[m].local_m[k];
    body(truth, Hands::None, &bone, &place, "0.0005")
}

/// The take with a tenth of its samples hidden, in gaps as they occur.
pub fn tenth_hidden(take: &Take, seed: u64) -> Holdout {
    let unlisted = Unlisted::Mean;
    let params = GapSamplerParams { occlusion: 0.1, seed, unlisted, ..GapSamplerParams::default() };
    let sampler = GapSampler::new(Preset::FrontWaist.model().unwrap(), params).unwrap();
    sampler.sample(take).unwrap().holdout
}

/// Joints of a motion over time, for the metrics.
pub struct Tracks {
    positions: Array3<f64>,
    rotations: Array4<f64>,
}

impl Tracks {
    pub fn of(motion: &Motion) -> Self {
        let skeleton = motion.skeleton();
        let all: Vec<usize> = (0..skeleton.joints().len()).collect();
        Self::some(motion, &all, Rotation::IDENTITY)
    }

    /// Some joints of a motion, turned in the world.
    pub fn some(motion: &Motion, joints: &[usize], turned: Rotation) -> Self {
        let size = (motion.poses().len(), joints.len());
        let mut tracks = Self {
            positions: Array3::zeros((size.0, size.1, 3)),
            rotations: Array4::zeros((size.0, size.1, 3, 3)),
        };
        for (t, pose) in motion.poses().iter().enumerate() {
            let frames = motion.skeleton().frames(pose).unwrap();
            for (k, &j) in joints.iter().enumerate() {
                let origin = turned.apply(frames.origins_m[j]);
                let matrix = turned.after(frames.rotations[j]).matrix();
                for a in 0..3 {
                    tracks.positions[(t, k, a)] = origin[a];
                    (0..3).for_each(|b| tracks.rotations[(t, k, a, b)] = matrix[a][b]);
                }
            }
        }
        tracks
    }

    pub fn poses(&self) -> JointPoses<'_> {
        JointPoses::new(self.positions.view(), self.rotations.view()).unwrap()
    }
}

type Mean<'a, Of> = &'a dyn Fn(Of) -> [f64; 3];

fn body(
    like: &SyntheticTake,
    hands: Hands,
    bone: Mean<'_, usize>,
    place: &dyn Fn(usize, usize) -> [f64; 3],
    spread: &str,
) -> Body {
    let joints = like.motion().skeleton().joints();
    let mut text = String::from("name synthetic body\n");
    for (j, joint) in joints.iter().enumerate() {
        match joint.parent {
            None => writeln!(text, "joint {}", joint.name).unwrap(),
            Some(p) => {
                let [x, y, z] = bone(j);
                writeln!(text, "joint {} {} {x} {y} {z}", joint.name, joints[p].name).unwrap();
            }
        }
        // Names of the body's joints hold no digits.
        let fits = |part: &str| joint.name.contains(part);
        let spread = SPREADS.iter().find(|(part, _)| fits(part)).unwrap().1;
        writeln!(text, "spread {} {spread}", joint.name).unwrap();
        let hinge = ["index", "middle", "ring", "pinky"]
            .iter()
            .fold(joint.name.clone(), |name, finger| name.replace(finger, "finger"));
        if let Some((_, limits)) = LIMITS.iter().find(|(part, _)| hinge.contains(part)) {
            writeln!(text, "limit {} {limits}", joint.name).unwrap();
        }
        // Arms hang in the rest pose.
        if let Some(turn) = [("left_shoulder", 90), ("right_shoulder", -90)]
            .iter()
            .find_map(|(name, turn)| (joint.name == *name).then_some(turn))
        {
            writeln!(text, "t-pose {} {turn} 0 0", joint.name).unwrap();
        }
    }
    for (m, Attachment { label, joints: [near, far], share, .. }) in
        like.attachments().iter().enumerate()
    {
        let spread = if m >= like.take().marker_count() - 2 * hands.per_hand() {
            "0.004"
        } else if label.ends_with("HAND") {
            // What is left open of a hand is left open of its fingers.
            "0.01"
        } else {
            spread
        };
        // Written from the upper of the two joints.
        let (near, far, share, local) = if *share > 0.0 && joints[*near].parent == Some(*far) {
            (*far, *near, 1.0 - share, place(m, 1))
        } else {
            (*near, *far, *share, place(m, 0))
        };
        let [x, y, z] = local;
        write!(text, "marker {label} {} {x} {y} {z}", joints[near].name).unwrap();
        if share > 0.0 && share < 1.0 {
            write!(text, " share {} {share}", joints[far].name).unwrap();
        }
        writeln!(text, " spread {spread}").unwrap();
    }
    Body::parse(&text, "synthetic.body").unwrap()
}
