use std::path::Path;

use mocap_core::{Pose, Skeleton, geometry::distance};
use mocap_io::{MotionFile, ReadOptions};
use mocap_report::Entry;
use mocap_synth::{Hands, Person, Synth, SynthParams};

use super::{legend, quantile, range_chart};
use crate::{
    ReproError, Section,
    figure::{Content, Figure, Panel, Panels},
};

/// A bone or a breadth between two joints, as a captured skeleton and as this project's own names them.
struct Bone {
    name: &'static str,
    captured: [&'static str; 2],
    own: [&'static str; 2],
}

const fn bone(name: &'static str, captured: [&'static str; 2], own: [&'static str; 2]) -> Bone {
    Bone { name, captured, own }
}

const BONES: [Bone; 8] = [
    bone("thigh", ["lfemur", "ltibia"], ["left_hip", "left_knee"]),
    bone("shank", ["ltibia", "lfoot"], ["left_knee", "left_ankle"]),
    bone("foot", ["lfoot", "ltoes"], ["left_ankle", "left_toe"]),
    bone("hips", ["lfemur", "rfemur"], ["left_hip", "right_hip"]),
    bone("hip to head", ["lfemur", "head"], ["left_hip", "head"]),
    bone("shoulders", ["lhumerus", "rhumerus"], ["left_shoulder", "right_shoulder"]),
    bone("upper arm", ["lhumerus", "lradius"], ["left_shoulder", "left_elbow"]),
    bone("forearm", ["lradius", "lhand"], ["left_elbow", "left_wrist"]),
];

/// Lengths in centimetres of each bone, sorted: captured and synthetic.
pub(super) struct Lengths([[Vec<f64>; BONES.len()]; 2]);

/// People whose lengths are measured.
const PEOPLE: u64 = 400;
/// Folders of skeletons, below that of all data.
const FOLDERS: [&str; 13] = [
    "cmu/asfamc/01",
    "cmu/asfamc/02",
    "cmu/asfamc/05",
    "cmu/asfamc/07",
    "cmu/asfamc/09",
    "cmu/asfamc/11",
    "cmu/asfamc/14",
    "cmu/asfamc/16",
    "cmu/asfamc/127",
    "cmu/asfamc/131",
    "cmu/paired",
    "hdm05",
    "hdm05/paired",
];

/// Measures the skeletons that are there, and as many people as it takes.
pub(super) fn measure(data: &Path) -> Result<Lengths, ReproError> {
    let mut lengths: [[Vec<f64>; BONES.len()]; 2] = Default::default();
    let mut seen = Vec::new();
    for folder in FOLDERS {
        let Ok(files) = std::fs::read_dir(data.join(folder)) else { continue };
        let mut files: Vec<_> = files.filter_map(|file| Some(file.ok()?.path())).collect();
        files.sort();
        for path in files.iter().filter(|path| path.extension().is_some_and(|e| e == "asf")) {
            // The same person's skeleton may lie in two folders.
            let name = path.file_name().map(ToOwned::to_owned);
            if seen.contains(&name) {
                continue;
            }
            seen.push(name);
            let file = MotionFile::read(path, None, &ReadOptions::default())?;
            add(&mut lengths[0], file.motion().skeleton(), |bone| bone.captured)?;
        }
    }
    for seed in 0..PEOPLE {
        let params = SynthParams {
            person: Some(Person::draw(seed)),
            hands: Hands::None,
            frames: 1,
            ..SynthParams::default()
        };
        let recorded = Synth::new(params)?.take()?;
        add(&mut lengths[1], recorded.motion().skeleton(), |bone| bone.own)?;
    }
    for values in lengths.iter_mut().flatten() {
        values.sort_by(f64::total_cmp);
    }
    Ok(Lengths(lengths))
}

fn add(
    lengths: &mut [Vec<f64>; BONES.len()],
    skeleton: &Skeleton,
    names: impl Fn(&Bone) -> [&'static str; 2],
) -> Result<(), ReproError> {
    let places = skeleton.positions(&Pose::rest(skeleton))?;
    for (bone, values) in BONES.iter().zip(lengths) {
        if let [Some(a), Some(b)] = names(bone).map(|name| skeleton.find(name)) {
            values.push(100.0 * distance(places[a], places[b]));
        }
    }
    Ok(())
}

pub(super) fn table(Lengths([captured, synthetic]): &Lengths) -> Section {
    let columns = [
        "bone",
        "skeletons",
        "captured 5 %",
        "50 %",
        "95 %",
        "people",
        "synthetic 5 %",
        "50 %",
        "95 %",
    ];
    let rows = BONES.iter().enumerate().map(|(n, bone)| {
        let mut row = vec![Entry::text(bone.name)];
        for values in [&captured[n], &synthetic[n]] {
            row.push(Entry::count(values.len()));
            row.extend([0.05, 0.5, 0.95].map(|share| Entry::number(quantile(values, share), 1)));
        }
        row
    });
    let note = "Centimetres. A captured skeleton is its capture software's fit, with joints of its own making.";
    Section::new("synth-bones", "Bones", note, &columns, rows)
}

pub(super) fn figure(Lengths(lengths): &Lengths) -> Figure {
    let ranges = [0, 1].map(|side: usize| {
        let of = |values: &Vec<f64>| {
            [0.05, 0.5, 0.95].map(|share| quantile(values, share).unwrap_or(f64::NAN))
        };
        lengths[side].iter().map(of).collect()
    });
    let names = BONES.iter().map(|bone| bone.name.to_owned()).collect();
    let chart = range_chart("", "centimetres, 5 to 95 %", names, &ranges);
    Figure {
        id: "synth-bones".into(),
        title: "Bones and breadths".into(),
        caption: "From the 5 % to the 95 % quantile, with the median.".into(),
        content: Content::Panels(Panels {
            columns: 1,
            row_height: 300.0,
            cells: vec![Panel::Chart(Box::new(chart))],
            legend: legend(),
        }),
    }
}
