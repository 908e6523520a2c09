use mocap_report::{Entry, Table, escape};

/// A table under a heading.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// File name without its ending.
    pub id: String,
    /// Heading.
    pub title: String,
    /// What the reader has to know of it.
    pub note: String,
    /// The table.
    pub table: Table,
}

impl Section {
    pub(crate) fn new(
        id: &str,
        title: &str,
        note: &str,
        columns: &[&str],
        rows: impl IntoIterator<Item = Vec<Entry>>,
    ) -> Self {
        Self {
            id: id.to_owned(),
            title: title.to_owned(),
            note: note.to_owned(),
            table: Table::new(columns.iter().copied()).with_rows(rows),
        }
    }

    /// In Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let note = if self.note.is_empty() { String::new() } else { format!("{}\n\n", self.note) };
        format!("## {}\n\n{note}{}", self.title, self.table.to_markdown())
    }

    /// For a web page.
    #[must_use]
    pub fn to_html(&self) -> String {
        let note = if self.note.is_empty() { String::new() } else { paragraph(&self.note) };
        format!("<h2>{}</h2>\n{note}{}", escape(&self.title), self.table.to_html())
    }
}

/// A paragraph with its code, between backticks, marked as such.
pub(crate) fn paragraph(text: &str) -> String {
    let parts = text.split('`').enumerate().map(|(i, part)| {
        let part = escape(part);
        if i % 2 == 1 { format!("<code>{part}</code>") } else { part }
    });
    format!("<p>{}</p>\n", parts.collect::<String>())
}
