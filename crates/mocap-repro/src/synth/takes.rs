use std::path::Path;

use mocap_core::{Take, geometry::norm};
use mocap_io::{MarkerFile, MotionFile, ReadOptions};
use mocap_synth::{Activity, Person, Synth, SynthParams, SyntheticTake, record_all};
use ndarray::ArrayView3;

use super::angles::Angles;
use crate::ReproError;

/// One activity: what was captured of it, and what is synthesised.
#[derive(Debug)]
pub(super) struct Group {
    pub activity: &'static str,
    /// Names of the captured takes.
    pub captured_motions: String,
    pub captured_markers: String,
    /// Captured, synthetic.
    pub joints: [Rates; 2],
    pub markers: [Rates; 2],
    pub angles: [Angles; 2],
}

/// Speeds and accelerations.
#[derive(Debug, Default)]
pub(super) struct Rates {
    pub takes: usize,
    /// Speeds in m/s, accelerations in m/s² as short and as long spans show them.
    pub values: [Vec<f64>; 3],
}

/// An activity and the recordings that show the like.
struct Captured {
    activity: Activity,
    /// Joint motion, without the ending.
    motions: &'static [&'static str],
    /// Marker files.
    markers: &'static [&'static str],
}

/// By the databases' own descriptions, CMU's and HDM05's. Of reaching there is drinking, scooping, grabbing and putting
/// down, of kicking one ball and kicks into the air; throwing and jumping far have markers alone. Nobody turns on the spot.
const CAPTURED: [Captured; 8] = [
    Captured {
        activity: Activity::Walk,
        motions: &[
            "cmu/paired/02_01",
            "cmu/asfamc/02/02_02",
            "cmu/asfamc/05/05_01",
            "cmu/asfamc/07/07_01",
            "cmu/asfamc/07/07_02",
            "cmu/asfamc/07/07_06",
            "cmu/asfamc/07/07_07",
            "cmu/asfamc/07/07_08",
            "cmu/asfamc/07/07_09",
            "cmu/asfamc/07/07_10",
            "cmu/asfamc/07/07_11",
            "cmu/asfamc/16/16_22",
            "cmu/asfamc/16/16_23",
            "cmu/asfamc/16/16_24",
            "cmu/asfamc/16/16_25",
            "cmu/asfamc/16/16_26",
            "cmu/asfamc/16/16_27",
            "cmu/asfamc/16/16_29",
        ],
        markers: &["cmu/paired/02_01.c3d"],
    },
    Captured {
        activity: Activity::Run,
        motions: &[
            "cmu/asfamc/02/02_03",
            "cmu/asfamc/09/09_01",
            "cmu/asfamc/09/09_02",
            "cmu/asfamc/09/09_03",
            "cmu/asfamc/09/09_04",
            "cmu/asfamc/09/09_05",
            "cmu/asfamc/09/09_06",
            "cmu/asfamc/09/09_07",
            "cmu/asfamc/09/09_08",
            "cmu/asfamc/09/09_09",
            "cmu/asfamc/09/09_10",
            "cmu/asfamc/09/09_11",
            "cmu/asfamc/16/16_35",
            "cmu/asfamc/16/16_36",
            "cmu/asfamc/16/16_37",
            "cmu/asfamc/16/16_39",
            "cmu/asfamc/16/16_45",
            "cmu/asfamc/16/16_46",
            "cmu/asfamc/127/127_03",
            "cmu/asfamc/127/127_06",
            "cmu/paired/127_07",
            "cmu/asfamc/127/127_08",
        ],
        markers: &["cmu/bolero-nine/127_07.csv.gz"],
    },
    Captured {
        activity: Activity::Jump,
        motions: &[
            "cmu/asfamc/16/16_01",
            "cmu/asfamc/16/16_04",
            "cmu/asfamc/16/16_05",
            "cmu/asfamc/02/02_04",
            "hdm05/asfamc/HDM_bd_hopBothLegs1hops_001_120",
            "hdm05/asfamc/HDM_bk_hopBothLegs1hops_013_120",
            "hdm05/asfamc/HDM_dg_hopBothLegs1hops_022_120",
            "hdm05/asfamc/HDM_mm_hopBothLegs1hops_031_120",
            "hdm05/asfamc/HDM_tr_hopBothLegs1hops_034_120",
        ],
        markers: &[],
    },
    Captured {
        activity: Activity::Leap,
        motions: &[],
        markers: &["cmu/bolero-nine/141_04.csv.gz"],
    },
    Captured {
        activity: Activity::Throw,
        motions: &[],
        markers: &["cmu/bolero-nine/143_22.csv.gz"],
    },
    Captured {
        activity: Activity::Corner,
        motions: &[
            "cmu/asfamc/16/16_27",
            "cmu/asfamc/16/16_28",
            "cmu/asfamc/16/16_29",
            "cmu/asfamc/16/16_30",
        ],
        markers: &[],
    },
    Captured {
        activity: Activity::Reach,
        motions: &[
            "cmu/asfamc/14/14_04",
            "cmu/asfamc/14/14_05",
            "cmu/asfamc/14/14_37",
            "cmu/asfamc/02/02_06",
            "hdm05/asfamc/HDM_bd_depositFloorR_001_120",
            "hdm05/asfamc/HDM_dg_depositFloorR_013_120",
            "hdm05/asfamc/HDM_mm_depositFloorR_019_120",
            "hdm05/asfamc/HDM_bd_grabHighR_001_120",
            "hdm05/asfamc/HDM_bk_grabHighR_005_120",
            "hdm05/asfamc/HDM_dg_grabHighR_011_120",
            "hdm05/asfamc/HDM_mm_grabHighR_017_120",
            "hdm05/asfamc/HDM_tr_grabHighR_023_120",
        ],
        markers: &[],
    },
    Captured {
        activity: Activity::Kick,
        motions: &[
            "cmu/asfamc/11/11_01",
            "hdm05/asfamc/HDM_bd_kickLFront1Reps_001_120",
            "hdm05/asfamc/HDM_bk_kickLFront1Reps_007_120",
            "hdm05/asfamc/HDM_mm_kickLFront1Reps_019_120",
            "hdm05/asfamc/HDM_tr_kickLFront1Reps_025_120",
        ],
        markers: &[],
    },
];

/// Rate of the recordings, which their tables do not state.
const RATE_HZ: f64 = 120.0;
/// Frames on either side of a central difference: of speeds, and of accelerations twice. Over the short span the jitter of
/// a captured joint, which is a fit frame by frame, weighs as much as the movement of someone who stands.
const NARROW: usize = 1;
const SPANS: [usize; 2] = [4, 10];

/// Reads what is there, and synthesises as much of each activity.
pub(super) fn read(data: &Path, progress: &mut dyn FnMut(&str)) -> Result<Vec<Group>, ReproError> {
    let paths = |captured: &Captured| {
        let motions = captured.motions.iter().map(|name| format!("{name}.amc"));
        let all = motions.chain(captured.markers.iter().map(|name| (*name).to_owned()));
        all.map(|name| data.join(name)).filter(|path| path.is_file()).collect::<Vec<_>>()
    };
    if CAPTURED.iter().all(|captured| paths(captured).is_empty()) {
        return Err(ReproError::NoTakes { folder: data.to_owned() });
    }
    let mut groups = Vec::new();
    for captured in &CAPTURED {
        progress(super::name(captured.activity));
        let mut group = synthetic(captured.activity)?;
        for path in paths(captured) {
            if path.extension().is_some_and(|e| e == "amc") {
                group.add_motion(&path)?;
            } else {
                group.add_markers(&path)?;
            }
        }
        group.sort();
        groups.push(group);
    }
    Ok(groups)
}

/// Eight people for twelve seconds each.
fn synthetic(activity: Activity) -> Result<Group, ReproError> {
    let params: Vec<SynthParams> = (100..108)
        .map(|seed| SynthParams {
            motion: activity,
            frames: 1440,
            seed,
            person: Some(Person::draw(seed)),
            ..SynthParams::default()
        })
        .collect();
    let mut group = Group {
        activity: super::name(activity),
        captured_motions: String::new(),
        captured_markers: String::new(),
        joints: Default::default(),
        markers: Default::default(),
        angles: Default::default(),
    };
    for recorded in record_all(&params)? {
        group.joints[1].add_joints(&recorded);
        group.markers[1].add_take(recorded.take());
        group.angles[1].add(recorded.motion())?;
    }
    Ok(group)
}

impl Group {
    /// A recorded motion on the template.
    fn add_motion(&mut self, path: &Path) -> Result<(), ReproError> {
        let file = MotionFile::read(path, None, &ReadOptions::default())?;
        let frames = file.motion().poses().len();
        let params =
            SynthParams { frames, soft_tissue: 0.0, noise_m: 0.0, ..SynthParams::default() };
        let recorded = Synth::retarget(params, file.motion())?.take()?;
        self.joints[0].add_joints(&recorded);
        self.angles[0].add(recorded.motion())?;
        list(&mut self.captured_motions, path);
        Ok(())
    }

    fn add_markers(&mut self, path: &Path) -> Result<(), ReproError> {
        let options = ReadOptions { rate_hz: Some(RATE_HZ), ..ReadOptions::default() };
        let file = MarkerFile::read(path, &options)?;
        let take = file.take();
        let labelled: Vec<usize> = (0..take.marker_count())
            .filter(|&m| !take.markers().split(m).1.starts_with('*'))
            .collect();
        self.markers[0].add_take(&take.select(&labelled)?);
        list(&mut self.captured_markers, path);
        Ok(())
    }

    fn sort(&mut self) {
        for rates in self.joints.iter_mut().chain(&mut self.markers) {
            rates.values.iter_mut().for_each(|values| values.sort_by(f64::total_cmp));
        }
        self.angles.iter_mut().for_each(Angles::sort);
    }
}

/// Appends the name of a recording.
fn list(names: &mut String, path: &Path) {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.split('.').next().unwrap_or_default();
    if !names.is_empty() {
        names.push_str(", ");
    }
    names.push_str(name);
}

impl Rates {
    /// The joints of the limbs and the head.
    fn add_joints(&mut self, recorded: &SyntheticTake) {
        const JOINTS: [&str; 13] = [
            "pelvis",
            "head",
            "left_shoulder",
            "left_elbow",
            "left_wrist",
            "right_shoulder",
            "right_elbow",
            "right_wrist",
            "left_knee",
            "left_ankle",
            "right_knee",
            "right_ankle",
            "upper_spine",
        ];
        let skeleton = recorded.motion().skeleton();
        let rate_hz = recorded.motion().rate_hz();
        for joint in JOINTS.iter().filter_map(|name| skeleton.find(name)) {
            self.add(rate_hz, recorded.joints().dim().0, |t| Some(of(recorded.joints(), t, joint)));
        }
        self.takes += 1;
    }

    fn add_take(&mut self, take: &Take) {
        for m in 0..take.marker_count() {
            self.add(take.rate_hz(), take.frames(), |t| take.position(t, m));
        }
        self.takes += 1;
    }

    fn add(&mut self, rate_hz: f64, frames: usize, at: impl Fn(usize) -> Option<[f64; 3]>) {
        for t in NARROW..frames.saturating_sub(NARROW) {
            let [Some(p), Some(r)] = [t - NARROW, t + NARROW].map(&at) else { continue };
            let speed = [0, 1, 2].map(|k| 0.5 * (r[k] - p[k]) * rate_hz / NARROW as f64);
            self.values[0].push(norm(speed));
        }
        for (n, span) in SPANS.into_iter().enumerate() {
            let step_s = span as f64 / rate_hz;
            for t in span..frames.saturating_sub(span) {
                let [Some(a), Some(b), Some(c)] = [t - span, t, t + span].map(&at) else {
                    continue;
                };
                let bend = [0, 1, 2].map(|k| (c[k] - 2.0 * b[k] + a[k]) / (step_s * step_s));
                self.values[1 + n].push(norm(bend));
            }
        }
    }
}

fn of(joints: ArrayView3<'_, f64>, t: usize, joint: usize) -> [f64; 3] {
    [0, 1, 2].map(|a| joints[(t, joint, a)])
}
