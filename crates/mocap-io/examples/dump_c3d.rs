//! Gives other C3D readers something to be compared with (`tests/cross_read/compare.py`).
//!
//! - `dump_c3d points FILE OUT` writes the points of FILE as raw numbers: frames and points as little-endian `u64`,
//!   then per sample x, y, z as little-endian `f64` in file units, then per sample one byte with its state (0 present,
//!   1 negative residual, 2 not finite, 3 exact zero), then analog samples and channels as `u64` and the analog values
//!   as `f64`, sample after sample. Prints one line about the file, and one per note.
//! - `dump_c3d patch FILE OUT` writes FILE with ten samples of its first point filled and one made missing.
//! - `dump_c3d make FOLDER` writes new files in every storage, with many points and with many frames.
#![expect(clippy::print_stdout, reason = "a command line tool")]

use std::error::Error;
use std::ffi::OsString;
use std::fs;
use std::path::Path;

use mocap_io::c3d::{
    C3d, C3dOptions, EditValue, NewAnalog, NewC3d, NewStorage, Processor, SampleEdit,
};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    match arguments.iter().map(|argument| argument.to_str()).collect::<Vec<_>>()[..] {
        [Some("points"), Some(input), Some(output)] => points(Path::new(input), Path::new(output)),
        [Some("patch"), Some(input), Some(output)] => patch(Path::new(input), Path::new(output)),
        [Some("make"), Some(folder)] => make(Path::new(folder)),
        _ => Err("usage: dump_c3d points FILE OUT | patch FILE OUT | make FOLDER".into()),
    }
}

fn points(input: &Path, output: &Path) -> Result<(), Box<dyn Error>> {
    let file = C3d::parse(fs::read(input)?, &C3dOptions::default())?;
    let data = file.decode_points();
    let mut out = Vec::with_capacity(16 + data.xyz.len() * 25);
    out.extend((data.frames as u64).to_le_bytes());
    out.extend((data.points as u64).to_le_bytes());
    out.extend(data.xyz.iter().flatten().flat_map(|&value| f64::from(value).to_le_bytes()));
    out.extend(data.states.iter().map(|&state| state as u8));
    let analog = file.decode_analog();
    out.extend((analog.samples as u64).to_le_bytes());
    out.extend((analog.channels as u64).to_le_bytes());
    out.extend(analog.values.iter().flat_map(|&value| f64::from(value).to_le_bytes()));
    fs::write(output, out)?;
    let (processor, storage) = (file.processor(), file.storage());
    let (frames, points, channels) = (data.frames, data.points, file.analog().channels);
    let missing = data.states.iter().filter(|state| state.is_missing()).count();
    println!("{processor:?}\t{storage:?}\t{frames}\t{points}\t{channels}\t{missing}");
    for note in &file.report().notes {
        println!("note\t{note}");
    }
    Ok(())
}

fn patch(input: &Path, output: &Path) -> Result<(), Box<dyn Error>> {
    let file = C3d::parse(fs::read(input)?, &C3dOptions::default())?;
    let fill = |frame: usize| SampleEdit {
        frame,
        point: 0,
        value: EditValue::Fill([100.0 + frame as f64, -200.0, 300.0]),
    };
    let gap = SampleEdit { frame: 10, point: 0, value: EditValue::Missing };
    let edits: Vec<SampleEdit> = (0..10).map(fill).chain([gap]).collect();
    fs::write(output, file.patch(&edits)?)?;
    Ok(())
}

fn make(folder: &Path) -> Result<(), Box<dyn Error>> {
    for (processor, name) in
        [(Processor::Intel, "intel"), (Processor::Dec, "dec"), (Processor::Sgi, "sgi")]
    {
        for (storage, kind) in
            [(NewStorage::Real, "real"), (NewStorage::Integer { scale: 0.05 }, "int")]
        {
            let mut new = recording(12, 150);
            new.processor = processor;
            new.storage = storage;
            fs::write(folder.join(format!("{name}_{kind}.c3d")), new.encode()?)?;
        }
    }
    fs::write(folder.join("600_points.c3d"), recording(600, 20).encode()?)?;
    fs::write(folder.join("70000_frames.c3d"), recording(3, 70_000).encode()?)?;
    let mut no_analog = recording(4, 50);
    no_analog.analog = None;
    fs::write(folder.join("no_analog.c3d"), no_analog.encode()?)?;
    Ok(())
}

fn recording(points: usize, frames: usize) -> NewC3d {
    let mut new = NewC3d::new((0..points).map(|point| format!("P{point}")).collect(), 120.0);
    let at = |index: usize| (index as f64 * 0.37).sin() * 900.0;
    let cells = points * frames;
    new.xyz = (0..cells).map(|index| [at(index), at(index + 7), at(index + 13)]).collect();
    new.missing = (0..cells).map(|index| index % 10 == 3).collect();
    new.analog = Some(NewAnalog {
        labels: vec!["Fx".to_owned(), "Fz".to_owned()],
        units: vec!["N".to_owned(), "N".to_owned()],
        samples_per_frame: 2,
        scale: 1.0,
        values: (0..frames * 4).map(|index| (index % 100) as f32).collect(),
    });
    new
}
