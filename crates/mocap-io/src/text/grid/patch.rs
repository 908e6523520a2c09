use std::{collections::BTreeMap, ops::Range};

use super::Grid;
use crate::{
    Edit, Sample,
    text::{Document, TextError, lines::split, number},
};

impl Document for Grid {
    fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    fn patch(&self, edits: &[Edit]) -> Result<Vec<u8>, TextError> {
        let mut by_row: BTreeMap<usize, Vec<&Edit>> = BTreeMap::new();
        for edit in edits {
            self.check(edit)?;
            by_row.entry(edit.frame).or_default().push(edit);
        }
        let mut out = Vec::with_capacity(self.bytes.len() + 16 * edits.len());
        let mut copied = 0;
        for (row, edits) in by_row {
            for (start, (end, text)) in self.replacements(row, &edits)? {
                out.extend_from_slice(&self.bytes[copied..start]);
                out.extend_from_slice(text.as_bytes());
                copied = end;
            }
        }
        out.extend_from_slice(&self.bytes[copied..]);
        Ok(out)
    }
}

impl Grid {
    fn check(&self, edit: &Edit) -> Result<(), TextError> {
        let &Edit { frame, marker, .. } = edit;
        let (frames, markers) = (self.rows.len(), self.layout.markers.len());
        if frame >= frames || marker >= markers {
            return Err(TextError::OutOfRange { frame, marker, frames, markers });
        }
        Ok(())
    }

    /// New text of the changed fields of a row: first byte, end, text.
    fn replacements(
        &self,
        row: usize,
        edits: &[&Edit],
    ) -> Result<BTreeMap<usize, (usize, String)>, TextError> {
        let span = self.rows[row].clone();
        let text = &self.bytes[span.clone()];
        let mut fields = Vec::new();
        split(text, self.layout.delimiter, &mut fields);
        let mut replacements = BTreeMap::new();
        for edit in edits {
            let texts = match edit.sample {
                Sample::Missing => Default::default(),
                Sample::Filled(metres) => number::position(metres, self.unit)
                    .ok_or(TextError::NotFinite { frame: edit.frame, marker: edit.marker })?,
            };
            for (column, new) in self.layout.markers[edit.marker].into_iter().zip(texts) {
                let content = content(text, fields[column].clone());
                let (start, end) = (span.start + content.start, span.start + content.end);
                replacements.insert(start, (end, new));
            }
        }
        Ok(replacements)
    }
}

/// A field without the blanks around it; the end of a field that has nothing else.
fn content(text: &[u8], field: Range<usize>) -> Range<usize> {
    let bytes = &text[field.clone()];
    let start = field.start + (bytes.len() - bytes.trim_ascii_start().len());
    start..start + bytes.trim_ascii().len()
}
