use crate::{
    Format, LengthUnit, ReadOptions,
    text::{
        TextError,
        grid::{DeclaredFrames, Head, Layout},
        lines::{Line, Lines, shorten},
        names, number,
    },
};

/// Whether a first line opens the header of a Motive export.
pub(super) fn is_head(line: Line<'_>) -> bool {
    line.fields(b',').first().is_some_and(|key| key.eq_ignore_ascii_case("Format Version"))
}

/// Header lines are at most this many; a file of anything else is not read to its end for one.
const MOST_HEADER_LINES: usize = 20;

/// The rows that say what each column is.
#[derive(Default)]
struct Rows {
    kinds: Vec<String>,
    names: Vec<String>,
    /// `Position`, `Rotation`, `Mean Marker Error`, …
    quantities: Vec<String>,
}

/// Reads the header of a Motive export.
pub(super) fn head(
    bytes: &[u8],
    format: Format,
    _options: &ReadOptions,
) -> Result<Head, TextError> {
    let mut lines = Lines::new(bytes)?;
    let settings = Settings::of(lines.need("the settings")?);
    let mut rows = Rows::default();
    let axes = loop {
        let line = lines.need("the row `Frame,Time (Seconds),X,Y,Z,…`")?;
        let fields = line.fields(b',');
        if fields[0].eq_ignore_ascii_case("Frame") {
            break fields;
        }
        if line.number > MOST_HEADER_LINES {
            return Err(line.error("a Motive header ends with the row `Frame,Time (Seconds),X,…`"));
        }
        rows.take(fields);
    };
    let line = lines.number();
    let others = rows.others();
    let markers = match names::triples(rows.coordinates(&axes), line) {
        Err(TextError::NoMarkers { .. }) if !others.is_empty() => {
            return Err(TextError::Line {
                line,
                text: shorten(others[0].1.as_bytes()),
                rule: "there is no column of the type `Marker`; export with markers switched on",
            });
        }
        other => other?,
    };
    Ok(Head {
        format,
        layout: Layout {
            delimiter: b',',
            width: axes.iter().rposition(|f| !f.is_empty()).map_or(0, |last| last + 1),
            frame: Some(0),
            time: axes.get(1).is_some_and(|f| f.to_lowercase().starts_with("time")).then_some(1),
            markers: markers.iter().map(|m| m.columns).collect(),
        },
        labels: markers.into_iter().map(|m| m.label).collect(),
        body: lines.offset(),
        line,
        frames: settings.frames()?,
        rate_hz: settings.rate_hz()?,
        unit: settings.unit()?,
        assumed_unit: "the file names no unit of length; millimetres are assumed",
        other_points: others,
        notes: Vec::new(),
    })
}

impl Rows {
    fn take(&mut self, fields: Vec<String>) {
        match fields.get(1).map(|f| f.to_lowercase()).as_deref() {
            Some("type") => self.kinds = fields,
            Some("name") => self.names = fields,
            Some("") if !self.kinds.is_empty() => self.quantities = fields,
            _ => {}
        }
    }

    fn is(row: &[String], column: usize, word: &str) -> bool {
        row.get(column).is_some_and(|f| f.eq_ignore_ascii_case(word))
    }

    /// The coordinates of measured markers: name, axis, column.
    fn coordinates(&self, axes: &[String]) -> Vec<(String, usize, usize)> {
        let axis = |text: &str| ["X", "Y", "Z"].iter().position(|a| text.eq_ignore_ascii_case(a));
        let name = |column: usize| self.names.get(column).cloned().unwrap_or_default();
        (2..axes.len())
            .filter(|&c| Self::is(&self.kinds, c, "Marker"))
            .filter(|&c| self.quantities.is_empty() || Self::is(&self.quantities, c, "Position"))
            .filter_map(|c| Some((name(c), axis(&axes[c])?, c)))
            .collect()
    }

    /// Everything else, with its type, each once.
    fn others(&self) -> Vec<(String, String)> {
        let mut others: Vec<(String, String)> = Vec::new();
        for (kind, name) in self.kinds.iter().zip(&self.names).skip(2) {
            let other = (name.clone(), kind.clone());
            // Columns of one thing stand side by side.
            let is_new = others.last() != Some(&other);
            if is_new && !kind.is_empty() && !kind.eq_ignore_ascii_case("Marker") {
                others.push(other);
            }
        }
        others
    }
}

/// The first line: names and values in turn.
struct Settings {
    fields: Vec<String>,
    line: usize,
}

impl Settings {
    fn of(line: Line<'_>) -> Self {
        Self { fields: line.fields(b','), line: line.number }
    }

    /// Value of a setting and its field.
    fn get(&self, key: &str) -> Option<(&str, usize)> {
        let pairs = self.fields.chunks_exact(2).enumerate();
        let mut found = pairs.filter(|(_, pair)| pair[0].eq_ignore_ascii_case(key));
        found.next().map(|(at, pair)| (pair[1].as_str(), 2 * at + 2))
    }

    fn frames(&self) -> Result<Option<DeclaredFrames>, TextError> {
        let declared = self.get("Total Exported Frames");
        let read = |(text, field): (&str, usize)| {
            let count = number::count(text.as_bytes(), self.line, field)?;
            Ok(DeclaredFrames { line: self.line, count })
        };
        declared.map(read).transpose()
    }

    fn rate_hz(&self) -> Result<Option<f64>, TextError> {
        let declared = self.get("Export Frame Rate").or_else(|| self.get("Capture Frame Rate"));
        declared.map(|(text, field)| number::finite(text.as_bytes(), self.line, field)).transpose()
    }

    fn unit(&self) -> Result<Option<LengthUnit>, TextError> {
        let Some((text, field)) = self.get("Length Units") else { return Ok(None) };
        let unknown = || TextError::Field {
            line: self.line,
            field,
            text: shorten(text.as_bytes()),
            rule: "is no unit of length; known are Meters, Centimeters, Millimeters, Inches, Feet",
        };
        LengthUnit::parse(text).map(Some).ok_or_else(unknown)
    }
}
