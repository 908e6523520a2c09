use std::{fs::File, io::Read, path::PathBuf};

use flate2::read::GzDecoder;
use mocap_core::{BoneRule, BoneSet, Holdout, MarkerKnowledge, MarkerSet, Mask, Take};
use ndarray::Array3;

/// A file or folder of real recordings below the folder that `MOCAP_DATA` names; `None`, and a line that
/// says so, where it is not.
#[must_use]
pub fn recording(path: &str) -> Option<PathBuf> {
    let below = std::env::var_os("MOCAP_DATA").map(|folder| PathBuf::from(folder).join(path));
    let found = below.filter(|path| path.exists());
    if found.is_none() {
        skip(path);
    }
    found
}

#[expect(clippy::print_stdout, reason = "a skipped test says so")]
fn skip(path: &str) {
    println!("skipped: no {path} in a folder that MOCAP_DATA names");
}

/// A motion of the evaluation of [Li10] in metres, from its CSV columns; `None` where it is not there.
///
/// # Panics
/// If the file is not the table it should be.
#[must_use]
pub fn motion(name: &str) -> Option<Take> {
    let path = recording(&format!("cmu/bolero-nine/{name}.csv.gz"))?;
    let mut text = String::new();
    let file = File::open(path).expect("the file is there");
    GzDecoder::new(file).read_to_string(&mut text).expect("the file is packed text");
    let mut lines = text.lines();
    let header = lines.next().expect("the first line names the columns").split(',').step_by(3);
    let bare =
        |field: &str| field.trim().trim_end_matches("-x").rsplit(':').next().map(str::to_owned);
    let names: Vec<String> = header.filter_map(bare).collect();
    let metres = |field: &str| field.trim().parse::<f64>().expect("a number") / 1000.0;
    let values: Vec<f64> = lines
        .filter(|line| !line.trim().is_empty())
        .flat_map(|line| line.split(',').map(metres))
        .collect();
    let shape = (values.len() / (3 * names.len()), names.len(), 3);
    let positions = Array3::from_shape_vec(shape, values).expect("every row has every column");
    let markers = MarkerSet::new(names).expect("the names are unique");
    Some(Take::from_positions(markers, 120.0, positions).expect("the table is complete"))
}

/// Hides markers in frames counted from 1, the last one included.
///
/// # Panics
/// If the take lacks one of the markers.
#[must_use]
pub fn hide(take: Take, markers: &[&str], first: usize, last: usize) -> Holdout {
    let find = |name: &&str| take.markers().find(name).expect("the take has the marker");
    let indices: Vec<usize> = markers.iter().map(find).collect();
    let hidden = Mask::from_fn(take.frames(), take.marker_count(), |t, m| {
        (first - 1..last).contains(&t) && indices.contains(&m)
    });
    Holdout::new(take, &hidden).expect("the mask has the take's shape")
}

/// The 90 trials of the list `trials90.csv`: one marker, one run of frames; `None` where it is not there.
///
/// # Panics
/// If the list is not the table it should be.
#[must_use]
pub fn ninety_trials() -> Option<Vec<Holdout>> {
    let list = recording("cmu/bolero-nine/trials90.csv")?;
    let list = std::fs::read_to_string(list).expect("the list is text");
    let trial = |line: &str| {
        let row: Vec<&str> = line.split(',').collect();
        let frame = |column: usize| row[column].parse::<usize>().expect("a frame number");
        Some(hide(motion(row[1])?, &[row[2]], frame(3), frame(4)))
    };
    list.lines().skip(1).map(trial).collect()
}

/// Mean squared error of the hidden coordinates in m². Implements [Li10] Eq. (13).
///
/// # Panics
/// If a hidden sample was left open.
#[must_use]
pub fn mse(holdout: &Holdout, filled: &Take) -> f64 {
    let squared = |(t, m): (usize, usize)| {
        let p = filled.position(t, m).expect("the hidden sample is filled");
        let q = holdout.truth().position(t, m).expect("the truth is known");
        (0..3).map(|a| (p[a] - q[a]).powi(2)).sum::<f64>()
    };
    holdout.hidden().iter().map(squared).sum::<f64>() / (3 * holdout.hidden().count()) as f64
}

/// The named bones with their lengths over the complete motion, as the authors of [Li10] took them.
///
/// # Panics
/// Never: the pairs come from the take's own markers.
#[must_use]
pub fn oracle_bones(truth: &Take) -> BoneSet {
    let pairs = MarkerKnowledge::cmu_41().bone_pairs(truth.markers());
    BoneSet::estimate(truth, &BoneRule::Pairs(pairs)).expect("the pairs are the take's own")
}
