//! TRC, marker trajectories as `OpenSim` reads them.
//!
//! The reader also takes what `OpenSim` refuses: keys in another order or case, a header row with
//! doubled tabs, no blank line after the header; the notes say so. The writer keeps to `OpenSim`'s rules.

use mocap_core::Take;

use super::{
    EncodeOptions, Parsed, TextError,
    grid::{self, DeclaredFrames, Head, Layout},
    lines::{Line, Lines},
    number,
    write::{plain_name, push_rows, time},
};
use crate::{Format, LengthUnit, ReadOptions};

/// The keys of the second line, in the order that `OpenSim` insists on.
const KEYS: [&str; 8] = [
    "DataRate",
    "CameraRate",
    "NumFrames",
    "NumMarkers",
    "Units",
    "OrigDataRate",
    "OrigDataStartFrame",
    "OrigNumFrames",
];

/// Reads a TRC file.
///
/// # Errors
/// [`TextError`], with the line; a file whose counts differ from its header unless
/// [`ReadOptions::salvage`].
///
/// ```
/// use mocap_io::{ReadOptions, text::trc};
/// let file = "PathFileType\t4\t(X/Y/Z)\ta.trc\n\
///     DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
///     100\t100\t2\t1\tmm\t100\t1\t2\n\
///     Frame#\tTime\tC7\t\t\n\
///     \t\tX1\tY1\tZ1\n\
///     \n\
///     1\t0.00\t10\t20\t30\n\
///     2\t0.01\t\t\t\n";
/// let parsed = trc::read(file.into(), &ReadOptions::default())?;
/// assert_eq!(parsed.take.position(0, 0), Some([0.010, 0.020, 0.030]));
/// assert_eq!(parsed.take.position(1, 0), None);
/// # Ok::<(), mocap_io::text::TextError>(())
/// ```
pub fn read(bytes: Vec<u8>, options: &ReadOptions) -> Result<Parsed, TextError> {
    let head = head(&bytes, options)?;
    grid::read(bytes, head, options)
}

fn head(bytes: &[u8], options: &ReadOptions) -> Result<Head, TextError> {
    let mut lines = Lines::new(bytes)?;
    let first = lines.need("the line `PathFileType`")?;
    if !first.text.trim_ascii().to_ascii_lowercase().starts_with(b"pathfiletype") {
        return Err(first.error("a TRC file starts with `PathFileType`"));
    }
    let facts = Facts::read(
        lines.need("the names of the header's values")?,
        lines.need("the header's values")?,
    )?;
    let names = lines.need("the marker names")?;
    let labels = labels(names)?;
    let mut notes = facts.notes();
    let declared = facts.count("NumMarkers")?;
    if declared != labels.len() {
        let (line, found) = (facts.line, labels.len());
        let error = TextError::Count { line, what: "markers", declared, found };
        if !options.salvage {
            return Err(error);
        }
        notes.push(format!("salvaged: {error}"));
    }
    skip_axes(&mut lines);
    let frames = DeclaredFrames { line: facts.line, count: facts.count("NumFrames")? };
    let rate_hz = Some(facts.rate()?);
    let unit = Some(facts.unit()?);
    if let Some(original) = facts.get("OrigNumFrames").filter(|o| o.parse() != Ok(frames.count)) {
        notes.push(format!("OrigNumFrames is {original}, NumFrames {}", frames.count));
    }
    Ok(Head {
        format: Format::Trc,
        layout: Layout {
            delimiter: b'\t',
            width: 2 + 3 * labels.len(),
            frame: Some(0),
            time: Some(1),
            markers: (0..labels.len()).map(|m| [2 + 3 * m, 3 + 3 * m, 4 + 3 * m]).collect(),
        },
        labels,
        body: lines.offset(),
        line: lines.number(),
        frames: Some(frames),
        rate_hz,
        unit,
        assumed_unit: "",
        other_points: Vec::new(),
        notes,
    })
}

/// The names after `Frame#` and `Time`; tabs between them come in any number.
fn labels(line: Line<'_>) -> Result<Vec<String>, TextError> {
    let words = line.words();
    let is = |at: usize, word: &str| {
        words.get(at).is_some_and(|w| w.to_ascii_lowercase().starts_with(word))
    };
    if !(is(0, "frame") && is(1, "time")) {
        return Err(line.error("the fourth line names the columns: `Frame#`, `Time`, the markers"));
    }
    if words.len() == 2 {
        return Err(TextError::NoMarkers { line: line.number });
    }
    Ok(words[2..].to_vec())
}

/// Passes the line `X1 Y1 Z1 …`, if there is one.
fn skip_axes(lines: &mut Lines<'_>) {
    let mut ahead = lines.clone();
    let is_axes = |line: Line<'_>| {
        line.text.trim_ascii().first().is_some_and(|b| b.eq_ignore_ascii_case(&b'x'))
    };
    if ahead.next().is_some_and(is_axes) {
        *lines = ahead;
    }
}

/// The second and third line: keys and their values.
struct Facts {
    keys: Vec<String>,
    values: Vec<String>,
    /// Line of the values.
    line: usize,
}

impl Facts {
    fn read(keys: Line<'_>, values: Line<'_>) -> Result<Self, TextError> {
        let facts = Self { keys: keys.words(), values: values.words(), line: values.number };
        match ["DataRate", "NumFrames", "NumMarkers", "Units"]
            .iter()
            .find(|k| facts.at(k).is_none())
        {
            Some(_) => {
                Err(keys.error("the second line names DataRate, NumFrames, NumMarkers, Units"))
            }
            None if facts.values.len() < facts.keys.len() => Err(TextError::Width {
                line: facts.line,
                expected: facts.keys.len(),
                found: facts.values.len(),
            }),
            None => Ok(facts),
        }
    }

    fn at(&self, key: &str) -> Option<usize> {
        self.keys.iter().position(|k| k.eq_ignore_ascii_case(key))
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.at(key).map(|at| self.values[at].as_str())
    }

    /// Value of a key that `read` made sure of, and its field.
    fn value(&self, key: &str) -> (&str, usize) {
        self.at(key).map_or(("", 0), |at| (self.values[at].as_str(), at + 1))
    }

    fn count(&self, key: &str) -> Result<usize, TextError> {
        let (text, field) = self.value(key);
        number::count(text.as_bytes(), self.line, field)
    }

    fn rate(&self) -> Result<f64, TextError> {
        let (text, field) = self.value("DataRate");
        number::finite(text.as_bytes(), self.line, field)
    }

    fn unit(&self) -> Result<LengthUnit, TextError> {
        let (text, field) = self.value("Units");
        LengthUnit::parse(text).ok_or_else(|| TextError::Field {
            line: self.line,
            field,
            text: super::lines::shorten(text.as_bytes()),
            rule: "is no unit of length; known are mm, cm, dm, m, in, ft",
        })
    }

    fn notes(&self) -> Vec<String> {
        let keys = self.keys.iter().map(String::as_str);
        if keys.eq(KEYS) {
            return Vec::new();
        }
        vec![format!("OpenSim refuses this header: its second line should be `{}`", KEYS.join(" "))]
    }
}

/// Writes a take as a TRC file by `OpenSim`'s rules; missing samples are empty fields.
#[must_use]
pub fn encode(take: &Take, options: &EncodeOptions) -> Vec<u8> {
    let (rate, frames, markers) = (take.rate_hz(), take.frames(), take.marker_count());
    let (unit, start) = (options.unit.symbol(), options.first_frame);
    let mut head = format!(
        "PathFileType\t4\t(X/Y/Z)\tmarkers.trc\n{}\n\
         {rate}\t{rate}\t{frames}\t{markers}\t{unit}\t{rate}\t{start}\t{frames}\nFrame#\tTime",
        KEYS.join("\t")
    );
    let names = take.markers().names();
    head.extend(names.iter().map(|name| format!("\t{}\t\t", plain_name(name))));
    head.push_str("\n\t");
    head.extend((1..=markers).map(|m| format!("\tX{m}\tY{m}\tZ{m}")));
    head.push_str("\n\n");
    let mut out = head.into_bytes();
    push_rows(&mut out, take, options.unit, '\t', |t| {
        format!("{}\t{}", start.saturating_add_unsigned(t as u64), time(take, t))
    });
    out
}
