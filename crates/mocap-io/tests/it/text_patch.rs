//! Patching a table changes the fields of the edited samples and no other byte.

use std::collections::BTreeMap;

use mocap_io::{
    Edit, ReadOptions, Sample,
    text::{EncodeOptions, TextError},
};
use proptest::prelude::*;

use crate::text_support::{CMU, MOTIVE, QUALISYS, Read, TABLES, TRC, take};

const FILES: [(&str, Read, u8); 4] = [
    (TRC, mocap_io::text::trc::read, b'\t'),
    (CMU, mocap_io::text::table::read_csv, b','),
    (QUALISYS, mocap_io::text::table::read_tsv, b'\t'),
    (MOTIVE, mocap_io::text::table::read_csv, b','),
];

fn read(file: &str, read: Read) -> mocap_io::text::Parsed {
    read(file.into(), &ReadOptions::default()).unwrap()
}

/// Fields that differ, as (line, field, new text); lines and blanks have to be the same.
fn changes(before: &[u8], after: &[u8], delimiter: u8) -> Vec<(usize, usize, String)> {
    let lines = |bytes: &[u8]| bytes.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect::<Vec<_>>();
    let (before, after) = (lines(before), lines(after));
    assert_eq!(before.len(), after.len());
    let mut found = Vec::new();
    for (line, (old, new)) in before.iter().zip(&after).enumerate() {
        if old == new {
            continue;
        }
        let fields =
            |l: &[u8]| l.split(|&b| b == delimiter).map(<[u8]>::to_vec).collect::<Vec<_>>();
        let (old, new) = (fields(old), fields(new));
        assert_eq!(old.len(), new.len());
        for (field, (o, n)) in old.iter().zip(&new).enumerate().filter(|(_, (o, n))| o != n) {
            let text = |b: &[u8]| String::from_utf8(b.to_vec()).unwrap();
            let blanks = |b: &[u8]| (b.starts_with(b" "), b.ends_with(b"\r"));
            assert_eq!(blanks(o), blanks(n), "the blanks around a number stay");
            found.push((line + 1, field + 1, text(n).trim().to_owned()));
        }
    }
    found
}

#[test]
fn no_edits_give_the_same_bytes() {
    for (file, reader, _) in FILES {
        let parsed = read(file, reader);
        assert_eq!(parsed.document.bytes(), file.as_bytes());
        assert_eq!(parsed.document.patch(&[]).unwrap(), file.as_bytes());
    }
}

#[test]
fn a_fill_writes_three_fields() {
    let expected = [
        ("11.000000", "-22.000000", "33.000000"),
        ("11.000000", "-22.000000", "33.000000"),
        ("11.000000", "-22.000000", "33.000000"),
        ("0.011000000", "-0.022000000", "0.033000000"),
    ];
    let places = [(8, [6, 7, 8]), (3, [4, 5, 6]), (14, [6, 7, 8]), (9, [12, 13, 14])];
    for (((file, reader, delimiter), (x, y, z)), (line, fields)) in
        FILES.into_iter().zip(expected).zip(places)
    {
        let parsed = read(file, reader);
        let sample = Sample::Filled([0.011, -0.022, 0.033]);
        let out = parsed.document.patch(&[Edit { frame: 1, marker: 1, sample }]).unwrap();
        // The name of a Motive marker has the delimiter in it, but its header does not change.
        let found = changes(file.as_bytes(), &out, delimiter);
        let wanted: Vec<_> =
            fields.into_iter().zip([x, y, z]).map(|(f, t)| (line, f, t.to_owned())).collect();
        assert_eq!(found, wanted);
        let again = reader(out, &ReadOptions::default()).unwrap();
        let p = again.take.position(1, 1).unwrap();
        // One rounding of a number of some centimetres.
        assert!(p.iter().zip([0.011, -0.022, 0.033]).all(|(a, b)| (a - b).abs() < 1e-16));
    }
}

#[test]
fn hiding_blanks_three_fields() {
    for (file, reader, delimiter) in FILES {
        let parsed = read(file, reader);
        let edit = Edit { frame: 0, marker: 0, sample: Sample::Missing };
        let out = parsed.document.patch(&[edit]).unwrap();
        let found = changes(file.as_bytes(), &out, delimiter);
        assert_eq!(found.len(), 3);
        assert!(found.iter().all(|(_, _, text)| text.is_empty()));
        assert_eq!(reader(out, &ReadOptions::default()).unwrap().take.position(0, 0), None);
    }
}

#[test]
fn edits_that_do_not_fit_are_refused() {
    let parsed = read(CMU, FILES[1].1);
    let edit =
        |frame, marker, x: f64| Edit { frame, marker, sample: Sample::Filled([x, 0.0, 0.0]) };
    let outside = TextError::OutOfRange { frame: 3, marker: 0, frames: 3, markers: 2 };
    assert_eq!(parsed.document.patch(&[edit(3, 0, 1.0)]).unwrap_err(), outside);
    assert!(parsed.document.patch(&[edit(0, 2, 1.0)]).is_err());
    for x in [f64::NAN, f64::INFINITY, f64::MAX] {
        let refused = TextError::NotFinite { frame: 0, marker: 1 };
        assert_eq!(parsed.document.patch(&[edit(0, 1, x)]).unwrap_err(), refused);
    }
}

#[test]
fn a_fill_at_the_origin_is_not_lost() {
    for (file, reader, _) in FILES {
        let parsed = read(file, reader);
        let edit = Edit { frame: 0, marker: 0, sample: Sample::Filled([0.0; 3]) };
        let out = parsed.document.patch(&[edit]).unwrap();
        assert!(reader(out, &ReadOptions::default()).unwrap().take.is_observed(0, 0));
    }
}

fn edits(frames: usize, markers: usize) -> impl Strategy<Value = Vec<Edit>> {
    let place = (0..frames, 0..markers);
    let sample = prop_oneof![
        Just(Sample::Missing),
        prop::array::uniform3(-10.0..10.0_f64).prop_map(Sample::Filled),
    ];
    let edit = (place, sample);
    prop::collection::vec(edit, 0..30).prop_map(|list| {
        list.into_iter().map(|((frame, marker), sample)| Edit { frame, marker, sample }).collect()
    })
}

proptest! {
    #[test]
    fn untouched_samples_keep_their_bits_and_edited_ones_arrive(edits in edits(23, 4)) {
        for (format, reader, encode) in TABLES {
            let file = encode(&take(23, 100.0), &EncodeOptions::default());
            let parsed = reader(file.clone(), &ReadOptions::default()).unwrap();
            let out = parsed.document.patch(&edits).unwrap();
            let after = reader(out, &ReadOptions::default()).unwrap();
            let last: BTreeMap<_, _> =
                edits.iter().map(|e| ((e.frame, e.marker), e.sample)).collect();
            for frame in 0..23 {
                for marker in 0..4 {
                    let found = after.take.position(frame, marker);
                    match last.get(&(frame, marker)) {
                        None => prop_assert_eq!(found, parsed.take.position(frame, marker)),
                        Some(Sample::Missing) => prop_assert_eq!(found, None, "{}", format),
                        Some(Sample::Filled(p)) => {
                            let found = found.unwrap();
                            // Half of the sixth decimal of a millimetre, and one rounding.
                            prop_assert!((0..3).all(|a| (found[a] - p[a]).abs() < 5.1e-10));
                        }
                    }
                }
            }
        }
    }
}
