/// One entry of a table.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Entry {
    /// Words.
    Text(String),
    /// A whole number.
    Integer(i64),
    /// A number, and the decimals that people are shown.
    Number(f64, usize),
    /// A number of any size, shown with three digits and an exponent.
    Scientific(f64),
    /// Nothing to say.
    Empty,
}

impl Entry {
    /// Whatever can be written in words.
    pub fn text(text: impl ToString) -> Self {
        Self::Text(text.to_string())
    }

    /// A number with so many decimals; empty for none, and for what is not finite.
    #[must_use]
    pub fn number(value: Option<f64>, decimals: usize) -> Self {
        value.filter(|v| v.is_finite()).map_or(Self::Empty, |v| Self::Number(v, decimals))
    }

    /// A number with an exponent; empty for none, and for what is not finite.
    #[must_use]
    pub fn scientific(value: Option<f64>) -> Self {
        value.filter(|v| v.is_finite()).map_or(Self::Empty, Self::Scientific)
    }

    /// A count.
    #[must_use]
    pub fn count(value: usize) -> Self {
        Self::Integer(i64::try_from(value).unwrap_or(i64::MAX))
    }

    /// A whole number; empty for none.
    #[must_use]
    pub fn integer(value: Option<i64>) -> Self {
        value.map_or(Self::Empty, Self::Integer)
    }

    /// For people: rounded, and `nothing` for nothing.
    fn shown(&self, nothing: &str) -> String {
        match self {
            Self::Text(text) => crate::draw::printable(text),
            Self::Integer(value) => value.to_string(),
            Self::Number(value, decimals) => format!("{value:.decimals$}"),
            Self::Scientific(value) => format!("{value:.2e}"),
            Self::Empty => nothing.to_owned(),
        }
    }

    /// For programs: every digit, and nothing for nothing.
    fn field(&self) -> String {
        match self {
            Self::Text(text) if text.contains(['"', ',', '\n', '\r']) => {
                format!("\"{}\"", text.replace('"', "\"\""))
            }
            Self::Text(text) => text.clone(),
            Self::Number(value, _) | Self::Scientific(value) => value.to_string(),
            Self::Integer(value) => value.to_string(),
            Self::Empty => String::new(),
        }
    }

    fn is_text(&self) -> bool {
        matches!(self, Self::Text(_))
    }
}

/// Stands for nothing where any character may.
const EN_DASH: &str = "\u{2013}";

/// Rows under named columns, for the terminal, a document, a program or a web page.
///
/// Words stand to the left and numbers to the right. A row that is too short ends in empty entries, and
/// entries beyond the last column are not shown.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<Entry>>,
}

impl Table {
    /// A table without rows.
    #[must_use]
    pub fn new<S: Into<String>>(columns: impl IntoIterator<Item = S>) -> Self {
        Self { columns: columns.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// The same table with these rows.
    #[must_use]
    pub fn with_rows(mut self, rows: impl IntoIterator<Item = Vec<Entry>>) -> Self {
        rows.into_iter().for_each(|row| self.push(row));
        self
    }

    /// Adds a row.
    pub fn push(&mut self, mut row: Vec<Entry>) {
        row.resize(self.columns.len(), Entry::Empty);
        self.rows.push(row);
    }

    /// Keeps only the first rows.
    pub fn truncate(&mut self, rows: usize) {
        self.rows.truncate(rows);
    }

    /// The rows, each as long as there are columns.
    #[must_use]
    pub fn rows(&self) -> &[Vec<Entry>] {
        &self.rows
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Columns padded to line up, for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let shown = self.shown("-");
        let width = |c: usize| {
            let widest = shown.iter().map(|row| row[c].chars().count()).max().unwrap_or(0);
            widest.max(self.columns[c].chars().count())
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let line = |cells: &[String]| {
            let padded: Vec<String> = cells
                .iter()
                .zip(&widths)
                .enumerate()
                .map(|(c, (cell, &width))| {
                    let left = self.is_text_column(c);
                    if left { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
                })
                .collect();
            padded.join("  ").trim_end().to_owned() + "\n"
        };
        std::iter::once(&self.columns).chain(&shown).map(|cells| line(cells)).collect()
    }

    /// A table in Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let line = |cells: &[String]| {
            let escaped: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
            format!("| {} |\n", escaped.join(" | "))
        };
        let rule = |c| if self.is_text_column(c) { "---" } else { "---:" }.to_owned();
        let rule: Vec<String> = (0..self.columns.len()).map(rule).collect();
        let head = [line(&self.columns), line(&rule)];
        head.into_iter().chain(self.shown(EN_DASH).iter().map(|row| line(row))).collect()
    }

    /// Comma-separated values after RFC 4180, with every digit and `\n` line ends.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let name =
            |column: &String| Entry::Text(column.replace(' ', "_").replace('%', "percent")).field();
        let header: Vec<String> = self.columns.iter().map(name).collect();
        let rows = self.rows.iter().map(|row| row.iter().map(Entry::field).collect::<Vec<_>>());
        std::iter::once(header).chain(rows).map(|fields| fields.join(",") + "\n").collect()
    }

    /// A table of a web page; numbers are of the class `n`.
    #[must_use]
    pub fn to_html(&self) -> String {
        let line = |tag: &str, texts: &[String]| -> String {
            let cell = |(c, text): (usize, &String)| {
                let class = if self.is_text_column(c) { "" } else { " class=\"n\"" };
                format!("<{tag}{class}>{}</{tag}>", escape(text))
            };
            let cells: String = texts.iter().enumerate().map(cell).collect();
            format!("<tr>{cells}</tr>")
        };
        let head = line("th", &self.columns);
        let body: String = self.shown(EN_DASH).iter().map(|row| line("td", row) + "\n").collect();
        format!("<table>\n<thead>{head}</thead>\n<tbody>\n{body}</tbody>\n</table>\n")
    }

    fn shown(&self, nothing: &str) -> Vec<Vec<String>> {
        let row = |row: &Vec<Entry>| row.iter().map(|entry| entry.shown(nothing)).collect();
        self.rows.iter().map(row).collect()
    }

    /// A column is text where any of its entries is, and where it has none but empty ones.
    fn is_text_column(&self, column: usize) -> bool {
        let entries = || self.rows.iter().filter_map(|row| row.get(column));
        entries().any(Entry::is_text) || entries().all(|entry| *entry == Entry::Empty)
    }
}

/// The text with the characters that mean something to HTML written out.
#[must_use]
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}
