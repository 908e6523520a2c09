//! Real recordings, found through `MOCAP_DATA`.

use std::{
    fs,
    io::Read as _,
    path::{Path, PathBuf},
};

use mocap_core::geometry::{distance, sub};
use mocap_io::{
    Edit, Format, LengthUnit, MissingMarks, ReadOptions, Sample,
    text::{
        EncodeOptions, Parsed, TextError,
        amc::{self, Amc},
        asf::{self, Asf},
        bvh::{self, Bvh},
        table::{encode_csv, encode_tsv, read_csv, read_tsv},
        trc,
    },
};

use crate::text_support::difference;

pub fn data(folder: &str) -> Option<PathBuf> {
    mocap_testkit::recording(folder)
}

pub fn bytes(path: &Path) -> Vec<u8> {
    let packed = fs::read(path).unwrap();
    if path.extension().is_none_or(|e| e != "gz") {
        return packed;
    }
    let mut out = Vec::new();
    flate2::read::MultiGzDecoder::new(packed.as_slice()).read_to_end(&mut out).unwrap();
    out
}

/// Files below a folder that end with `ending`, in order.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.to_str().unwrap().ends_with(ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn noted(parsed: &Parsed, words: &str) -> bool {
    parsed.info.notes.iter().any(|note| note.contains(words))
}

/// No edits, no change; hidden and written back, nothing but the hidden fields is different.
fn check_patching(parsed: &Parsed, read: impl Fn(Vec<u8>) -> Parsed) {
    let bytes = parsed.document.bytes();
    assert_eq!(parsed.document.patch(&[]).unwrap(), bytes);
    let take = &parsed.take;
    let seen: Vec<(usize, usize)> = take.observed().iter().step_by(97).collect();
    let edits = |sample: &dyn Fn(usize, usize) -> Sample| -> Vec<Edit> {
        seen.iter()
            .map(|&(frame, marker)| Edit { frame, marker, sample: sample(frame, marker) })
            .collect()
    };
    let hidden = read(parsed.document.patch(&edits(&|_, _| Sample::Missing)).unwrap());
    assert_eq!(hidden.take.observed().count(), take.observed().count() - seen.len());
    let truth = |t, m| Sample::Filled(take.position(t, m).unwrap());
    let filled = read(hidden.document.patch(&edits(&truth)).unwrap());
    // Half of the sixth decimal of a millimetre, and a rounding of some metres.
    assert!(difference(take, &filled.take) < 5.1e-10);
    let untouched = take.observed().iter().filter(|cell| !seen.contains(cell));
    for (t, m) in untouched.step_by(31) {
        assert_eq!(filled.take.position(t, m), take.position(t, m));
    }
}

#[test]
fn the_nine_motions_of_bolero() {
    let Some(folder) = data("cmu/bolero-nine") else { return };
    let found = files(&folder, ".csv.gz");
    assert_eq!(found.len(), 9);
    for path in found {
        let read = |b| read_csv(b, &ReadOptions::default()).unwrap();
        let bytes = bytes(&path);
        let rows = bytes.split(|&b| b == b'\n').count() - 2;
        let parsed = read(bytes);
        assert_eq!((parsed.take.marker_count(), parsed.take.frames()), (41, rows), "{path:?}");
        assert_eq!(parsed.take.rate_hz(), 120.0);
        assert_eq!(parsed.info.missing, MissingMarks::default());
        assert!(!parsed.info.rate_declared && !parsed.info.unit_declared);
        check_patching(&parsed, read);
        let written = read(encode_csv(&parsed.take, &EncodeOptions::default()));
        assert!(difference(&parsed.take, &written.take) < 5.1e-10, "half of the sixth decimal");
        assert!(written.info.rate_declared);
    }
    let trials = bytes(&folder.join("trials90.csv"));
    let error = read_csv(trials, &ReadOptions::default()).unwrap_err();
    assert_eq!(error, TextError::NoMarkers { line: 1 });
}

#[test]
fn the_trc_files_of_opensim() {
    let Some(folder) = data("trc") else { return };
    let expected = [
        ("dataWithBlanksForMissingMarkers", 464, 40, 250.0),
        ("dataWithEformat", 5, 14, 119.880_12),
        ("dataWithNaNsOfDifferentCases", 5, 14, 250.0),
        ("dataWithNaNsWithSpaces", 427, 42, 100.0),
        ("exampleFormat", 5, 3, 100.0),
        ("std_walking2_markers", 126, 44, 250.0),
        ("std_walking5_markers", 112, 40, 250.0),
    ];
    let read = |b| trc::read(b, &ReadOptions::default()).unwrap();
    let found = files(&folder, ".trc");
    assert_eq!(found.len(), expected.len());
    for (path, (name, frames, markers, rate)) in found.into_iter().zip(expected) {
        assert!(path.to_str().unwrap().contains(name));
        let parsed = read(bytes(&path));
        assert_eq!((parsed.take.frames(), parsed.take.marker_count()), (frames, markers), "{name}");
        assert_eq!(parsed.take.rate_hz(), rate, "{name}");
        let marks = parsed.info.missing;
        let missing = frames * markers - parsed.take.observed().count();
        assert_eq!(marks.blank + marks.not_a_number + marks.exact_zero, missing);
        println!("{name}: {marks:?} {:?}", parsed.info.notes);
        check_patching(&parsed, read);
        let written = read(trc::encode(&parsed.take, &EncodeOptions::default()));
        assert!(difference(&parsed.take, &written.take) < 1.1e-9, "half of the sixth decimal");
    }
    let walking = read(bytes(&folder.join("opensim__std_walking5_markers.trc")));
    assert!(noted(&walking, "the time column runs at 25.18 Hz"), "its header says 250 Hz");
    assert_eq!(walking.take.markers().name(0), "LTH3");
}

#[test]
fn the_qualisys_hand() {
    let Some(folder) = data("hands") else { return };
    let read = |b| read_tsv(b, &ReadOptions::default()).unwrap();
    let path = folder.join("dfki_hand_embodiment_recording.tsv");
    let parsed = read(bytes(&path));
    assert_eq!((parsed.take.frames(), parsed.take.marker_count()), (6000, 21));
    assert_eq!(parsed.take.rate_hz(), 100.0);
    let tip = parsed.take.markers().find("thumb_tip").unwrap();
    let lost = parsed.take.observed().marker(tip).iter().filter(|seen| !**seen).count();
    println!("thumb tip: {lost} of 6000 missing, {:?}", parsed.info);
    assert_eq!((lost as f64 / 60.0).round(), 8.0, "8.2 % by the data's own description");
    assert!(noted(&parsed, "middle_tip (Mixed)"));
    check_patching(&parsed, read);
    let written = read(encode_tsv(&parsed.take, &EncodeOptions::default()));
    assert!(difference(&parsed.take, &written.take) < 5.1e-10, "half of the sixth decimal");
}

fn skeleton(path: &Path) -> Asf {
    let asf = Asf::parse(bytes(path), &ReadOptions::default()).unwrap();
    assert_eq!(asf.bytes(), bytes(path));
    asf
}

#[test]
fn every_amc_reads_with_its_skeleton() {
    let (Some(_), Some(folder)) = (data("hdm05/asfamc"), data("")) else { return };
    let mut count = 0;
    for path in files(&folder, ".amc").iter().filter(|p| !p.to_str().unwrap().contains("malformed"))
    {
        let stem = path.file_stem().unwrap().to_str().unwrap();
        let subject =
            if stem.starts_with("HDM") { &stem[..6] } else { stem.split_once('_').unwrap().0 };
        let asf = skeleton(&path.with_file_name(format!("{subject}.asf")));
        let amc = Amc::parse(bytes(path), &asf, &ReadOptions::default()).unwrap();
        assert_eq!(amc.bytes(), bytes(path));
        let lines = amc.bytes().split(|&b| b == b'\n').filter(|l| {
            let line = l.trim_ascii();
            !line.is_empty() && line.iter().all(u8::is_ascii_digit)
        });
        assert_eq!(amc.motion().poses().len(), lines.count(), "{path:?}");
        assert!(amc.motion().poses().len() > 1);
        // 5 cm from the floor to the head top of a squatting actor is the least, 2.2 m the most.
        let at = asf.skeleton().positions(&amc.motion().poses()[0]).unwrap();
        let heights = at.iter().map(|p| p[1]);
        let tall = heights.clone().fold(f64::MIN, f64::max) - heights.fold(f64::MAX, f64::min);
        assert!((0.05..2.2).contains(&tall), "{path:?}: {tall} m");
        count += 1;
    }
    println!("{count} AMC files");
    assert!(count > 100);
}

#[test]
fn the_cut_amc_is_refused_and_can_be_salvaged() {
    let (Some(_), Some(folder)) = (data("malformed"), data("")) else { return };
    let asf = skeleton(&folder.join("cmu/asfamc/07/07.asf"));
    let cut = bytes(&folder.join("malformed/07_12_truncated_lastframe.amc"));
    let error = Amc::parse(cut.clone(), &asf, &ReadOptions::default()).unwrap_err();
    println!("{error}");
    let TextError::MissingBone { frame, line, bone } = error else { panic!("{error}") };
    assert_eq!(bone, "ltoes");
    assert_eq!(line, cut.split(|&b| b == b'\n').filter(|l| !l.is_empty()).count());
    let salvage = ReadOptions { salvage: true, ..ReadOptions::default() };
    let amc = Amc::parse(cut, &asf, &salvage).unwrap();
    assert_eq!(i64::try_from(amc.motion().poses().len()).unwrap(), frame - 1);
    assert!(amc.info().notes[0].contains("salvaged"));
}

/// How many of [`SAME`] lie below the neck.
const BELOW_NECK: usize = 13;

/// Joints of the BVH that was made from `02.asf`, and their bones, lower body and spine first.
const SAME: [(&str, &str); 24] = [
    ("LHipJoint", "lhipjoint"),
    ("LeftUpLeg", "lfemur"),
    ("LeftLeg", "ltibia"),
    ("LeftFoot", "lfoot"),
    ("LeftToeBase", "ltoes"),
    ("RHipJoint", "rhipjoint"),
    ("RightUpLeg", "rfemur"),
    ("RightLeg", "rtibia"),
    ("RightFoot", "rfoot"),
    ("RightToeBase", "rtoes"),
    ("LowerBack", "lowerback"),
    ("Spine", "upperback"),
    ("Spine1", "thorax"),
    ("Neck", "lowerneck"),
    ("Neck1", "upperneck"),
    ("Head", "head"),
    ("LeftShoulder", "lclavicle"),
    ("LeftArm", "lhumerus"),
    ("LeftForeArm", "lradius"),
    ("LeftHand", "lwrist"),
    ("RightShoulder", "rclavicle"),
    ("RightArm", "rhumerus"),
    ("RightForeArm", "rradius"),
    ("RightHand", "rwrist"),
];

#[test]
fn acclaim_and_bvh_of_one_trial_agree() {
    let Some(folder) = data("cmu/paired") else { return };
    let asf = skeleton(&folder.join("02.asf"));
    let amc = Amc::parse(bytes(&folder.join("02_01.amc")), &asf, &ReadOptions::default()).unwrap();
    let bvh = Bvh::parse(bytes(&folder.join("02_01.bvh")), &ReadOptions::default()).unwrap();
    assert_eq!(bvh.bytes(), bytes(&folder.join("02_01.bvh")));
    assert_eq!(bvh.info().format, Format::Bvh);
    assert_eq!(bvh.motion().unwrap().rate_hz(), 120.0);
    let other = bvh.motion_in(asf.metres_per_unit()).unwrap();
    // The BVH starts with one frame in the rest pose.
    assert_eq!(other.poses().len(), amc.motion().poses().len() + 1);
    let (mut worst, mut sum, mut count) = ((0.0, ""), 0.0, 0);
    for (a, b) in amc.motion().poses().iter().zip(&other.poses()[1..]) {
        let (here, there) =
            (asf.skeleton().positions(a).unwrap(), other.skeleton().positions(b).unwrap());
        let place = |bone: &str| here[asf.skeleton().find(bone).unwrap()];
        // This BVH leaves the length of the thorax out: its neck and shoulders start at `Spine1`.
        let thorax = sub(place("lowerneck"), place("thorax"));
        for (index, (joint, bone)) in SAME.into_iter().enumerate() {
            let at = if index < BELOW_NECK { place(bone) } else { sub(place(bone), thorax) };
            let off = distance(at, there[other.skeleton().find(joint).unwrap()]);
            (sum, count) = (sum + off, count + 1);
            if off > worst.0 {
                worst = (off, joint);
            }
        }
    }
    println!(
        "mean {:.6} mm, worst {:.6} mm at {}",
        1e3 * sum / f64::from(count),
        1e3 * worst.0,
        worst.1
    );
    // The BVH has four decimals of a degree and five of a length: 1e-4° over 1.5 m are 0.003 mm a joint.
    assert!(worst.0 < 5e-5, "{worst:?}");
}

#[test]
fn acclaim_to_bvh_and_back_keeps_every_joint() {
    let Some(folder) = data("cmu/paired") else { return };
    let options = ReadOptions::default();
    for (skeleton_name, trial) in [("02", "02_01"), ("05", "05_13"), ("135", "135_07")] {
        let asf = skeleton(&folder.join(format!("{skeleton_name}.asf")));
        let amc = bytes(&folder.join(format!("{trial}.amc")));
        let amc = Amc::parse(amc, &asf, &options).unwrap();
        let bvh = bvh::encode(amc.motion(), LengthUnit::Centimetre);
        let bvh = Bvh::parse(bvh, &options).unwrap().motion().unwrap();
        let new = Asf::parse(asf::encode(bvh.skeleton()), &options).unwrap();
        let back = Amc::parse(amc::encode(&bvh), &new, &options).unwrap();
        assert_eq!(back.motion().poses().len(), amc.motion().poses().len());
        let mut worst = 0.0_f64;
        for ((a, b), c) in amc.motion().poses().iter().zip(bvh.poses()).zip(back.motion().poses()) {
            let first = asf.skeleton().positions(a).unwrap();
            let between = bvh.skeleton().positions(b).unwrap();
            let last = new.skeleton().positions(c).unwrap();
            for (index, joint) in asf.skeleton().joints().iter().enumerate() {
                let other = new.skeleton().find(&joint.name).unwrap();
                let middle = bvh.skeleton().find(&joint.name).unwrap();
                worst = worst.max(distance(first[index], last[other]));
                worst = worst.max(distance(first[index], between[middle]));
            }
        }
        println!("{trial}: {:.6} mm", 1e3 * worst);
        assert!(worst < 1e-5, "{trial}: {worst} m");
    }
}
