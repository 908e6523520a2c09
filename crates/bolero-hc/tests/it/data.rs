//! The recordings of the paper, read from the folder that `MOCAP_DATA` names.

use std::{fs::File, io::Read, path::PathBuf};

use flate2::read::GzDecoder;
use mocap_core::{BoneRule, BoneSet, Holdout, MarkerKnowledge, MarkerSet, Mask, Take};
use ndarray::Array3;

/// A motion in metres; nothing, and a line that says so, without `MOCAP_DATA`.
pub fn motion(name: &str) -> Option<Take> {
    let Some(folder) = std::env::var_os("MOCAP_DATA") else {
        println!("skipped: MOCAP_DATA does not name a folder with recordings");
        return None;
    };
    let path = PathBuf::from(folder).join("cmu/bolero-nine").join(format!("{name}.csv.gz"));
    let mut text = String::new();
    GzDecoder::new(File::open(path).unwrap()).read_to_string(&mut text).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines
        .next()
        .unwrap()
        .split(',')
        .step_by(3)
        .map(|field| field.trim().strip_suffix("-x").unwrap().rsplit(':').next().unwrap())
        .collect();
    let values: Vec<f64> = lines
        .filter(|line| !line.trim().is_empty())
        .flat_map(|line| line.split(',').map(|field| field.trim().parse::<f64>().unwrap() / 1000.0))
        .collect();
    let frames = values.len() / (3 * names.len());
    let positions = Array3::from_shape_vec((frames, names.len(), 3), values).unwrap();
    let markers = MarkerSet::new(names).unwrap();
    Some(Take::from_positions(markers, 120.0, positions).unwrap())
}

/// Hides markers in frames counted from 1, the last one included.
pub fn hide(take: Take, markers: &[&str], first: usize, last: usize) -> Holdout {
    let indices: Vec<usize> = markers.iter().map(|m| take.markers().find(m).unwrap()).collect();
    let hidden = Mask::from_fn(take.frames(), take.marker_count(), |t, m| {
        (first - 1..last).contains(&t) && indices.contains(&m)
    });
    Holdout::new(take, &hidden).unwrap()
}

/// Mean squared error of the hidden coordinates in m², [Li10] Eq. (13).
pub fn mse(holdout: &Holdout, filled: &Take) -> f64 {
    let cells = holdout.hidden().iter();
    let sum: f64 = cells
        .map(|(t, m)| {
            let (p, q) = (filled.position(t, m).unwrap(), holdout.truth().position(t, m).unwrap());
            (0..3).map(|a| (p[a] - q[a]).powi(2)).sum::<f64>()
        })
        .sum();
    sum / (3 * holdout.hidden().count()) as f64
}

/// The named bones with their lengths over the complete motion, as the paper's authors took them.
pub fn oracle_bones(truth: &Take) -> BoneSet {
    let pairs = MarkerKnowledge::cmu_41().bone_pairs(truth.markers());
    BoneSet::estimate(truth, &BoneRule::Pairs(pairs)).unwrap()
}
