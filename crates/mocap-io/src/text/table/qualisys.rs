use crate::{
    Format, ReadOptions,
    text::{
        TextError,
        grid::{DeclaredFrames, Head, Layout},
        lines::{Line, Lines},
        number,
    },
};

/// Whether a first line opens the header of a Qualisys export.
pub(super) fn is_head(line: Line<'_>) -> bool {
    line.fields(b'\t')
        .first()
        .is_some_and(|key| key.starts_with("NO_OF_") || key == "FREQUENCY" || key == "MARKER_NAMES")
}

/// What the lines `KEY value…` say.
#[derive(Default)]
struct Facts {
    frames: Option<DeclaredFrames>,
    markers: Option<(usize, usize)>,
    rate_hz: Option<f64>,
    names: Vec<String>,
    kinds: Vec<String>,
}

/// Reads the header of a Qualisys export.
pub(super) fn head(bytes: &[u8], format: Format, options: &ReadOptions) -> Result<Head, TextError> {
    let mut lines = Lines::new(bytes)?;
    let mut facts = Facts::default();
    let mut columns = None;
    let lead = loop {
        let mut ahead = lines.clone();
        let line = ahead.need("the first frame")?;
        if line.text.trim_ascii_start().is_empty() && !line.text.contains(&b'\t') {
            lines = ahead;
            continue;
        }
        let fields = line.fields(b'\t');
        let first = fields.first().map(String::as_str).unwrap_or_default();
        if number::parse(first.as_bytes()).is_some() {
            break columns.unwrap_or_else(|| lead_of_row(&fields, facts.names.len()));
        }
        lines = ahead;
        if matches!(first.to_ascii_lowercase().as_str(), "frame" | "time") {
            columns = Some(fields.iter().take_while(|f| is_lead(f)).count());
            break columns.unwrap_or(0);
        }
        facts.take(line, fields)?;
    };
    let mut notes = facts.notes();
    facts.check_markers(options, lines.number(), &mut notes)?;
    let count = facts.names.len();
    Ok(Head {
        format,
        layout: Layout {
            delimiter: b'\t',
            width: lead + 3 * count,
            frame: (lead == 2).then_some(0),
            time: (lead == 2).then_some(1),
            markers: (0..count).map(|m| [0, 1, 2].map(|axis| lead + 3 * m + axis)).collect(),
        },
        labels: facts.names,
        body: lines.offset(),
        line: lines.number(),
        frames: facts.frames,
        rate_hz: facts.rate_hz,
        unit: None,
        assumed_unit: "the file names no unit of length; Qualisys writes millimetres",
        other_points: Vec::new(),
        notes,
    })
}

fn is_lead(field: &str) -> bool {
    field.eq_ignore_ascii_case("frame") || field.eq_ignore_ascii_case("time")
}

/// Fields before the first marker in a file without a line of column names.
fn lead_of_row(fields: &[String], markers: usize) -> usize {
    let surplus = fields.len().saturating_sub(3 * markers);
    let ends_blank = fields.last().is_some_and(String::is_empty);
    if ends_blank { surplus.saturating_sub(1) } else { surplus }
}

impl Facts {
    fn take(&mut self, line: Line<'_>, fields: Vec<String>) -> Result<(), TextError> {
        let value = fields.get(1).map(String::as_bytes).unwrap_or_default();
        let number = line.number;
        match fields[0].as_str() {
            "NO_OF_FRAMES" => {
                let count = number::count(value, number, 2)?;
                self.frames = Some(DeclaredFrames { line: number, count });
            }
            "NO_OF_MARKERS" => self.markers = Some((number, number::count(value, number, 2)?)),
            "FREQUENCY" => self.rate_hz = Some(number::finite(value, number, 2)?),
            "DATA_INCLUDED" if value != b"3D" => {
                return Err(line.error("only exports of 3D data hold markers; export with 3D"));
            }
            "MARKER_NAMES" => self.names = without_end(fields),
            "TRAJECTORY_TYPES" => self.kinds = without_end(fields),
            _ => {}
        }
        Ok(())
    }

    fn check_markers(
        &self,
        options: &ReadOptions,
        last_line: usize,
        notes: &mut Vec<String>,
    ) -> Result<(), TextError> {
        let found = self.names.len();
        if found == 0 {
            return Err(TextError::NoMarkers { line: last_line });
        }
        let Some((line, declared)) = self.markers.filter(|&(_, declared)| declared != found) else {
            return Ok(());
        };
        let error = TextError::Count { line, what: "markers", declared, found };
        if !options.salvage {
            return Err(error);
        }
        notes.push(format!("salvaged: {error}"));
        Ok(())
    }

    /// Trajectories that Qualisys itself has filled or edited.
    fn notes(&self) -> Vec<String> {
        let named = self.names.iter().zip(&self.kinds);
        let changed: Vec<String> = named
            .filter(|(_, kind)| !kind.eq_ignore_ascii_case("Measured") && !kind.is_empty())
            .map(|(name, kind)| format!("{name} ({kind})"))
            .collect();
        if changed.is_empty() {
            return Vec::new();
        }
        vec![format!("not measured alone, by the file: {}", changed.join(", "))]
    }
}

/// The values of a line, without its key and without blanks at its end.
fn without_end(mut fields: Vec<String>) -> Vec<String> {
    while fields.last().is_some_and(String::is_empty) {
        fields.pop();
    }
    fields.drain(..1.min(fields.len()));
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leading_columns_are_counted_from_the_end() {
        let row = |text: &str| text.split('\t').map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(lead_of_row(&row("1\t0.0\t1\t2\t3"), 1), 2);
        assert_eq!(lead_of_row(&row("1\t2\t3\t"), 1), 0);
        assert_eq!(lead_of_row(&row("1\t2\t3"), 1), 0);
    }
}
