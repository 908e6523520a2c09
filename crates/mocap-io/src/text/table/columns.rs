use crate::{
    Format, LengthUnit,
    text::{
        TextError,
        grid::{Head, Layout},
        lines::{Line, Lines, shorten},
        names,
        number::{self, Value},
    },
};

/// What a column's name says.
pub(super) enum Column {
    Frame,
    Time,
    Coordinate { marker: String, axis: usize, unit: Option<LengthUnit> },
    Other,
}

impl Column {
    pub fn of(label: &str) -> Self {
        let lower = label.trim().to_lowercase();
        match lower.as_str() {
            "frame" | "frames" | "frame#" | "frame number" => return Self::Frame,
            "time" | "time_s" | "time (s)" | "time(s)" | "time [s]" | "time (seconds)" => {
                return Self::Time;
            }
            _ => {}
        }
        coordinate(label).unwrap_or(Self::Other)
    }
}

/// Splits `NAME-x [unit]`.
fn coordinate(label: &str) -> Option<Column> {
    let (name, unit) = split_unit(label.trim());
    let mut rest = name.chars();
    let axis = match rest.next_back()?.to_ascii_lowercase() {
        'x' => 0,
        'y' => 1,
        'z' => 2,
        _ => return None,
    };
    if !matches!(rest.next_back()?, '-' | '_' | '.' | ' ' | ':') {
        return None;
    }
    let marker = rest.as_str().trim().to_owned();
    (!marker.is_empty()).then_some(Column::Coordinate { marker, axis, unit })
}

fn split_unit(label: &str) -> (&str, Option<LengthUnit>) {
    let inner = label
        .strip_suffix(']')
        .and_then(|l| l.rsplit_once('['))
        .or_else(|| label.strip_suffix(')').and_then(|l| l.rsplit_once('(')));
    match inner.and_then(|(name, unit)| Some((name, LengthUnit::parse(unit)?))) {
        Some((name, unit)) => (name.trim(), Some(unit)),
        None => (label, None),
    }
}

/// Reads the line of column names of a plain table.
pub(super) fn head(bytes: &[u8], format: Format) -> Result<Head, TextError> {
    let mut lines = Lines::new(bytes)?;
    let line = lines.need("the column names")?;
    let delimiter = delimiter(line.text);
    let labels = line.fields(delimiter);
    if labels.iter().all(|label| matches!(number::parse(label.as_bytes()), Some(Value::Number(_))))
    {
        return Err(line.error("the first line has to name the columns: `NAME-x,NAME-y,NAME-z,…`"));
    }
    let (mut frame, mut time, mut unit, mut others) = (None, None, None, Vec::new());
    let mut coordinates = Vec::new();
    for (at, label) in labels.iter().enumerate() {
        match Column::of(label) {
            Column::Frame => frame = frame.or(Some(at)),
            Column::Time => time = time.or(Some(at)),
            Column::Coordinate { marker, axis, unit: its } => {
                if !coordinates.is_empty() && unit != its {
                    return Err(mixed_units(line, at, label));
                }
                unit = its;
                coordinates.push((marker, axis, at));
            }
            Column::Other if label.is_empty() => {}
            Column::Other => others.push(format!("`{label}`")),
        }
    }
    let markers = names::triples(coordinates, line.number)?;
    let mut notes = Vec::new();
    if !others.is_empty() {
        notes.push(format!(
            "columns that are no marker coordinates are kept, not read: {}",
            others.join(", ")
        ));
    }
    Ok(Head {
        format,
        layout: Layout {
            delimiter,
            // A delimiter at the end of the names opens no column.
            width: labels.iter().rposition(|l| !l.is_empty()).map_or(0, |last| last + 1),
            frame,
            time,
            markers: markers.iter().map(|m| m.columns).collect(),
        },
        labels: markers.into_iter().map(|m| m.label).collect(),
        body: lines.offset(),
        line: lines.number(),
        frames: None,
        rate_hz: None,
        unit,
        assumed_unit: "the file names no unit of length; millimetres are assumed",
        other_points: Vec::new(),
        notes,
    })
}

fn mixed_units(line: Line<'_>, at: usize, label: &str) -> TextError {
    TextError::Field {
        line: line.number,
        field: at + 1,
        text: shorten(label.as_bytes()),
        rule: "has another unit than the columns before it",
    }
}

/// The most frequent of comma, tab and semicolon.
fn delimiter(line: &[u8]) -> u8 {
    let count = |d: u8| line.iter().map(|&b| usize::from(b == d)).sum::<usize>();
    let mut best = b',';
    for candidate in [b'\t', b';'] {
        if count(candidate) > count(best) {
            best = candidate;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_every_spelling() {
        for (label, name, at) in [
            ("subject:C7-x", "subject:C7", 0),
            ("C7_Y", "C7", 1),
            ("hand top Z", "hand top", 2),
            ("C7.x", "C7", 0),
            ("A-x-z [mm]", "A-x", 2),
            ("C7:Z(m)", "C7", 2),
        ] {
            let Column::Coordinate { marker, axis, .. } = Column::of(label) else {
                panic!("{label} is a coordinate");
            };
            assert_eq!((marker.as_str(), axis), (name, at), "{label}");
        }
        for label in ["x", "-x", "max", "C7", "", "Force [N]", "é", "C7x"] {
            assert!(matches!(Column::of(label), Column::Other), "{label}");
        }
    }
}
