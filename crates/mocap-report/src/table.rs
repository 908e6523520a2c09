/// One entry of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Entry {
    Text(String),
    Integer(i64),
    /// A number, and the decimals that people are shown.
    Number(f64, usize),
    /// Nothing to say.
    Empty,
}

impl Entry {
    pub(crate) fn number(value: Option<f64>, decimals: usize) -> Self {
        match value {
            Some(value) if value.is_finite() => Self::Number(value, decimals),
            _ => Self::Empty,
        }
    }

    pub(crate) fn count(value: usize) -> Self {
        Self::Integer(i64::try_from(value).unwrap_or(i64::MAX))
    }

    pub(crate) fn integer(value: Option<i64>) -> Self {
        value.map_or(Self::Empty, Self::Integer)
    }

    /// For people: rounded, `-` for nothing.
    fn shown(&self) -> String {
        match self {
            Self::Text(text) => crate::figure::printable(text),
            Self::Integer(value) => value.to_string(),
            Self::Number(value, decimals) => format!("{value:.decimals$}"),
            Self::Empty => "-".to_owned(),
        }
    }

    /// For programs: every digit, and nothing for nothing.
    fn field(&self) -> String {
        match self {
            Self::Text(text) if text.contains(['"', ',', '\n', '\r']) => {
                format!("\"{}\"", text.replace('"', "\"\""))
            }
            Self::Text(text) => text.clone(),
            Self::Number(value, _) => value.to_string(),
            Self::Integer(value) => value.to_string(),
            Self::Empty => String::new(),
        }
    }

    fn is_text(&self) -> bool {
        matches!(self, Self::Text(_))
    }
}

/// Rows under named columns, for the terminal, a CSV file or a web page.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table<const N: usize> {
    pub columns: [&'static str; N],
    pub rows: Vec<[Entry; N]>,
}

impl<const N: usize> Table<N> {
    /// Columns padded to line up: text to the left, numbers to the right.
    pub(crate) fn to_text(&self) -> String {
        let shown: Vec<[String; N]> =
            self.rows.iter().map(|row| std::array::from_fn(|c| row[c].shown())).collect();
        let width = |c: usize| {
            let widest = shown.iter().map(|row| row[c].chars().count()).max().unwrap_or(0);
            widest.max(self.columns[c].chars().count())
        };
        let widths: [usize; N] = std::array::from_fn(width);
        let left: [bool; N] = std::array::from_fn(|c| self.is_text_column(c));
        let line = |cells: [&str; N]| {
            let padded: [String; N] = std::array::from_fn(|c| {
                let (cell, width) = (cells[c], widths[c]);
                if left[c] { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            format!("{}\n", padded.join("  ").trim_end())
        };
        let rows = shown.iter().map(|row| line(std::array::from_fn(|c| row[c].as_str())));
        std::iter::once(line(self.columns)).chain(rows).collect()
    }

    /// Comma-separated values after RFC 4180, with `\n` line ends.
    pub(crate) fn to_csv(&self) -> String {
        let header = self.columns.map(|c| c.replace(' ', "_").replace('%', "percent")).join(",");
        let rows = self.rows.iter().map(|row| row.each_ref().map(Entry::field).join(","));
        std::iter::once(header).chain(rows).map(|line| line + "\n").collect()
    }

    pub(crate) fn to_html(&self) -> String {
        let class = |c: usize| if self.is_text_column(c) { "" } else { " class=\"n\"" };
        let cells = |tag: &str, texts: [String; N]| -> String {
            let cell = |(c, text): (usize, &String)| {
                format!("<{tag}{}>{}</{tag}>", class(c), escape(text))
            };
            texts.iter().enumerate().map(cell).collect()
        };
        let head = cells("th", self.columns.map(str::to_owned));
        let rows = self.rows.iter().map(|row| cells("td", row.each_ref().map(Entry::shown)));
        let body: String = rows
            .flat_map(|cells| {
                [
                    "<tr>".to_owned(),
                    cells,
                    "</tr>
"
                    .to_owned(),
                ]
            })
            .collect();
        format!("<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody>\n</table>\n")
    }

    /// A column is text where any of its entries is, and where it has none but empty ones.
    fn is_text_column(&self, column: usize) -> bool {
        let mut entries = self.rows.iter().map(|row| &row[column]);
        entries.any(Entry::is_text)
            || self.rows.iter().all(|row| matches!(row[column], Entry::Empty))
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
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}
