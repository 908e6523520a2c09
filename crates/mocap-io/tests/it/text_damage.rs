//! Damaged files: no panic, no silent loss.

use mocap_io::{ReadOptions, text::TextError};
use proptest::prelude::*;

use crate::text_support::{AMC, BVH, asf, dialects};

const SALVAGE: ReadOptions =
    ReadOptions { salvage: true, rate_hz: None, unit: None, zero_is_position: false };

/// Files without any count of frames: cut between two frames, they look whole.
const UNCOUNTED: [&str; 2] = ["cmu", "amc"];

#[test]
fn a_file_cut_anywhere_is_refused_or_says_so() {
    for (name, file, parse) in dialects() {
        let (whole, _) = parse(file.into(), &ReadOptions::default()).unwrap();
        for end in 0..file.len() {
            let cut = &file[..end];
            let Ok((frames, info)) = parse(cut.into(), &ReadOptions::default()) else { continue };
            let at_line = cut.ends_with('\n') || file[end..].starts_with(['\n', '\r']);
            let rest_is_blank = file[end..].trim().is_empty();
            let says = info.notes.iter().any(|note| note.contains("no line end"));
            let allowed = match name {
                // The last line of a skeleton is an `end` without content.
                "asf" => frames == whole && (says || "end".ends_with(file[end..].trim())),
                _ if UNCOUNTED.contains(&name) && at_line => says != cut.ends_with('\n'),
                _ => frames == whole && (rest_is_blank || says),
            };
            let says_cut = says || UNCOUNTED.contains(&name) && at_line || name == "asf";
            assert!(allowed || (UNCOUNTED.contains(&name) && says), "{name} cut at {end}: {cut:?}");
            assert!(says_cut || rest_is_blank, "{name} cut at {end}");
        }
    }
}

#[test]
fn salvage_keeps_what_is_whole() {
    for (name, file, parse) in dialects().into_iter().filter(|(name, ..)| *name != "asf") {
        let (whole, _) = parse(file.into(), &ReadOptions::default()).unwrap();
        // Half of the last line: cut at its second blank or delimiter from the end.
        let trimmed = file.trim_end();
        let cut = if name == "amc" {
            trimmed.rfind('\n').unwrap()
        } else {
            let separator = file.chars().find(|c| matches!(c, '\t' | ',')).unwrap_or(' ');
            trimmed.rfind(if name == "bvh" { ' ' } else { separator }).unwrap()
        };
        assert!(parse(file[..cut].into(), &ReadOptions::default()).is_err(), "{name}");
        let (kept, info) = parse(file[..cut].into(), &SALVAGE).unwrap();
        assert_eq!(kept, whole - 1, "{name}");
        assert!(info.notes.iter().any(|note| note.contains("salvaged")), "{name}");
    }
}

#[test]
fn a_motion_cannot_outgrow_its_file() {
    use std::fmt::Write;
    let mut file = String::from("HIERARCHY\nROOT R\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n");
    for _ in 0..2000 {
        file.push_str("End Site\n{\nOFFSET 0 0 0\n}\n");
    }
    let _ = write!(file, "}}\nMOTION\nFrames: 20000\nFrame Time: 1\n{}", "0\n".repeat(20_000));
    let error = mocap_io::text::bvh::Bvh::parse(file.into(), &ReadOptions::default()).unwrap_err();
    assert!(matches!(error, TextError::Unbalanced { joints: 2001, .. }), "{error}");
}

#[test]
fn an_end_site_has_no_children() {
    let parse = |text: &str| {
        mocap_io::text::bvh::Bvh::parse(text.into(), &ReadOptions::default()).unwrap_err()
    };
    let nested = format!("HIERARCHY\nROOT R\n{{{}", "End Site {".repeat(50_000));
    assert!(parse(&nested).to_string().contains("nothing else"));
    let long =
        format!("HIERARCHY\nROOT {}\n{{{}", "R".repeat(50_000), "End Site {}".repeat(50_000));
    assert!(parse(&long).to_string().contains("256 bytes"));
}

#[test]
fn an_amc_frame_tells_which_bone_it_lacks() {
    let cut = AMC.rfind("tibia").unwrap();
    let parse =
        |text: &str| mocap_io::text::amc::Amc::parse(text.into(), &asf(), &ReadOptions::default());
    let error = parse(&AMC[..cut]).unwrap_err();
    let expected = TextError::MissingBone { line: 14, frame: 3, bone: "tibia".into() };
    assert_eq!(error, expected);
    let jump = AMC.replace("\n2\n", "\n4\n");
    let expected = TextError::FrameNumber { line: 8, expected: 2, found: 4 };
    assert_eq!(parse(&jump).unwrap_err(), expected);
    let foreign = AMC.replace("tibia", "wing");
    assert!(matches!(parse(&foreign).unwrap_err(), TextError::Bone { line: 7, .. }));
    let first = AMC.find("2\nroot").unwrap();
    assert!(parse(&AMC[..first]).is_ok());
    let first_cut = AMC.find("tibia").unwrap();
    assert!(matches!(parse(&AMC[..first_cut]).unwrap_err(), TextError::MissingBone { .. }));
}

#[test]
fn a_bvh_count_is_checked() {
    let fewer = BVH.replace("Frames: 3", "Frames: 4");
    let error = mocap_io::text::bvh::Bvh::parse(fewer.into(), &ReadOptions::default()).unwrap_err();
    assert!(matches!(error, TextError::Count { what: "frames", declared: 4, found: 3, .. }));
}

/// Words that lead a parser deep into each format.
const WORDS: [&str; 66] = [
    "PathFileType",
    "DataRate",
    "NumFrames",
    "NumMarkers",
    "Units",
    "mm",
    "Frame#",
    "Time",
    "Frame",
    "X1",
    "A-x",
    "A-y",
    "A-z",
    "A X",
    "NO_OF_FRAMES",
    "NO_OF_MARKERS",
    "FREQUENCY",
    "MARKER_NAMES",
    "DATA_INCLUDED",
    "Format Version",
    "Total Exported Frames",
    "Length Units",
    "Type",
    "Name",
    "Marker",
    "Position",
    "HIERARCHY",
    "ROOT",
    "JOINT",
    "End Site",
    "OFFSET",
    "CHANNELS",
    "{",
    "}",
    "Xrotation",
    "Yposition",
    "MOTION",
    "Frames:",
    "Frame Time:",
    ":units",
    ":root",
    ":bonedata",
    ":hierarchy",
    "begin",
    "end",
    "name",
    "direction",
    "length",
    "axis",
    "XYZ",
    "dof",
    "rx",
    "order",
    "TX",
    "root",
    "femur",
    "\t",
    ",",
    "\n",
    "\r\n",
    "\"",
    "0",
    "1",
    "-1e308",
    "NaN",
    "9007199254740993",
];

fn word_salad() -> impl Strategy<Value = Vec<u8>> {
    let separator = prop::sample::select(vec![" ", "\t", ",", "\n", ""]);
    let word = (prop::sample::select(WORDS.to_vec()), separator);
    prop::collection::vec(word, 0..120)
        .prop_map(|words| words.into_iter().flat_map(|(w, s)| [w, s]).collect::<String>().into())
}

fn never_panics(bytes: &[u8]) {
    for (_, _, parse) in dialects() {
        for options in [ReadOptions::default(), SALVAGE] {
            if let Err(error) = parse(bytes.to_vec(), &options) {
                assert!(error.to_string().len() < 400, "{error}");
            }
        }
    }
}

proptest! {
    #[test]
    fn any_bytes_give_a_value_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        never_panics(&bytes);
    }

    #[test]
    fn any_words_give_a_value_or_an_error(bytes in word_salad()) {
        never_panics(&bytes);
    }

    #[test]
    fn mutated_files_give_a_value_or_an_error(
        which in 0..7_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..6),
    ) {
        let mut bytes = dialects()[which].1.as_bytes().to_vec();
        for (place, byte, kind) in changes {
            let at = place.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, b"\t\n,-.0 \"{}"[usize::from(byte) % 10]),
                2 if bytes.len() > 1 => { bytes.remove(at); }
                _ => {
                    let tail = bytes[at..bytes.len().min(at + usize::from(byte))].to_vec();
                    bytes.extend(tail);
                }
            }
        }
        never_panics(&bytes);
    }
}
