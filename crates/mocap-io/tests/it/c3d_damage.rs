//! Damaged files give a typed error or a value, never a panic, and a cut is never silent.

use mocap_io::c3d::{C3dError, EditValue, NewStorage, Processor, ReadNote, SampleEdit};
use proptest::prelude::*;

use super::c3d_support::{PROCESSORS, STORAGES, read, recording, salvage};

/// Touches everything that can be computed from a file.
pub fn exercise(bytes: &[u8]) {
    for parsed in [read(bytes.to_vec()), salvage(bytes.to_vec())] {
        match parsed {
            Err(error) => assert!(!error.to_string().is_empty()),
            Ok(file) => {
                let data = file.decode_points();
                assert_eq!(data.states.len(), data.xyz.len());
                let _ = (file.decode_analog(), file.events(), file.first_frame(), file.units());
                for parameter in file.parameters().iter() {
                    let _ = (
                        parameter.name(),
                        parameter.numbers(),
                        parameter.counts(),
                        parameter.texts(),
                    );
                }
                assert_eq!(file.patch(&[]).unwrap(), bytes);
                if !data.xyz.is_empty() {
                    let edit = SampleEdit {
                        frame: data.frames - 1,
                        point: data.points - 1,
                        value: EditValue::Missing,
                    };
                    let patched = salvage(file.patch(&[edit]).unwrap()).unwrap();
                    assert!(patched.decode_points().states.last().unwrap().is_missing());
                }
                let notes: Vec<_> = file.report().notes.iter().map(ToString::to_string).collect();
                assert!(notes.iter().all(|note| !note.is_empty()));
            }
        }
    }
}

#[test]
fn a_file_cut_anywhere_is_refused_unless_only_padding_is_lost() {
    for processor in PROCESSORS {
        for storage in STORAGES {
            let bytes = recording(processor, storage, 3, 20).encode().unwrap();
            let whole = read(bytes.clone()).unwrap();
            let data = whole.decode_points();
            let range = whole.data_range();
            assert!(range.end < bytes.len());
            for cut in 0..range.end {
                let error = read(bytes[..cut].to_vec()).unwrap_err();
                if cut >= range.start {
                    let frame_bytes = range.len() / 20;
                    let available = (cut - range.start) / frame_bytes;
                    assert!(
                        matches!(error, C3dError::Truncated { declared_frames: 20, available_frames, .. } if available_frames == available)
                    );
                }
            }
            for cut in range.end..bytes.len() {
                assert_eq!(read(bytes[..cut].to_vec()).unwrap().decode_points(), data);
            }
        }
    }
}

#[test]
fn salvage_keeps_the_whole_frames_and_says_so() {
    let bytes = recording(Processor::Dec, NewStorage::Real, 3, 20).encode().unwrap();
    let whole = read(bytes.clone()).unwrap();
    let cut = whole.sample_bytes(13, 1).unwrap().start + 3;
    let file = salvage(bytes[..cut].to_vec()).unwrap();
    assert_eq!(file.decode_points(), whole.decode_frames(0..13));
    assert!(
        file.report()
            .notes
            .contains(&ReadNote::Salvaged { declared_frames: 20, available_frames: 13 })
    );
    assert!(file.patch(&[SampleEdit { frame: 13, point: 0, value: EditValue::Missing }]).is_err());
}

#[test]
fn a_wrong_count_that_fits_a_cut_file_is_refused() {
    // The header means fewer analog values than the parameters: the cut file has room for the header's frames only.
    let mut bytes = recording(Processor::Intel, NewStorage::Real, 3, 200).encode().unwrap();
    bytes[4..6].copy_from_slice(&2_u16.to_le_bytes());
    let file = read(bytes.clone()).unwrap();
    assert_eq!(file.analog().samples_per_frame, 2);
    let error = read(bytes[..file.data_range().end - 700].to_vec()).unwrap_err();
    assert!(matches!(error, C3dError::LayoutConflict { .. }));
}

#[test]
fn damaged_headers_are_refused_with_their_rule() {
    let bytes = recording(Processor::Intel, NewStorage::Real, 3, 20).encode().unwrap();
    let with = |at: usize, values: &[u8]| {
        let mut copy = bytes.clone();
        copy[at..at + values.len()].copy_from_slice(values);
        read(copy).unwrap_err()
    };
    assert_eq!(read(vec![]).unwrap_err(), C3dError::TooShort { len: 0 });
    assert_eq!(with(1, &[0]), C3dError::NotC3d { found: 0 });
    assert!(matches!(with(0, &[0]), C3dError::ParametersOutside { block: 0, .. }));
    assert!(matches!(with(0, &[200]), C3dError::ParametersOutside { block: 200, .. }));
    assert_eq!(with(515, &[1]), C3dError::UnknownProcessor { byte: 515, found: 1 });
    let labels = bytes.windows(6).position(|window| window == b"LABELS").unwrap();
    // Name, pointer, type and number of dimensions come before the dimensions.
    assert!(matches!(with(labels + 10, &[255, 255]), C3dError::ParameterOverrun { .. }));
    let scale = bytes.windows(5).position(|window| window == b"SCALE").unwrap();
    let mut copy = bytes.clone();
    copy[12..16].fill(0);
    assert_eq!(read(copy.clone()).unwrap().storage(), read(bytes.clone()).unwrap().storage());
    copy[scale + 9..scale + 13].fill(0);
    assert!(matches!(read(copy).unwrap_err(), C3dError::ScaleInvalid { .. }));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_give_a_value_or_an_error(mut bytes in prop::collection::vec(any::<u8>(), 0..4096), processor in 84..87_u8) {
        exercise(&bytes);
        if bytes.len() > 600 {
            bytes[0] = 2;
            bytes[1] = 0x50;
            bytes[515] = processor;
            exercise(&bytes);
        }
    }

    #[test]
    fn mutated_files_give_a_value_or_an_error(
        processor in 0..3_usize,
        storage in 0..2_usize,
        mutations in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..24),
    ) {
        let mut bytes = recording(PROCESSORS[processor], STORAGES[storage], 4, 30).encode().unwrap();
        let head = bytes.len().min(2048);
        for (index, value, in_head) in mutations {
            let at = index.index(if in_head { head } else { bytes.len() });
            bytes[at] = value;
        }
        exercise(&bytes);
    }
}
