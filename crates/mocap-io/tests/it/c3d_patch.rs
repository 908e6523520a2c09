//! The patch writer changes the samples given and nothing else.

use mocap_io::c3d::{C3dError, EditValue, NewStorage, Processor, SampleEdit};
use proptest::prelude::*;

use super::c3d_support::{PROCESSORS, STORAGES, read, recording};

fn fill(frame: usize, point: usize, position: [f64; 3]) -> SampleEdit {
    SampleEdit { frame, point, value: EditValue::Fill(position) }
}

fn missing(frame: usize, point: usize) -> SampleEdit {
    SampleEdit { frame, point, value: EditValue::Missing }
}

#[test]
fn no_edit_gives_the_same_bytes() {
    for processor in PROCESSORS {
        for storage in STORAGES {
            let bytes = recording(processor, storage, 3, 9).encode().unwrap();
            assert_eq!(read(bytes.clone()).unwrap().patch(&[]).unwrap(), bytes);
        }
    }
}

#[test]
fn a_fill_and_a_gap_are_written_as_the_standard_says() {
    for processor in PROCESSORS {
        for storage in STORAGES {
            let file = read(recording(processor, storage, 3, 9).encode().unwrap()).unwrap();
            let bytes = file.patch(&[fill(0, 2, [1.05, -2.1, 300.15]), missing(4, 1)]).unwrap();
            let patched = read(bytes).unwrap().decode_points();
            let position = patched.position(0, 2).unwrap();
            // Steps of 0.05, or 24 bits of up to 512.
            let close = |a: f64, b: f64| (a - b).abs() < 2e-5;
            assert!(
                close(position[0], 1.05) && close(position[1], -2.1) && close(position[2], 300.15)
            );
            assert_eq!(patched.words[2], 0);
            let gap = patched.index(4, 1);
            assert_eq!((patched.xyz[gap], patched.words[gap]), ([0.0; 3], -1));
        }
    }
}

#[test]
fn the_bytes_of_a_fill_are_exactly_those_of_the_storage() {
    let bytes = |processor, storage| {
        let file = read(recording(processor, storage, 3, 9).encode().unwrap()).unwrap();
        let range = file.sample_bytes(1, 0).unwrap();
        let patched = file.patch(&[fill(1, 0, [1.0, -2.0, 0.5])]).unwrap();
        patched[range].to_vec()
    };
    let integer = NewStorage::Integer { scale: 0.5 };
    assert_eq!(bytes(Processor::Intel, integer), [2, 0, 252, 255, 1, 0, 0, 0]);
    assert_eq!(bytes(Processor::Sgi, integer), [0, 2, 255, 252, 0, 1, 0, 0]);
    assert_eq!(
        bytes(Processor::Intel, NewStorage::Real),
        [0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0x3f, 0, 0, 0, 0]
    );
    assert_eq!(
        bytes(Processor::Dec, NewStorage::Real),
        [0x80, 0x40, 0, 0, 0, 0xc1, 0, 0, 0, 0x40, 0, 0, 0, 0, 0, 0]
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn only_the_bytes_of_the_edited_samples_change(
        processor in 0..3_usize,
        storage in 0..2_usize,
        edits in prop::collection::vec((0..9_usize, 0..3_usize, prop::option::of([-1600.0..1600.0_f64, -1600.0..1600.0, 1.0..1600.0])), 0..8),
    ) {
        let file = read(recording(PROCESSORS[processor], STORAGES[storage], 3, 9).encode().unwrap()).unwrap();
        let edits: Vec<_> = edits.into_iter().map(|(frame, point, position)| {
            position.map_or_else(|| missing(frame, point), |position| fill(frame, point, position))
        }).collect();
        let patched = file.patch(&edits).unwrap();
        prop_assert_eq!(patched.len(), file.bytes().len());
        let may_change = |at: usize| edits.iter().any(|edit| file.sample_bytes(edit.frame, edit.point).unwrap().contains(&at));
        for (at, (new, old)) in patched.iter().zip(file.bytes()).enumerate() {
            prop_assert!(new == old || may_change(at), "byte {} changed", at);
        }
        let before = file.decode_points();
        let after = read(patched).unwrap().decode_points();
        for frame in 0..9 {
            for point in 0..3 {
                let last = edits.iter().rev().find(|edit| (edit.frame, edit.point) == (frame, point));
                match last.map(|edit| edit.value) {
                    None => prop_assert_eq!(after.position(frame, point), before.position(frame, point)),
                    Some(EditValue::Missing) => prop_assert_eq!(after.position(frame, point), None),
                    Some(EditValue::Fill(position)) => {
                        let stored = after.position(frame, point).unwrap();
                        // Half a step of 0.05; floats are closer.
                        prop_assert!((0..3).all(|axis| (stored[axis] - position[axis]).abs() < 0.0251));
                    }
                }
            }
        }
    }
}

#[test]
fn what_cannot_be_stored_is_refused_by_frame_and_point() {
    let integer = read(
        recording(Processor::Intel, NewStorage::Integer { scale: 0.05 }, 3, 9).encode().unwrap(),
    )
    .unwrap();
    let limit = 32_767.0 * f64::from(0.05_f32);
    assert!(integer.patch(&[fill(2, 1, [0.0, limit, 0.0])]).is_ok());
    let error = integer.patch(&[fill(2, 1, [0.0, -limit - 0.05, 0.0])]).unwrap_err();
    assert_eq!(error, C3dError::FillOutOfRange { frame: 2, point: 1, value: -limit - 0.05, limit });
    let error = integer.patch(&[fill(2, 1, [0.01, 0.01, -0.01])]).unwrap_err();
    assert_eq!(error, C3dError::FillReadsAsMissing { frame: 2, point: 1 });
    let error = integer.patch(&[fill(2, 1, [f64::NAN, 0.0, 0.0])]).unwrap_err();
    assert!(matches!(error, C3dError::FillNotFinite { frame: 2, point: 1, .. }));
    let error = integer.patch(&[missing(9, 0)]).unwrap_err();
    assert_eq!(error, C3dError::EditOutside { frame: 9, point: 0, frames: 9, points: 3 });

    let dec = read(recording(Processor::Dec, NewStorage::Real, 3, 9).encode().unwrap()).unwrap();
    assert!(dec.patch(&[fill(0, 0, [1.7e38, 0.0, 0.0])]).is_ok());
    for beyond in [1.8e38, 1e300, f64::INFINITY] {
        assert!(dec.patch(&[fill(0, 0, [beyond, 0.0, 0.0])]).is_err());
    }
}

#[test]
fn a_new_recording_that_does_not_fit_is_refused() {
    let mut new = recording(Processor::Intel, NewStorage::Integer { scale: 0.05 }, 3, 9);
    new.xyz[4][1] = 1e5;
    assert!(matches!(
        new.encode().unwrap_err(),
        C3dError::FillOutOfRange { frame: 1, point: 1, .. }
    ));
    new.missing.pop();
    assert_eq!(
        new.encode().unwrap_err(),
        C3dError::ShapeMismatch { what: "missing", found: 26, expected: 27 }
    );
    let mut new = recording(Processor::Intel, NewStorage::Real, 3, 9);
    new.labels[0] = "L".repeat(128);
    assert!(matches!(
        new.encode().unwrap_err(),
        C3dError::BeyondFormat { found: 128, limit: 127, .. }
    ));
    let mut new = recording(Processor::Intel, NewStorage::Real, 3, 9);
    new.point_rate_hz = f64::NAN;
    assert!(matches!(new.encode().unwrap_err(), C3dError::NotPositive { .. }));
}
