//! Real recordings, in the folder that `MOCAP_DATA` names.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use mocap_io::c3d::{
    C3d, C3dError, Declaration, EditValue, ModelOutput, PointKind, Processor, ReadNote, SampleEdit,
    Storage,
};

use super::c3d_damage::exercise;
use super::c3d_support::{Random, data_folder, read};

use Processor::{Dec, Intel, Sgi};
use StoredAs::{Integer, Real};

#[derive(Debug, Clone, Copy, PartialEq)]
enum StoredAs {
    Integer,
    Real,
}

/// File, processor, storage, frames, points, analog channels, missing samples. `docs/c3d-conformance.md` sets these
/// counts against those of other readers and explains each difference.
#[rustfmt::skip]
const READ: &[(&str, Processor, StoredAs, usize, usize, usize, usize)] = &[
    ("c3d-zoo/btk__PiG__PiG_Calibration-FlatFoot-Full.c3d", Intel, Real, 94, 137, 38, 0),
    ("c3d-zoo/btk__PiG__PiG_Calibration-FlatFoot-One.c3d", Intel, Real, 1, 138, 38, 0),
    ("c3d-zoo/btk__PiG__PiG_Calibration3_FF_N18.c3d", Intel, Real, 95, 66, 0, 4),
    ("c3d-zoo/btk__PiG__PiG_Calibration3_noFF.c3d", Intel, Real, 95, 66, 0, 4),
    ("c3d-zoo/btk__others__ADemo1_rewrite_c3d_pc_integer.c3d", Intel, Integer, 512, 24, 16, 85),
    ("c3d-zoo/btk__others__Analysis.c3d", Dec, Real, 101, 24, 16, 0),
    ("c3d-zoo/btk__others__Gait.c3d", Dec, Integer, 487, 33, 28, 9682),
    ("c3d-zoo/btk__others__MyCube.c3d", Intel, Real, 1, 14, 0, 0),
    ("c3d-zoo/btk__others__Res16bits.c3d", Intel, Real, 100, 44, 81, 5),
    ("c3d-zoo/btk__others__shd01.c3d", Intel, Real, 237, 27, 6, 0),
    ("c3d-zoo/c3dio__data__short-copy.c3d", Intel, Real, 151, 49, 18, 1208),
    ("c3d-zoo/c3dorg__Codamotion__codamotion_gaitwands_19970212.c3d", Intel, Real, 512, 24, 16, 85),
    ("c3d-zoo/c3dorg__Innovative_Sports_Training__Gait_with_EMG.c3d", Intel, Real, 134, 24, 32, 24),
    ("c3d-zoo/c3dorg__sample08__TESTAPI.c3d", Intel, Integer, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_01__Eb015pi.c3d", Intel, Integer, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_01__Eb015pr.c3d", Intel, Real, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_01__Eb015si.c3d", Sgi, Integer, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_01__Eb015sr.c3d", Sgi, Real, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_01__Eb015vi.c3d", Dec, Integer, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_01__Eb015vr.c3d", Dec, Real, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_02__dec_real.c3d", Dec, Real, 89, 36, 16, 228),
    ("c3d-zoo/c3dorg__sample_02__pc_int.c3d", Intel, Integer, 89, 36, 16, 228),
    ("c3d-zoo/c3dorg__sample_02__pc_real.c3d", Intel, Real, 89, 36, 16, 228),
    ("c3d-zoo/c3dorg__sample_02__sgi_int.c3d", Sgi, Integer, 89, 36, 16, 228),
    ("c3d-zoo/c3dorg__sample_02__sgi_real.c3d", Sgi, Real, 89, 36, 16, 228),
    ("c3d-zoo/c3dorg__sample_03__gait-raw.c3d", Dec, Integer, 142, 27, 30, 2089),
    ("c3d-zoo/c3dorg__sample_06__MACsample.c3d", Sgi, Integer, 180, 33, 16, 3565),
    ("c3d-zoo/c3dorg__sample_07__16bitanalog.c3d", Intel, Real, 237, 27, 40, 6399),
    ("c3d-zoo/c3dorg__sample_08__TESTBPI.c3d", Intel, Integer, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_08__TESTCPI.c3d", Intel, Integer, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_08__TESTDPI.c3d", Intel, Integer, 450, 26, 16, 226),
    ("c3d-zoo/c3dorg__sample_09__PlugInC3D.c3d", Dec, Integer, 281, 86, 36, 9187),
    ("c3d-zoo/c3dorg__sample_09__VER4C3D.c3d", Dec, Integer, 281, 18, 36, 1239),
    ("c3d-zoo/c3dorg__sample_10__TYPE-2a.c3d", Dec, Integer, 360, 25, 20, 6270),
    ("c3d-zoo/c3dorg__sample_11__2198928.c3d", Dec, Integer, 189, 94, 40, 1794),
    ("c3d-zoo/c3dorg__sample_13__Dance.c3d", Intel, Real, 499, 40, 8, 0),
    ("c3d-zoo/c3dorg__sample_15__FP1.C3D", Intel, Real, 480, 8, 12, 0),
    ("c3d-zoo/c3dorg__sample_16__giant.c3d", Intel, Real, 355, 29, 0, 10295),
    ("c3d-zoo/c3dorg__sample_20__phasespace_sample.c3d", Intel, Real, 701, 40, 0, 1281),
    ("c3d-zoo/c3dorg__sample_21__sample21.c3d", Dec, Integer, 574, 14, 12, 0),
    ("c3d-zoo/c3dorg__sample_22__BKINtechnologies.c3d", Intel, Real, 5065, 2, 20, 0),
    ("c3d-zoo/c3dorg__sample_24__MotionMonitorC3D.c3d", Intel, Real, 840, 8, 16, 0),
    ("c3d-zoo/c3dorg__sample_25__analogfpscale04i.c3d", Dec, Integer, 397, 17, 28, 398),
    ("c3d-zoo/c3dorg__sample_26__Capture0002.c3d", Intel, Real, 661, 18, 16, 818),
    ("c3d-zoo/c3dorg__sample_26__Capture0003.c3d", Intel, Real, 589, 18, 16, 242),
    ("c3d-zoo/c3dorg__sample_26__Capture0004.c3d", Intel, Real, 453, 18, 16, 60),
    ("c3d-zoo/c3dorg__sample_26__Walking_Hybrid_1_1.c3d", Intel, Real, 672, 25, 16, 3902),
    ("c3d-zoo/c3dorg__sample_26__Walking_Hybrid_1_5.c3d", Intel, Real, 646, 25, 16, 4075),
    ("c3d-zoo/c3dorg__sample_28__dynamic.C3D", Intel, Real, 296, 34, 6, 3572),
    ("c3d-zoo/c3dorg__sample_28__standing.C3D", Intel, Real, 200, 38, 6, 1232),
    ("c3d-zoo/c3dorg__sample_28__type1.C3D", Intel, Real, 296, 28, 6, 1796),
    ("c3d-zoo/c3dorg__sample_30__admarche2.c3d", Intel, Real, 159, 17, 8, 54),
    ("c3d-zoo/c3dorg__sample_30__emgwl.c3d", Intel, Real, 501, 0, 4, 0),
    ("c3d-zoo/c3dorg__sample_30__marche281.c3d", Intel, Real, 961, 29, 0, 0),
    ("c3d-zoo/c3dorg__sample_35__Mega_Electronics_Isokinetic_EMG_Angle_Torque_Sample_File.c3d", Intel, Real, 29, 0, 4, 0),
    ("c3d-zoo/c3dorg__sample_37__ART-Human_hands_real_no6dof.c3d", Intel, Real, 969, 61, 0, 0),
    ("c3d-zoo/c3dorg__sample_37__ART-Human_tools_integer_6dofLimbs.c3d", Intel, Integer, 1162, 37, 0, 0),
    ("c3d-zoo/ktk__others__C3DRotationExample.c3d", Intel, Real, 340, 0, 0, 0),
    ("captures/OlafHaag+joint-localization__fullbody_44Markers_clean_120fps.c3d", Intel, Real, 3972, 44, 0, 22),
    ("captures/cadop+pyCGM__Movement_trial.c3d", Intel, Real, 323, 239, 69, 2735),
    ("captures/keenon+nimblephysics__nick_freeform_001.c3d", Intel, Real, 1101, 53, 0, 3874),
    ("captures/keenon+nimblephysics__squat.c3d", Intel, Real, 2539, 53, 0, 2322),
    ("captures/kineticstoolkit+kineticstoolkit__duplicate_labels.c3d", Intel, Real, 1050, 48, 0, 37199),
    ("captures/kineticstoolkit+kineticstoolkit__kinematics_basket_sprint.c3d", Intel, Real, 3678, 26, 0, 37068),
    ("captures/mcgillmotionlab+biomechzoo__HC002D06.c3d", Intel, Real, 255, 286, 24, 4896),
    ("captures/opensim-org+opensim-core__walking2.c3d", Intel, Real, 1249, 44, 12, 27567),
    ("captures/pyomeca+pyomeca__markers_analogs.c3d", Intel, Real, 580, 51, 38, 305),
    ("captures/tsalemink+C3D-parser__MH_Cal_01.c3d", Intel, Real, 452, 72, 0, 1472),
    ("captures/tsalemink+C3D-parser__QCMAS.dynamic.c3d", Intel, Real, 216, 186, 40, 17262),
    ("cmu/paired/02_01.c3d", Intel, Real, 343, 41, 0, 0),
    ("cmu/paired/05_13.c3d", Dec, Integer, 1095, 330, 0, 0),
    ("cmu/paired/135_02.c3d", Intel, Real, 5202, 41, 0, 0),
    ("hdm05/paired/HDM_dg_06-03_03_120.c3d", Intel, Real, 202, 44, 0, 0),
];

fn open(folder: &Path, name: &str) -> C3d {
    read(fs::read(folder.join(name)).unwrap()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn has_disagreement(file: &C3d, wanted: Declaration) -> bool {
    file.report().notes.iter().any(
        |note| matches!(note, ReadNote::Disagreement { declaration, .. } if *declaration == wanted),
    )
}

#[test]
fn every_real_file_is_read_and_kept() {
    let Some(folder) = data_folder() else { return };
    for &(name, processor, stored_as, frames, points, channels, missing) in READ {
        let file = open(&folder, name);
        let storage = if matches!(file.storage(), Storage::Real { .. }) { Real } else { Integer };
        let data = file.decode_points();
        let found = data.states.iter().filter(|state| state.is_missing()).count();
        assert_eq!(
            (
                file.processor(),
                storage,
                file.frames(),
                file.points().len(),
                file.analog().channels,
                found
            ),
            (processor, stored_as, frames, points, channels, missing),
            "{name}"
        );
        assert_eq!(
            file.decode_analog().values.len(),
            frames * channels * file.analog().samples_per_frame,
            "{name}"
        );
        assert_eq!(file.patch(&[]).unwrap(), fs::read(folder.join(name)).unwrap(), "{name}");
        let names: std::collections::HashSet<_> =
            file.points().iter().map(|point| &point.name).collect();
        assert_eq!(names.len(), points, "{name}");
    }
}

#[test]
fn every_c3d_file_of_the_folder_is_in_the_table() {
    let Some(folder) = data_folder() else { return };
    for part in ["c3d-zoo", "captures", "cmu/paired", "hdm05/paired"] {
        for entry in fs::read_dir(folder.join(part)).unwrap() {
            let name = format!("{part}/{}", entry.unwrap().file_name().to_string_lossy());
            if name.to_ascii_lowercase().ends_with(".c3d") && !name.ends_with("Empty.c3d") {
                assert!(READ.iter().any(|row| row.0 == name), "{name}");
            }
        }
    }
    let empty = fs::read(folder.join("c3d-zoo/btk__others__Empty.c3d")).unwrap();
    assert_eq!(read(empty).unwrap_err(), C3dError::TooShort { len: 0 });
}

#[test]
fn six_byte_orders_of_one_recording_hold_equal_values() {
    let Some(folder) = data_folder() else { return };
    let decode = |kind: &str| {
        open(&folder, &format!("c3d-zoo/c3dorg__sample_01__Eb015{kind}.c3d")).decode_points()
    };
    let first = decode("pi");
    for kind in ["pr", "si", "sr", "vi", "vr"] {
        assert_eq!(decode(kind), first, "{kind}");
    }
}

#[test]
fn reals_of_one_recording_are_equal_and_integers_within_a_step() {
    let Some(folder) = data_folder() else { return };
    let decode = |kind: &str| {
        open(&folder, &format!("c3d-zoo/c3dorg__sample_02__{kind}.c3d")).decode_points()
    };
    let real = decode("pc_real");
    assert_eq!(decode("dec_real"), real);
    assert_eq!(decode("sgi_real"), real);
    for kind in ["pc_int", "sgi_int"] {
        let integer = decode(kind);
        assert_eq!(integer.states, real.states);
        for (a, b) in integer.xyz.iter().flatten().zip(real.xyz.iter().flatten()) {
            // One step of the file's scale, 0.2812 mm.
            assert!((a - b).abs() <= 0.282);
        }
    }
}

#[test]
fn model_outputs_of_real_files_are_not_markers() {
    let Some(folder) = data_folder() else { return };
    let markers = |name: &str| {
        let file = open(&folder, name);
        let kind = |wanted: fn(&PointKind) -> bool| {
            file.points().iter().filter(|point| wanted(&point.kind)).count()
        };
        (kind(|kind| *kind == PointKind::Marker), kind(|kind| *kind == PointKind::Unlabelled))
    };
    assert_eq!(markers("captures/cadop+pyCGM__Movement_trial.c3d"), (39, 42));
    assert_eq!(markers("captures/tsalemink+C3D-parser__QCMAS.dynamic.c3d"), (21, 0));
    assert_eq!(markers("captures/tsalemink+C3D-parser__MH_Cal_01.c3d"), (22, 0));
    assert_eq!(markers("c3d-zoo/c3dorg__sample_09__PlugInC3D.c3d"), (18, 0));
    assert_eq!(markers("hdm05/paired/HDM_dg_06-03_03_120.c3d"), (41, 3));
    assert_eq!(markers("c3d-zoo/btk__others__Analysis.c3d"), (0, 0));
    // 30 points of this file's own foot model have no list and no telling names, and count as markers.
    assert_eq!(markers("captures/mcgillmotionlab+biomechzoo__HC002D06.c3d"), (97, 0));
    let file = open(&folder, "captures/tsalemink+C3D-parser__MH_Cal_01.c3d");
    let knee = file.points().iter().find(|point| point.name == "LKNE").unwrap();
    assert_eq!(knee.kind, PointKind::ModelOutput(ModelOutput::ModelledMarker));
}

#[test]
fn disagreements_of_real_files_are_noted_and_settled() {
    let Some(folder) = data_folder() else { return };
    let zoo = |name: &str| open(&folder, &format!("c3d-zoo/{name}.c3d"));
    assert!(has_disagreement(&zoo("c3dorg__sample_13__Dance"), Declaration::FrameCount));
    assert!(has_disagreement(&zoo("c3dio__data__short-copy"), Declaration::DataStart));
    assert!(has_disagreement(
        &zoo("c3dorg__sample_24__MotionMonitorC3D"),
        Declaration::AnalogPerFrame
    ));
    let mac = zoo("c3dorg__sample_06__MACsample");
    assert!(has_disagreement(&mac, Declaration::Scale));
    // A shoulder is at 1.5 m by the header's scale and at 0.6 m by the parameter's.
    assert!((mac.decode_points().position(50, 0).unwrap()[2] - 1485.0).abs() < 1.0);
    assert_eq!(zoo("c3dorg__sample_09__PlugInC3D").events().len(), 8);
    assert!(
        zoo("c3dorg__sample_20__phasespace_sample")
            .report()
            .notes
            .contains(&ReadNote::NoParameters)
    );
}

#[test]
fn an_idle_channel_of_an_offset_binary_converter_reads_zero() {
    let Some(folder) = data_folder() else { return };
    let file = open(&folder, "c3d-zoo/c3dorg__sample_07__16bitanalog.c3d");
    let channel = file.analog().labels.iter().position(|label| label == "CH39").unwrap();
    let analog = file.decode_analog();
    assert!(analog.values.iter().skip(channel).step_by(analog.channels).all(|&value| value == 0.0));
}

#[test]
fn cut_copies_of_real_files_are_never_silently_shorter() {
    let Some(folder) = data_folder() else { return };
    let mut random = Random(75);
    let mut slowest = Duration::ZERO;
    for index in 0..75 {
        let name = READ[index * READ.len() / 75].0;
        let bytes = fs::read(folder.join(name)).unwrap();
        let end = read(bytes.clone()).unwrap().data_range().end;
        let cut = random.below(end);
        let start = Instant::now();
        assert!(read(bytes[..cut].to_vec()).is_err(), "{name} cut at {cut}");
        exercise(&bytes[..cut]);
        slowest = slowest.max(start.elapsed());
    }
    assert!(slowest < Duration::from_secs(2), "{slowest:?}");
}

#[test]
fn cut_rotation_data_are_noticed() {
    let Some(folder) = data_folder() else { return };
    let bytes = fs::read(folder.join("c3d-zoo/ktk__others__C3DRotationExample.c3d")).unwrap();
    // 340 frames of 21 rotations of 17 floats from block 6 on; the rest of the last block is padding.
    let end = 5 * 512 + 340 * 21 * 17 * 4;
    assert!(read(bytes[..end].to_vec()).is_ok());
    for cut in [2_561, 300_000, end - 1] {
        let error = read(bytes[..cut].to_vec()).unwrap_err();
        assert_eq!(error, C3dError::RotationsTruncated { start: 2_560, end, len: cut });
    }
}

#[test]
fn mutated_copies_of_real_files_give_a_value_or_an_error() {
    let Some(folder) = data_folder() else { return };
    let mut random = Random(300);
    let mut slowest = Duration::ZERO;
    for index in 0..300 {
        let name = READ[index % READ.len()].0;
        let mut bytes = fs::read(folder.join(name)).unwrap();
        for _ in 0..=random.below(20) {
            let bound = if random.below(2) == 0 { bytes.len().min(4096) } else { bytes.len() };
            let at = random.below(bound);
            bytes[at] = random.next().to_le_bytes()[0];
        }
        let start = Instant::now();
        exercise(&bytes);
        slowest = slowest.max(start.elapsed());
    }
    assert!(slowest < Duration::from_secs(2), "{slowest:?}");
}

#[test]
fn a_patched_real_file_differs_in_its_samples_only() {
    let Some(folder) = data_folder() else { return };
    for name in
        ["cmu/paired/05_13.c3d", "cmu/paired/02_01.c3d", "c3d-zoo/c3dorg__sample_01__Eb015si.c3d"]
    {
        let file = open(&folder, name);
        let edits: Vec<_> = (10..20)
            .map(|frame| SampleEdit {
                frame,
                point: 3,
                value: EditValue::Fill([100.0, -200.0, 300.0 + frame as f64]),
            })
            .collect();
        let patched = file.patch(&edits).unwrap();
        for (at, (new, old)) in patched.iter().zip(file.bytes()).enumerate() {
            let inside = edits
                .iter()
                .any(|edit| file.sample_bytes(edit.frame, edit.point).unwrap().contains(&at));
            assert!(new == old || inside, "{name} byte {at}");
        }
        let scale = f64::from(file.storage().scale());
        let position = read(patched).unwrap().decode_points().position(15, 3).unwrap();
        // Half a step of integer storage; floats are closer.
        assert!((position[2] - 315.0).abs() <= scale * 0.51);
    }
}
