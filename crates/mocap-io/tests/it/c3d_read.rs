//! What the reader makes of files whose content is known.

use mocap_io::c3d::{
    C3dError, C3dOptions, Declaration, ModelOutput, NewC3d, NewGroup, NewParameter, NewStorage,
    NewValues, PointKind, Processor, ReadNote, SampleState, Storage, residual,
};

use SampleState::{ExactZero, NegativeResidual, NotFinite, Present};

use super::c3d_support::{PROCESSORS, STORAGES, read, recording};

#[test]
fn every_processor_and_storage_round_trips() {
    for processor in PROCESSORS {
        for storage in STORAGES {
            let new = recording(processor, storage, 5, 40);
            let file = read(new.encode().unwrap()).unwrap();
            assert_eq!(file.processor(), processor);
            assert_eq!((file.frames(), file.points().len(), file.first_frame()), (40, 5, 7));
            assert_eq!((file.point_rate_hz(), file.units().as_deref()), (Some(100.0), Some("mm")));
            assert_eq!(file.report().notes, []);
            let data = file.decode_points();
            // Integers are rounded to the nearest of steps of 0.05; floats carry 24 bits of up to 1500.
            let tolerance = if storage == NewStorage::Real { 1e-4 } else { 0.0251 };
            for (index, (&state, &xyz)) in data.states.iter().zip(&data.xyz).enumerate() {
                assert_eq!(state.is_missing(), new.missing[index]);
                if !new.missing[index] {
                    assert!((0..3).all(
                        |axis| (f64::from(xyz[axis]) - new.xyz[index][axis]).abs() < tolerance
                    ));
                    assert_eq!(data.words[index], new.words[index]);
                }
            }
            let analog = file.decode_analog();
            assert_eq!(
                (analog.samples, analog.channels, file.analog().samples_per_frame),
                (80, 2, 2)
            );
            assert_eq!(analog.values, new.analog.as_ref().unwrap().values);
            assert_eq!((&*file.analog().labels[1], &*file.analog().units[0]), ("EMG1", "N"));
        }
    }
}

#[test]
fn a_file_written_by_hand_from_the_standard_is_read() {
    let mut bytes = vec![0_u8; 3 * 512];
    bytes[..2].copy_from_slice(&[2, 0x50]);
    for (word, value) in [(2, 1_u16), (4, 5), (5, 6), (6, 10), (9, 3), (150, 12345), (151, 1)] {
        bytes[(word - 1) * 2..word * 2].copy_from_slice(&value.to_le_bytes());
    }
    bytes[12..16].copy_from_slice(&0.5_f32.to_le_bytes());
    bytes[20..24].copy_from_slice(&50.0_f32.to_le_bytes());
    bytes[304..308].copy_from_slice(&1.25_f32.to_le_bytes());
    bytes[396..400].copy_from_slice(b"RHS ");
    let mut section = vec![1, 80, 1, 84];
    section.extend(b"\x05\xffPOINT\x08\x00\x05about");
    section.extend(b"\xfa\x01LABELS\x0b\x00\xff\x02\x04\x01LKNE\x00");
    section.extend(b"\x05\x01UNITS\x00\x00\xff\x01\x02mm\x00");
    bytes[512..512 + section.len()].copy_from_slice(&section);
    for (index, value) in [10_i16, -20, 30, 0x0305, 0, 0, 0, -1].into_iter().enumerate() {
        bytes[1024 + index * 2..1026 + index * 2].copy_from_slice(&value.to_le_bytes());
    }
    let file = read(bytes).unwrap();
    assert_eq!(
        (file.processor(), file.storage()),
        (Processor::Intel, Storage::Integer { scale: 0.5 })
    );
    assert_eq!(
        (file.header().max_interpolation_gap, file.first_frame(), file.frames()),
        (10, 5, 2)
    );
    let group = &file.parameters().groups()[0];
    assert_eq!((&*group.name, &*group.description, group.locked), ("POINT", "about", false));
    let labels = file.parameters().get("point", "labels").unwrap();
    assert!(labels.is_locked());
    assert_eq!((labels.dims(), labels.bytes()), (&[4, 1][..], &b"LKNE"[..]));
    assert_eq!(&file.bytes()[labels.byte_range()], b"LKNE");
    assert_eq!((file.units().as_deref(), &*file.points()[0].name), (Some("mm"), "LKNE"));
    let data = file.decode_points();
    assert_eq!((data.position(0, 0), data.position(1, 0)), (Some([5.0, -10.0, 15.0]), None));
    assert_eq!(residual(data.words[0]), Some((3, 5)));
    assert_eq!(residual(data.words[1]), None);
    let events = file.events();
    assert_eq!(
        (&*events[0].label, events[0].time_s, file.header().events[0].shown),
        ("RHS", 1.25, true)
    );
}

#[test]
fn more_than_255_points_have_all_their_labels() {
    let file =
        read(recording(Processor::Intel, NewStorage::Real, 600, 2).encode().unwrap()).unwrap();
    assert_eq!(file.points().len(), 600);
    assert!(
        file.points().iter().enumerate().all(|(index, point)| point.name == format!("P{index}"))
    );
    assert!(file.parameters().get("POINT", "LABELS3").is_some());
}

#[test]
fn more_than_65535_frames_are_counted_and_a_cut_is_noticed() {
    let mut new = recording(Processor::Sgi, NewStorage::Integer { scale: 0.05 }, 2, 70_000);
    new.first_frame = 100_000;
    let bytes = new.encode().unwrap();
    let file = read(bytes.clone()).unwrap();
    assert_eq!((file.frames(), file.first_frame()), (70_000, 100_000));
    assert_eq!(
        file.decode_points().counts().negative_residual,
        new.missing.iter().filter(|missing| **missing).count()
    );
    for frames in [1, 4_464, 65_535, 69_999] {
        let cut = file.sample_bytes(frames, 0).unwrap().start;
        let error = read(bytes[..cut].to_vec()).unwrap_err();
        assert!(
            matches!(error, C3dError::Truncated { declared_frames: 70_000, available_frames, .. } if available_frames == frames)
        );
    }
}

#[test]
fn the_frame_count_is_found_in_every_place_it_may_stand() {
    let base = recording(Processor::Intel, NewStorage::Real, 2, 70_000);
    let with = |parameters: Vec<NewParameter>| {
        let mut new = base.clone();
        new.groups = vec![NewGroup { parameters, ..NewGroup::new("POINT") }];
        new.groups.push(NewGroup {
            // One value each is no span of frames by the standard's two words, and says nothing.
            parameters: vec![
                integers("ACTUAL_START_FIELD", &[1]),
                integers("ACTUAL_END_FIELD", &[1]),
            ],
            ..NewGroup::new("TRIAL")
        });
        read(new.encode().unwrap()).unwrap()
    };
    let float = NewParameter::new("FRAMES", NewValues::Reals(vec![70_000.0]));
    let short = NewParameter::new("LONG_FRAMES", NewValues::Reals(vec![65_535.0]));
    assert_eq!(with(vec![float, short.clone()]).frames(), 70_000);
    assert_eq!(with(vec![]).frames(), 70_000);
    let counted = with(vec![short]);
    assert_eq!(counted.frames(), 70_000);
    assert!(counted.report().notes.contains(&ReadNote::FrameCountFromLength { frames: 70_000 }));
}

fn integers(name: &str, values: &[i16]) -> NewParameter {
    NewParameter::new(name, NewValues::Integers(values.to_vec()))
}

#[test]
fn disagreeing_declarations_are_settled_by_what_the_file_holds() {
    let mut new = recording(Processor::Intel, NewStorage::Real, 4, 30);
    new.groups = vec![NewGroup {
        parameters: vec![integers("DATA_START", &[40]), integers("FRAMES", &[31])],
        ..NewGroup::new("POINT")
    }];
    let mut bytes = new.encode().unwrap();
    let truth = read(recording(Processor::Intel, NewStorage::Real, 4, 30).encode().unwrap())
        .unwrap()
        .decode_points();
    let file = read(bytes.clone()).unwrap();
    assert_eq!(file.decode_points(), truth);
    let about = |wanted: Declaration| {
        file.report().notes.iter().any(|note| matches!(note, ReadNote::Disagreement { declaration, .. } if *declaration == wanted))
    };
    assert!(about(Declaration::DataStart) && about(Declaration::FrameCount));

    bytes[2..4].copy_from_slice(&3_u16.to_le_bytes());
    let file = read(bytes).unwrap();
    assert_eq!(file.decode_points(), truth);
}

#[test]
fn recordings_without_points_or_analog_or_frames_are_read() {
    let mut analog_only = recording(Processor::Dec, NewStorage::Real, 0, 25);
    analog_only.missing.clear();
    let file = read(analog_only.encode().unwrap()).unwrap();
    assert_eq!((file.frames(), file.points().len(), file.decode_analog().samples), (25, 0, 50));
    assert_eq!(file.decode_points().xyz.len(), 0);

    let mut points_only = recording(Processor::Intel, NewStorage::Real, 3, 25);
    points_only.analog = None;
    let file = read(points_only.encode().unwrap()).unwrap();
    assert_eq!(
        (file.frames(), file.analog().channels, file.decode_analog().values.len()),
        (25, 0, 0)
    );

    let file = read(NewC3d::new(vec!["A".into()], 50.0).encode().unwrap()).unwrap();
    assert_eq!((file.frames(), file.decode_points().frames), (0, 0));
}

#[test]
fn names_are_unique_and_labels_are_kept() {
    let labels = ["A", "A", "A_2", "", "*7", "S:*3", "A"].map(str::to_owned).to_vec();
    let file = read(NewC3d::new(labels, 50.0).encode().unwrap()).unwrap();
    let names: Vec<_> = file.points().iter().map(|point| point.name.as_str()).collect();
    assert_eq!(names, ["A", "A_3", "A_2", "*3", "*7", "S:*3", "A_4"]);
    assert_eq!(file.points()[6].label, "A");
    let unlabelled =
        file.points().iter().filter(|point| point.kind == PointKind::Unlabelled).count();
    assert_eq!(unlabelled, 3);
    assert!(file.report().notes.contains(&ReadNote::DuplicateLabels { count: 2 }));
    assert!(file.report().notes.contains(&ReadNote::MissingLabels { count: 1 }));
}

#[test]
fn model_outputs_are_told_from_markers() {
    let labels = [
        "LKNE",
        "Turn",
        "Odd",
        "LFEO",
        "LFEA",
        "LFEL",
        "LFEP",
        "RHipAngles",
        "CentreOfMass",
        "HEEL",
    ];
    let mut new = NewC3d::new(labels.map(str::to_owned).to_vec(), 50.0);
    let texts = |name: &str, texts: &[&str]| {
        NewParameter::new(
            name,
            NewValues::Texts(texts.iter().map(|text| (*text).to_owned()).collect()),
        )
    };
    new.groups = vec![NewGroup {
        parameters: vec![
            texts("TYPE_GROUPS", &["STRANGE", "STRANGE", "MARKERS", "MARKER"]),
            texts("STRANGE", &["Odd"]),
            texts("MARKERS", &["LKNE"]),
            texts("ANGLES", &["Turn"]),
        ],
        ..NewGroup::new("POINT")
    }];
    new.xyz = vec![[0.0; 3]; 10];
    let file = read(new.encode().unwrap()).unwrap();
    let kinds: Vec<_> = file.points().iter().map(|point| point.kind).collect();
    let output = PointKind::ModelOutput;
    assert_eq!(
        kinds[..3],
        [PointKind::Marker, output(ModelOutput::Angle), output(ModelOutput::Other)]
    );
    assert_eq!(kinds[3..7], [output(ModelOutput::SegmentAxis); 4]);
    assert_eq!(
        kinds[7..],
        [output(ModelOutput::Angle), output(ModelOutput::ModelledMarker), PointKind::Marker]
    );
    // A force or an angle of zero is a value; a marker at the origin is not there.
    let states = file.decode_points().states;
    assert_eq!((states[0], states[1]), (SampleState::ExactZero, SampleState::Present));
}

#[test]
fn missing_is_read_in_all_dialects() {
    let mut new = NewC3d::new(vec!["A".into()], 50.0);
    new.xyz = vec![[0.0; 3], [1.0; 3], [1.0; 3], [1.0; 3], [1.0; 3]];
    new.missing = vec![false, true, false, false, false];
    let mut bytes = new.encode().unwrap();
    let file = read(bytes.clone()).unwrap();
    let mut write = |frame: usize, value: usize, float: f32| {
        let at = file.sample_bytes(frame, 0).unwrap().start + value * 4;
        bytes[at..at + 4].copy_from_slice(&float.to_le_bytes());
    };
    write(2, 1, f32::NAN);
    // The unsigned image of -1, which some writers of floats store.
    write(3, 3, 65_535.0);
    // No residual at all: the position counts.
    write(4, 3, 1.708e38);
    let file = read(bytes.clone()).unwrap();
    let data = file.decode_points();
    assert_eq!(data.states, [ExactZero, NegativeResidual, NotFinite, NegativeResidual, Present]);
    let counts = data.counts();
    assert_eq!(
        (counts.present, counts.negative_residual, counts.not_finite, counts.exact_zero),
        (1, 2, 1, 1)
    );
    assert_eq!(file.decode_frames(2..4).states, [NotFinite, NegativeResidual]);
    let options = C3dOptions { zeros_are_data: true, ..C3dOptions::default() };
    let zeros = mocap_io::c3d::C3d::parse(bytes, &options).unwrap();
    assert_eq!(zeros.decode_points().position(0, 0), Some([0.0; 3]));
}

#[test]
fn events_and_foreign_groups_are_kept() {
    let mut new = recording(Processor::Dec, NewStorage::Integer { scale: 0.05 }, 2, 3);
    let texts = |name: &str, texts: &[&str]| {
        NewParameter::new(
            name,
            NewValues::Texts(texts.iter().map(|text| (*text).to_owned()).collect()),
        )
    };
    let times = NewParameter::new("TIMES", NewValues::RealPairs(vec![[0.0, 1.5], [1.0, 2.25]]));
    let mut event = NewGroup::new("EVENT");
    event.parameters = vec![
        integers("USED", &[2]),
        texts("LABELS", &["Foot Strike", "Foot Off"]),
        texts("CONTEXTS", &["Left", "Right"]),
        times,
    ];
    let mut vendor = NewGroup::new("VENDOR");
    vendor.parameters = vec![NewParameter::new("GAIN", NewValues::Reals(vec![-0.25, 3.5]))];
    new.groups = vec![event, vendor];
    let file = read(new.encode().unwrap()).unwrap();
    let events = file.events();
    assert_eq!(
        (&*events[1].label, &*events[1].context, events[1].time_s),
        ("Foot Off", "Right", 62.25)
    );
    assert_eq!(file.parameters().get("vendor", "gain").unwrap().numbers(), [-0.25, 3.5]);
}

#[test]
fn unsigned_analog_samples_and_offsets_are_scaled() {
    let mut new = recording(Processor::Intel, NewStorage::Integer { scale: 0.05 }, 1, 1);
    let mut group = NewGroup::new("ANALOG");
    group.parameters = vec![
        NewParameter::new("FORMAT", NewValues::Texts(vec!["UNSIGNED".into()])),
        integers("OFFSET", &[-32_768, 0]),
        NewParameter::new("GEN_SCALE", NewValues::Reals(vec![2.0])),
    ];
    new.groups = vec![group];
    new.analog.as_mut().unwrap().values = vec![0.0, -0.5, 1.0, 1.5];
    let values = read(new.encode().unwrap()).unwrap().decode_analog().values;
    // Raw words 0, 65535, 2, 3; offset 32768 on the first channel; scale 0.5 times 2.
    assert_eq!(values, [-32_768.0, 65_535.0, -32_766.0, 3.0]);
}
