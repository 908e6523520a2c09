//! Tables: what is read from each dialect, and what is written.

use mocap_io::{
    LengthUnit, MissingMarks, ReadOptions,
    text::{EncodeOptions, Parsed, TextError, table::read_csv, table::read_tsv, trc},
};

use crate::text_support::{CMU, MOTIVE, QUALISYS, Read, TABLES, TRC, difference, take};

/// Half of the last decimal, 5e-7 mm, and one rounding of a metre-sized number.
const RESOLUTION_M: f64 = 5.1e-10;

fn csv(text: &str) -> Result<Parsed, TextError> {
    read_csv(text.into(), &ReadOptions::default())
}

fn noted(parsed: &Parsed, words: &str) -> bool {
    parsed.info.notes.iter().any(|note| note.contains(words))
}

#[test]
fn what_is_written_reads_back_to_the_resolution() {
    for (format, read, encode) in TABLES {
        for rate in [120.0, 59.94, 1000.0 / 3.0, 0.5] {
            let before = take(23, rate);
            for unit in [LengthUnit::Millimetre, LengthUnit::Metre, LengthUnit::Inch] {
                let options = EncodeOptions { unit, first_frame: -3 };
                let bytes = encode(&before, &options);
                let after = read(bytes.clone(), &ReadOptions::default()).unwrap();
                assert_eq!(after.take.markers(), before.markers(), "{format}");
                // The origin is written 1e-6 mm off, or one unit of the ninth decimal.
                let off = difference(&before, &after.take);
                assert!(off <= 1e-9 + RESOLUTION_M, "{format} {unit:?}: {off:e}");
                // In CSV the rate is known from times with nine decimals: 1e-9 s over 22 frames.
                let error = 2e-9 * rate / 22.0;
                assert!((after.take.rate_hz() / rate - 1.0).abs() < error, "{format} {rate}");
                assert_eq!(after.info.first_frame, -3);
                assert!(after.info.rate_declared);
                let names_it =
                    format != "tsv" && !(format == "csv" && unit == LengthUnit::Millimetre);
                assert_eq!(after.info.unit_declared, names_it, "{format} {unit:?}");
                assert!(!String::from_utf8(bytes.clone()).unwrap().to_lowercase().contains("nan"));
                if after.take.rate_hz() == rate {
                    assert!(encode(&after.take, &options) == bytes, "{format}: written again");
                }
            }
        }
    }
}

#[test]
fn trc_takes_the_header_at_its_word() {
    let parsed = trc::read(TRC.into(), &ReadOptions::default()).unwrap();
    assert_eq!(parsed.take.markers().names(), ["C7", "T10"]);
    assert_eq!(parsed.take.rate_hz(), 100.0);
    assert_eq!(parsed.take.position(0, 0), Some([10.5, -20.0, 30.0].map(|c| c * 0.001)));
    assert_eq!(parsed.take.position(2, 1), Some([1.1, 2.2, 3.3].map(|c| c * 0.001)));
    assert_eq!(parsed.info.first_frame, 5);
    assert!(parsed.info.unit_declared && parsed.info.rate_declared);
    let marks = MissingMarks { blank: 1, not_a_number: 1, ..MissingMarks::default() };
    assert_eq!(parsed.info.missing, marks);
    assert_eq!(parsed.info.notes, Vec::<String>::new());
}

#[test]
fn trc_written_for_opensim_has_its_header() {
    let bytes = trc::encode(&take(2, 100.0), &EncodeOptions::default());
    let text = String::from_utf8(bytes).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("PathFileType\t4\t(X/Y/Z)\t"));
    assert_eq!(
        lines[1],
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t\
         OrigNumFrames"
    );
    assert_eq!(lines[2], "100\t100\t2\t4\tmm\t100\t1\t2");
    assert_eq!(lines[3], "Frame#\tTime\tjane:C7\t\t\tT10\t\t\tknee, \"left\"\t\t\ta-x\t\t");
    assert_eq!(lines[4], "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3\tX4\tY4\tZ4");
    assert_eq!(lines[5], "");
    assert!(lines[6].starts_with("1\t0.000000000\t"));
    assert!(lines[6].ends_with("\t\t\t"), "the last marker is missing, its fields are empty");
}

#[test]
fn trc_of_other_hands_reads_too() {
    let doubled = TRC.replace("Time\tC7\t\t\tT10", "Time\t\tC7\t\tT10");
    let no_blank = TRC.replace("Z2\n\n", "Z2\n");
    let crlf = TRC.replace('\n', "\r\n");
    let trailing = TRC.replace("1\t2\t3\n", "1\t2\t3\t\t\n").replace("\n\n", "\n\t\t\t\n");
    let no_axes = TRC.replace("\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n", "");
    let keys = TRC.replace("NumFrames\tNumMarkers", "numFrames\tNUMMARKERS");
    let marked = format!("\u{feff}{TRC}");
    let expected = trc::read(TRC.into(), &ReadOptions::default()).unwrap().take;
    for text in [doubled, no_blank, crlf, trailing, no_axes, keys.clone(), marked] {
        let parsed = trc::read(text.clone().into(), &ReadOptions::default()).unwrap();
        assert!(parsed.take.bit_eq(&expected), "{text}");
        assert_eq!(noted(&parsed, "OpenSim refuses"), text == keys);
    }
}

#[test]
fn counts_of_a_header_are_checked() {
    let cases: [(&str, Read, &str, &str); 5] = [
        (TRC, trc::read, "\t3\t2\tmm", "\t4\t2\tmm"),
        (TRC, trc::read, "\t3\t2\tmm", "\t2\t2\tmm"),
        (QUALISYS, read_tsv, "NO_OF_FRAMES\t3", "NO_OF_FRAMES\t5"),
        (MOTIVE, read_csv, "Exported Frames,3", "Exported Frames,2"),
        (TRC, trc::read, "\t3\t2\tmm", "\t3\t1\tmm"),
    ];
    for (file, read, right, wrong) in cases {
        let bytes = file.replace(right, wrong).into_bytes();
        let strict = read(bytes.clone(), &ReadOptions::default()).unwrap_err();
        assert!(matches!(strict, TextError::Count { .. }), "{strict}");
        let salvage = ReadOptions { salvage: true, ..ReadOptions::default() };
        let parsed = read(bytes, &salvage).unwrap();
        assert_eq!(parsed.take.frames(), 3);
        assert!(noted(&parsed, "salvaged"));
    }
    let fewer = QUALISYS.replace("NO_OF_MARKERS\t2", "NO_OF_MARKERS\t3");
    let error = read_tsv(fewer.into(), &ReadOptions::default()).unwrap_err();
    assert_eq!(error, TextError::Count { line: 3, what: "markers", declared: 3, found: 2 });
}

#[test]
fn a_plain_table_states_neither_rate_nor_unit() {
    let parsed = csv(CMU).unwrap();
    assert_eq!(parsed.take.markers().names(), ["jane:C7", "jane:T10"]);
    assert_eq!(parsed.take.rate_hz(), 120.0);
    assert_eq!(parsed.take.position(0, 0), Some([10.5, -20.0, 30.0].map(|c| c * 0.001)));
    assert!(!parsed.info.unit_declared && !parsed.info.rate_declared);
    assert!(noted(&parsed, "120 Hz is assumed") && noted(&parsed, "millimetres are assumed"));
    let given = ReadOptions {
        rate_hz: Some(60.0),
        unit: Some(LengthUnit::Metre),
        ..ReadOptions::default()
    };
    let parsed = read_csv(CMU.into(), &given).unwrap();
    assert_eq!(parsed.take.rate_hz(), 60.0);
    assert_eq!(parsed.take.position(0, 0), Some([10.5, -20.0, 30.0]));
    assert_eq!(parsed.info.notes, Vec::<String>::new());
}

#[test]
fn columns_come_in_any_order_and_company() {
    let parsed = csv("Time,Force,A_Z,A_X,B z,B y,B x,A_Y,Frame\n\
        0.00,7,3,1,6,5,4,2,10\n0.02,x,3,1,6,5,4,2,11\n0.04,,3,1,6,5,,2,12\n")
    .unwrap();
    assert_eq!(parsed.take.markers().names(), ["A", "B"]);
    assert_eq!(parsed.take.rate_hz(), 50.0);
    assert_eq!(parsed.take.position(1, 0), Some([0.001, 0.002, 0.003]));
    assert_eq!(parsed.take.position(2, 1), None);
    assert_eq!(parsed.info.first_frame, 10);
    assert!(noted(&parsed, "`Force`") && noted(&parsed, "some coordinates but not all"));
}

#[test]
fn units_in_column_names_count_and_must_agree() {
    let parsed = csv("A-x [cm];A-y [cm];A-z [cm]\n100;200;300\n").unwrap();
    assert_eq!(parsed.take.position(0, 0), Some([1.0, 2.0, 3.0]));
    assert!(parsed.info.unit_declared);
    let error = csv("A-x [cm],A-y [mm],A-z [cm]\n1,2,3\n").unwrap_err();
    assert!(matches!(error, TextError::Field { line: 1, field: 2, .. }), "{error}");
}

#[test]
fn equal_labels_get_names_of_their_own() {
    let parsed = csv("A-x,A-y,A-z,A-x,A-y,A-z,A_2-x,A_2-y,A_2-z\n1,2,3,4,5,6,7,8,9\n").unwrap();
    assert_eq!(parsed.take.markers().names(), ["A", "A_3", "A_2"]);
    assert_eq!(parsed.take.position(0, 1), Some([0.004, 0.005, 0.006]));
    assert!(noted(&parsed, "`A_3`"));
}

#[test]
fn zeros_are_missing_unless_they_are_positions() {
    for (read, text) in [
        (
            read_csv as fn(Vec<u8>, &ReadOptions) -> _,
            CMU.replace("10.5, -20, 30", "0, -0.0, 0.000"),
        ),
        (read_tsv, QUALISYS.to_owned()),
        (trc::read, TRC.replace("10.5\t-20\t30", "0\t0\t0")),
    ] {
        let parsed: Parsed = read(text.clone().into(), &ReadOptions::default()).unwrap();
        assert_eq!(parsed.info.missing.exact_zero, 1, "{text}");
        let kept = ReadOptions { zero_is_position: true, ..ReadOptions::default() };
        let positions = read(text.into(), &kept).unwrap();
        assert_eq!(positions.info.missing.exact_zero, 0);
        let seen = positions.take.observed().count();
        assert_eq!(seen, parsed.take.observed().count() + 1);
    }
}

#[test]
fn qualisys_says_what_it_filled_itself() {
    let parsed = read_tsv(QUALISYS.into(), &ReadOptions::default()).unwrap();
    assert_eq!(parsed.take.markers().names(), ["hand_top", "hand left"]);
    assert_eq!((parsed.take.frames(), parsed.take.rate_hz()), (3, 100.0));
    assert!(noted(&parsed, "hand left (Mixed)"));
    assert!(parsed.info.storage.contains("CR LF"));
    let names = QUALISYS.find("Frame\t").unwrap();
    let rows = QUALISYS.find("1\t0.00000").unwrap();
    let headless = format!("{}{}", &QUALISYS[..names], &QUALISYS[rows..]);
    let old = read_tsv(headless.into(), &ReadOptions::default()).unwrap();
    assert!(old.take.bit_eq(&parsed.take), "exports without a line of column names");
    let bodies = QUALISYS.replace("INCLUDED\t3D", "INCLUDED\t6D");
    let error = read_tsv(bodies.into(), &ReadOptions::default()).unwrap_err();
    assert!(matches!(error, TextError::Line { line: 9, .. }), "{error}");
}

#[test]
fn motive_gives_measured_markers_only() {
    let parsed = csv(MOTIVE).unwrap();
    assert_eq!(parsed.take.markers().names(), ["LFHD", "Knee, left"]);
    assert_eq!((parsed.take.frames(), parsed.take.rate_hz()), (3, 120.0));
    assert_eq!(parsed.take.position(0, 0), Some([1.5, 2.5, 3.5]));
    assert_eq!(parsed.take.position(1, 0), None);
    assert_eq!(parsed.info.first_frame, 0);
    assert!(parsed.info.unit_declared && parsed.info.rate_declared);
    let others = parsed.info.other_points;
    assert_eq!(others[0], ("Hat".to_owned(), "Rigid Body".to_owned()));
    assert_eq!(others[1], ("Hat:Marker 1".to_owned(), "Rigid Body Marker".to_owned()));
    let bodies = MOTIVE.replace(",Marker", ",Bone");
    assert!(csv(&bodies).unwrap_err().to_string().contains("export with markers"));
}

#[test]
fn rates_that_disagree_are_told() {
    let slow = TRC.replace("0.05", "0.08").replace("0.06", "0.12");
    let parsed = trc::read(slow.into(), &ReadOptions::default()).unwrap();
    assert_eq!(parsed.take.rate_hz(), 100.0);
    assert!(noted(&parsed, "25 Hz"));
    let given = ReadOptions { rate_hz: Some(50.0), ..ReadOptions::default() };
    let parsed = trc::read(TRC.into(), &given).unwrap();
    assert_eq!(parsed.take.rate_hz(), 100.0, "the file's own rate wins");
    assert!(noted(&parsed, "not the given 50 Hz"));
}

#[test]
fn refusals_name_the_place() {
    let error = csv("1,2,3\n4,5,6\n").unwrap_err();
    assert!(matches!(error, TextError::Line { line: 1, .. }), "{error}");
    assert_eq!(csv("a,b,c\n1,2,3\n").unwrap_err(), TextError::NoMarkers { line: 1 });
    let error = csv("A-x,A-z\n1,2\n").unwrap_err();
    assert!(matches!(error, TextError::IncompleteMarker { axis: 'y', .. }), "{error}");
    let error = csv("A-x,A-y,A-z\n1,2,3\n1,2,oops\n").unwrap_err();
    assert!(matches!(error, TextError::Field { line: 3, field: 3, .. }), "{error}");
    let error = csv("A-x,A-y,A-z\n1,2,3,4\n").unwrap_err();
    assert_eq!(error, TextError::Width { line: 2, expected: 3, found: 4 });
    assert_eq!(csv("A-x,A-y,A-z\n").unwrap_err(), TextError::NoFrames { line: 1 });
    assert_eq!(csv(" \n\n").unwrap_err(), TextError::Empty);
    let utf16 = read_csv(b"\xFF\xFEA\0".to_vec(), &ReadOptions::default()).unwrap_err();
    assert_eq!(utf16, TextError::Utf16);
}

#[test]
fn lost_frames_are_noted() {
    let parsed = csv("Frame,A-x,A-y,A-z\n1,1,2,3\n2,1,2,3\n4,1,2,3\n").unwrap();
    assert!(noted(&parsed, "line 4 is frame 4 where 3 should come"));
}
