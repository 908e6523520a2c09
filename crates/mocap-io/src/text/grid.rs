use std::ops::Range;

use mocap_core::{MarkerSet, Take};
use ndarray::Array3;

use super::{
    Parsed, TextError,
    lines::{Lines, shorten, split},
    names,
    number::{self, Value},
    rate::{self, RateSources},
};
use crate::{FileInfo, Format, LengthUnit, MissingMarks, ReadOptions};

mod patch;

/// Which field of a row holds what.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub delimiter: u8,
    /// Fields of a row; more are allowed if they are blank.
    pub width: usize,
    pub frame: Option<usize>,
    pub time: Option<usize>,
    /// Fields of x, y and z, one entry a marker.
    pub markers: Vec<[usize; 3]>,
}

/// A number of frames that a header declares.
pub(super) struct DeclaredFrames {
    pub line: usize,
    pub count: usize,
}

/// All that stands before the first row.
pub(super) struct Head {
    pub format: Format,
    pub layout: Layout,
    pub labels: Vec<String>,
    /// Offset of the first byte after the header.
    pub body: usize,
    /// Number of the header's last line.
    pub line: usize,
    pub frames: Option<DeclaredFrames>,
    pub rate_hz: Option<f64>,
    pub unit: Option<LengthUnit>,
    /// What to note where the file names no unit and the caller neither.
    pub assumed_unit: &'static str,
    pub other_points: Vec<(String, String)>,
    pub notes: Vec<String>,
}

/// A table whose samples can be patched.
pub(super) struct Grid {
    bytes: Vec<u8>,
    rows: Vec<Range<usize>>,
    layout: Layout,
    unit: LengthUnit,
}

/// What the rows hold.
struct Body {
    /// `(T, M, 3)` in metres, NaN where missing.
    positions: Vec<f64>,
    times: Vec<f64>,
    time_error: f64,
    first_frame: i64,
    missing: MissingMarks,
}

/// Reads the rows below a header.
pub(super) fn read(bytes: Vec<u8>, head: Head, options: &ReadOptions) -> Result<Parsed, TextError> {
    let mut info = FileInfo::new(head.format, storage(&bytes, head.layout.delimiter));
    info.notes = head.notes;
    info.other_points = head.other_points;
    info.unit_declared = head.unit.is_some();
    info.unit = head.unit.or(options.unit).unwrap_or_else(|| {
        info.notes.push(head.assumed_unit.to_owned());
        LengthUnit::Millimetre
    });
    let mut rows = rows(&bytes, head.body, head.line, head.layout.frame.is_some());
    let reader = RowReader { bytes: &bytes, layout: &head.layout, unit: info.unit, options };
    let body = reader.read(&mut rows, &mut info.notes)?;
    if rows.spans.is_empty() {
        return Err(TextError::NoFrames { line: head.line });
    }
    check_frames(head.frames.as_ref(), rows.spans.len(), options, &mut info.notes)?;
    info.first_frame = body.first_frame;
    info.missing = body.missing;
    let sources =
        RateSources { header: head.rate_hz, times: &body.times, time_error: body.time_error };
    let rate = rate::settle(&sources, options, &mut info.notes);
    info.rate_declared = rate.is_declared;
    note_line_end(&bytes, &mut info.notes);
    let labels = names::unique(head.labels, "marker", &mut info.notes);
    let shape = (rows.spans.len(), labels.len(), 3);
    let positions = Array3::from_shape_vec(shape, body.positions)
        .map_err(|_| TextError::NoFrames { line: head.line })?;
    let take = Take::from_positions(MarkerSet::new(labels)?, rate.hz, positions)?;
    let document = Grid { bytes, rows: rows.spans, layout: head.layout, unit: info.unit };
    Ok(Parsed { take, info, document: Box::new(document) })
}

fn storage(bytes: &[u8], delimiter: u8) -> String {
    let separator = match delimiter {
        b'\t' => "tabs",
        b',' => "commas",
        b';' => "semicolons",
        _ => "blanks",
    };
    let first_end = bytes.iter().position(|&b| b == b'\n').unwrap_or(0);
    let ends = if bytes[..first_end].ends_with(b"\r") { "CR LF" } else { "LF" };
    format!("text, fields between {separator}, lines end with {ends}")
}

/// A file that was cut inside its last number looks whole but for this.
pub(super) fn note_line_end(bytes: &[u8], notes: &mut Vec<String>) {
    if !bytes.ends_with(b"\n") {
        notes.push("the last line has no line end; if the file was cut, its last number may be short or missing".into());
    }
}

fn check_frames(
    declared: Option<&DeclaredFrames>,
    found: usize,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Result<(), TextError> {
    let Some(&DeclaredFrames { line, count: declared }) = declared else { return Ok(()) };
    if declared == found {
        return Ok(());
    }
    let error = TextError::Count { line, what: "frames", declared, found };
    if !options.salvage {
        return Err(error);
    }
    notes.push(format!("salvaged: {error}"));
    Ok(())
}

struct Rows {
    spans: Vec<Range<usize>>,
    /// Line number of the first row.
    line: usize,
}

/// The rows without their line ends. Blank lines at the end are dropped; where rows are numbered,
/// a line without any field is blank too, and such lines before the first row are dropped.
fn rows(bytes: &[u8], offset: usize, line: usize, are_numbered: bool) -> Rows {
    let is_blank = |text: &[u8]| {
        text.iter().all(|b| *b == b' ' || (are_numbered && matches!(b, b'\t' | b',' | b';')))
    };
    let mut rows = Rows { spans: Vec::new(), line: line + 1 };
    let mut kept = 0;
    for line in Lines::resume(bytes, offset, line) {
        let blank = is_blank(line.text);
        if blank && kept == 0 && are_numbered {
            rows.line = line.number + 1;
            continue;
        }
        rows.spans.push(line.start..line.start + line.text.len());
        if !blank {
            kept = rows.spans.len();
        }
    }
    rows.spans.truncate(kept);
    rows
}

struct RowReader<'a> {
    bytes: &'a [u8],
    layout: &'a Layout,
    unit: LengthUnit,
    options: &'a ReadOptions,
}

impl RowReader<'_> {
    /// Reads all rows; with salvage, a damaged last row is dropped.
    fn read(&self, rows: &mut Rows, notes: &mut Vec<String>) -> Result<Body, TextError> {
        let mut body = Body {
            positions: Vec::new(),
            times: Vec::new(),
            time_error: 0.5,
            first_frame: 1,
            missing: MissingMarks::default(),
        };
        let (mut fields, mut partial, mut jump) = (Vec::new(), 0_usize, None);
        for row in 0..rows.spans.len() {
            let text = &self.bytes[rows.spans[row].clone()];
            let line = rows.line + row;
            split(text, self.layout.delimiter, &mut fields);
            let done = self.read_row(text, &fields, line, &mut body, &mut partial);
            let frame = match done {
                Ok(frame) => frame,
                Err(error) if self.options.salvage && row + 1 == rows.spans.len() => {
                    notes.push(format!("salvaged: the last line is dropped: {error}"));
                    body.positions.truncate(row * self.layout.markers.len() * 3);
                    body.times.truncate(row);
                    rows.spans.truncate(row);
                    break;
                }
                Err(error) => return Err(error),
            };
            if let Some(frame) = frame {
                if row == 0 {
                    body.first_frame = frame;
                }
                let expected = body.first_frame.saturating_add_unsigned(row as u64);
                if frame != expected {
                    jump.get_or_insert((line, expected, frame));
                }
            }
        }
        if let Some((line, expected, found)) = jump {
            notes.push(format!(
                "line {line} is frame {found} where {expected} should come; frames may be lost"
            ));
        }
        if partial > 0 {
            notes.push(format!(
                "{partial} samples have some coordinates but not all; they count as missing"
            ));
        }
        Ok(body)
    }

    fn read_row(
        &self,
        text: &[u8],
        fields: &[Range<usize>],
        line: usize,
        body: &mut Body,
        partial: &mut usize,
    ) -> Result<Option<i64>, TextError> {
        let width = self.layout.width;
        let surplus = fields.iter().skip(width).any(|f| !text[f.clone()].trim_ascii().is_empty());
        if fields.len() < width || surplus {
            return Err(TextError::Width { line, expected: width, found: fields.len() });
        }
        let field = |column: usize| &text[fields[column].clone()];
        let frame = self.layout.frame.map(|c| number::whole(field(c), line, c + 1)).transpose()?;
        if let Some(column) = self.layout.time {
            Self::read_time(field(column), line, column, body)?;
        }
        for columns in &self.layout.markers {
            let mut xyz = [Value::Blank; 3];
            for (value, &column) in xyz.iter_mut().zip(columns) {
                *value = number::parse(field(column)).ok_or_else(|| TextError::Field {
                    line,
                    field: column + 1,
                    text: shorten(field(column)),
                    rule: "is not a number; a missing coordinate is an empty field",
                })?;
            }
            body.positions.extend(self.sample(xyz, &mut body.missing, partial));
        }
        Ok(frame)
    }

    fn read_time(
        field: &[u8],
        line: usize,
        column: usize,
        body: &mut Body,
    ) -> Result<(), TextError> {
        let time = match number::parse(field) {
            Some(Value::Number(time)) => time,
            Some(_) => f64::NAN,
            None => {
                let (text, rule) = (shorten(field), "is not a time in seconds");
                return Err(TextError::Field { line, field: column + 1, text, rule });
            }
        };
        // Programs that drop zeros at the end show their digits in some of the times only.
        let error = number::half_digit(&String::from_utf8_lossy(field));
        body.time_error = body.time_error.min(error);
        body.times.push(time);
        Ok(())
    }

    /// The position in metres, or NaN with the reason counted.
    fn sample(&self, xyz: [Value; 3], missing: &mut MissingMarks, partial: &mut usize) -> [f64; 3] {
        const NOTHING: [f64; 3] = [f64::NAN; 3];
        if let [Value::Number(x), Value::Number(y), Value::Number(z)] = xyz {
            let is_zero = x == 0.0 && y == 0.0 && z == 0.0;
            if is_zero && !self.options.zero_is_position {
                missing.exact_zero += 1;
                return NOTHING;
            }
            return [x, y, z].map(|c| c * self.unit.metres());
        }
        if xyz.contains(&Value::NotANumber) {
            missing.not_a_number += 1;
        } else {
            missing.blank += 1;
        }
        *partial += usize::from(xyz.iter().any(|v| matches!(v, Value::Number(_))));
        NOTHING
    }
}
