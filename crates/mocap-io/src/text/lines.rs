use std::ops::Range;

use super::TextError;

/// The lines of a file, with their place in it.
#[derive(Clone)]
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    next: usize,
    number: usize,
}

/// One line without its line end.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    /// Counted from 1.
    pub number: usize,
    /// Offset of its first byte.
    pub start: usize,
    pub text: &'a [u8],
}

impl<'a> Lines<'a> {
    /// Starts at the first line, after a UTF-8 byte order mark.
    pub fn new(bytes: &'a [u8]) -> Result<Self, TextError> {
        if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
            return Err(TextError::Utf16);
        }
        let next = if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
        if bytes[next..].trim_ascii().is_empty() {
            return Err(TextError::Empty);
        }
        Ok(Self { bytes, next, number: 0 })
    }

    /// Goes on at a byte offset, which is the start of the line after line `number`.
    pub fn resume(bytes: &'a [u8], offset: usize, number: usize) -> Self {
        Self { bytes, next: offset, number }
    }

    /// Offset of the next line.
    pub fn offset(&self) -> usize {
        self.next
    }

    /// Number of the line that came last.
    pub fn number(&self) -> usize {
        self.number
    }

    /// The next line, or an error that says what should have come.
    pub fn need(&mut self, what: &'static str) -> Result<Line<'a>, TextError> {
        self.next().ok_or(TextError::Ended { line: self.number, what })
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let rest = self.bytes.get(self.next..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        let start = self.next;
        self.next = (start + length + 1).min(self.bytes.len());
        self.number += 1;
        let text = &rest[..length];
        let text = text.strip_suffix(b"\r").unwrap_or(text);
        Some(Line { number: self.number, start, text })
    }
}

impl Line<'_> {
    /// The error that this line breaks a rule.
    pub fn error(&self, rule: &'static str) -> TextError {
        TextError::Line { line: self.number, text: shorten(self.text), rule }
    }

    /// The fields as trimmed text, without quotes.
    pub fn fields(&self, delimiter: u8) -> Vec<String> {
        let mut ranges = Vec::new();
        split(self.text, delimiter, &mut ranges);
        ranges.into_iter().map(|r| text_of(&self.text[r])).collect()
    }

    /// The non-empty words: between tabs where there are tabs, between blanks otherwise.
    pub fn words(&self) -> Vec<String> {
        if self.text.contains(&b'\t') {
            return self.fields(b'\t').into_iter().filter(|word| !word.is_empty()).collect();
        }
        String::from_utf8_lossy(self.text).split_whitespace().map(str::to_owned).collect()
    }
}

/// Cuts a line at a delimiter into byte ranges; a field that starts with a quote ends with one.
pub(super) fn split(line: &[u8], delimiter: u8, out: &mut Vec<Range<usize>>) {
    out.clear();
    let mut start = 0;
    loop {
        let end = field_end(line, start, delimiter);
        out.push(start..end);
        if end >= line.len() {
            return;
        }
        start = end + 1;
    }
}

fn field_end(line: &[u8], start: usize, delimiter: u8) -> usize {
    let rest = &line[start..];
    let is_quoted = rest.trim_ascii_start().first() == Some(&b'"') && delimiter != b'\t';
    let mut inside = false;
    let end = rest.iter().position(|&b| {
        inside ^= is_quoted && b == b'"';
        b == delimiter && !inside
    });
    start + end.unwrap_or(rest.len())
}

/// Trimmed text of a field, without quotes around it; bytes that are not UTF-8 are replaced.
pub(super) fn text_of(field: &[u8]) -> String {
    let text = String::from_utf8_lossy(field.trim_ascii());
    match text.strip_prefix('"').and_then(|t| t.strip_suffix('"')) {
        Some(inner) => inner.replace("\"\"", "\"").trim().to_owned(),
        None => text.trim().to_owned(),
    }
}

/// The start of a text that goes into a message.
pub(super) fn shorten(text: &[u8]) -> String {
    const SHOWN: usize = 40;
    // Four bytes are the most that a character takes.
    let head = String::from_utf8_lossy(&text[..text.len().min(4 * SHOWN)]);
    let mut shown: String =
        head.trim().chars().take(SHOWN).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.trim_ascii().len() > shown.len() {
        shown.push('…');
    }
    shown
}
