//! CSV and TSV tables: columns `NAME-x`, `NAME-y`, `NAME-z`; Qualisys TSV; `OptiTrack` Motive CSV.
//!
//! # Plain tables
//! The first line names the columns: `[subject:]NAME` with `-x`, `_x`, `.x`, ` x` or `:x` at its end, in
//! either case, and the unit in brackets after it if it has one (`C7-x [m]`). A column `Frame` numbers
//! the frames, a column `Time` gives the sampling rate; other columns are kept and not read. Without a
//! unit, millimetres are assumed, and without a time column 120 Hz, as for CMU's files; both are noted.
//!
//! # Qualisys
//! A header of `KEY value` lines. Qualisys Track Manager writes millimetres and does not say so.
//!
//! # Motive
//! A header of settings and of the rows `Type`, `Name`, `ID`. Columns of the type `Marker` are read; rigid
//! bodies, bones and the markers that Motive's models predict are listed as other points.

mod columns;
mod motive;
mod qualisys;

use mocap_core::Take;

use super::{
    EncodeOptions, Parsed, TextError, grid,
    lines::Lines,
    write::{plain_name, push_rows, time},
};
use crate::{Format, LengthUnit, ReadOptions};

/// Reads a CSV file: a plain table, or a Motive export.
///
/// # Errors
/// [`TextError`], with the line.
///
/// ```
/// use mocap_io::{ReadOptions, text::table};
/// let file = "jane:C7-x, jane:C7-y, jane:C7-z\n10, 20, 30\n, , \n";
/// let parsed = table::read_csv(file.into(), &ReadOptions::default())?;
/// assert_eq!(parsed.take.markers().name(0), "jane:C7");
/// assert_eq!(parsed.take.position(0, 0), Some([0.010, 0.020, 0.030]));
/// assert!(!parsed.info.rate_declared && !parsed.info.unit_declared);
/// # Ok::<(), mocap_io::text::TextError>(())
/// ```
pub fn read_csv(bytes: Vec<u8>, options: &ReadOptions) -> Result<Parsed, TextError> {
    read(bytes, Format::Csv, options)
}

/// Reads a TSV file: a Qualisys export, or a plain table.
///
/// # Errors
/// [`TextError`], with the line.
pub fn read_tsv(bytes: Vec<u8>, options: &ReadOptions) -> Result<Parsed, TextError> {
    read(bytes, Format::Tsv, options)
}

fn read(bytes: Vec<u8>, format: Format, options: &ReadOptions) -> Result<Parsed, TextError> {
    let mut ahead = Lines::new(&bytes)?;
    let first = ahead.need("the column names")?;
    let head = if motive::is_head(first) {
        motive::head(&bytes, format, options)?
    } else if qualisys::is_head(first) {
        qualisys::head(&bytes, format, options)?
    } else {
        columns::head(&bytes, format)?
    };
    grid::read(bytes, head, options)
}

/// Writes a take as a plain table: `Frame,Time,NAME-x,NAME-y,NAME-z,…`.
///
/// Millimetres are not named, other units stand in brackets after each column's name.
#[must_use]
pub fn encode_csv(take: &Take, options: &EncodeOptions) -> Vec<u8> {
    let unit = match options.unit {
        LengthUnit::Millimetre => String::new(),
        other => format!(" [{}]", other.symbol()),
    };
    let mut head = String::from("Frame,Time");
    for name in take.markers().names() {
        for axis in ['x', 'y', 'z'] {
            head.push(',');
            head.push_str(&csv_field(&format!("{}-{axis}{unit}", plain_name(name))));
        }
    }
    head.push('\n');
    let mut out = head.into_bytes();
    push_rows(&mut out, take, options.unit, ',', |t| {
        format!("{},{}", options.first_frame.saturating_add_unsigned(t as u64), time(take, t))
    });
    out
}

fn csv_field(text: &str) -> String {
    if text.contains([',', '"']) {
        return format!("\"{}\"", text.replace('"', "\"\""));
    }
    text.to_owned()
}

/// Writes a take as Qualisys Track Manager does, in millimetres whatever `options.unit` says: the
/// format has no place to name another unit.
#[must_use]
pub fn encode_tsv(take: &Take, options: &EncodeOptions) -> Vec<u8> {
    let names: Vec<String> = take.markers().names().iter().map(|name| plain_name(name)).collect();
    let mut head = format!(
        "NO_OF_FRAMES\t{}\nNO_OF_CAMERAS\t0\nNO_OF_MARKERS\t{}\nFREQUENCY\t{}\nNO_OF_ANALOG\t0\n\
         ANALOG_FREQUENCY\t0\nDESCRIPTION\t--\nDATA_INCLUDED\t3D\nMARKER_NAMES\t{}\nFrame\tTime",
        take.frames(),
        take.marker_count(),
        take.rate_hz(),
        names.join("\t"),
    );
    head.extend(names.iter().map(|name| format!("\t{name} X\t{name} Y\t{name} Z")));
    head.push('\n');
    let mut out = head.into_bytes();
    push_rows(&mut out, take, LengthUnit::Millimetre, '\t', |t| {
        format!("{}\t{}", options.first_frame.saturating_add_unsigned(t as u64), time(take, t))
    });
    out
}
