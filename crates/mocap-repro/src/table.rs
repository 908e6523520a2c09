/// One entry of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// Words.
    Text(String),
    /// A count.
    Count(usize),
    /// A number of any size, shown with three digits and an exponent.
    Scientific(Option<f64>),
    /// A number, and the decimals that are shown.
    Fixed(Option<f64>, usize),
}

impl Entry {
    pub(crate) fn text(text: impl ToString) -> Self {
        Self::Text(text.to_string())
    }

    /// For people: rounded, an en dash for nothing.
    fn shown(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Count(count) => count.to_string(),
            Self::Scientific(Some(value)) => format!("{value:.2e}"),
            Self::Fixed(Some(value), decimals) => format!("{value:.decimals$}"),
            Self::Scientific(None) | Self::Fixed(None, _) => "\u{2013}".to_owned(),
        }
    }

    /// For programs: every digit, and nothing for nothing.
    fn field(&self) -> String {
        match self {
            Self::Text(text) if text.contains(['"', ',', '\n', '\r']) => {
                format!("\"{}\"", text.replace('"', "\"\""))
            }
            Self::Text(text) => text.clone(),
            Self::Count(count) => count.to_string(),
            Self::Scientific(value) | Self::Fixed(value, _) => {
                value.map(|value| value.to_string()).unwrap_or_default()
            }
        }
    }

    fn is_text(&self) -> bool {
        matches!(self, Self::Text(_))
    }
}

/// Rows under named columns, for a document, a program or a web page.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// File name without its ending.
    pub id: &'static str,
    /// Heading.
    pub title: String,
    /// What the reader has to know of it.
    pub note: String,
    /// Column names.
    pub columns: Vec<String>,
    /// Rows, each as long as `columns`.
    pub rows: Vec<Vec<Entry>>,
}

impl Table {
    pub(crate) fn new(id: &'static str, title: &str, note: &str, columns: &[&str]) -> Self {
        Self {
            id,
            title: title.to_owned(),
            note: note.to_owned(),
            columns: columns.iter().map(|column| (*column).to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// A section in Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let line = |cells: &mut dyn Iterator<Item = String>| {
            format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
        };
        let rule = |c| if self.is_text_column(c) { "---" } else { "---:" }.to_owned();
        let mut text = ["## ", &self.title, "\n\n"].concat();
        if !self.note.is_empty() {
            text += &[self.note.as_str(), "\n\n"].concat();
        }
        text += &line(&mut self.columns.iter().cloned());
        text += &line(&mut (0..self.columns.len()).map(rule));
        for row in &self.rows {
            text += &line(&mut row.iter().map(|entry| entry.shown().replace('|', "\\|")));
        }
        text
    }

    /// Comma-separated values after RFC 4180, with every digit and `\n` line ends.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let header: Vec<String> = self.columns.iter().map(|c| c.replace(' ', "_")).collect();
        let mut text = header.join(",") + "\n";
        for row in &self.rows {
            text += &row.iter().map(Entry::field).collect::<Vec<_>>().join(",");
            text.push('\n');
        }
        text
    }

    /// A section of a web page.
    #[must_use]
    pub fn to_html(&self) -> String {
        let class = |c| if self.is_text_column(c) { "" } else { " class=\"n\"" };
        let cells = |tag: &str, texts: &mut dyn Iterator<Item = String>| -> String {
            let cell = |(c, text): (usize, String)| {
                format!("<{tag}{}>{}</{tag}>", class(c), escape(&text))
            };
            texts.enumerate().map(cell).collect()
        };
        let mut text = format!("<h2>{}</h2>\n", escape(&self.title));
        if !self.note.is_empty() {
            text += &["<p>", &escape(&self.note), "</p>\n"].concat();
        }
        let head = cells("th", &mut self.columns.iter().cloned());
        text += &["<table>\n<thead><tr>", &head, "</tr></thead>\n<tbody>\n"].concat();
        for row in &self.rows {
            let cells = cells("td", &mut row.iter().map(Entry::shown));
            text += &["<tr>", &cells, "</tr>\n"].concat();
        }
        text + "</tbody>\n</table>\n"
    }

    fn is_text_column(&self, column: usize) -> bool {
        self.rows.iter().all(|row| row.get(column).is_some_and(Entry::is_text))
    }
}

/// The text with the characters that mean something to HTML written out.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}
