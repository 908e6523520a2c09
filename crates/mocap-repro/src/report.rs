use std::path::{Path, PathBuf};

use mocap_io::write_atomic;

use crate::{Compared, Duel, Entry, ReproError, Row, Table, figure::Figure, page};

/// Tables and figures, and what they were made from.
#[derive(Debug)]
pub struct Report {
    pub(crate) title: String,
    pub(crate) intro: Vec<String>,
    pub(crate) tables: Vec<Table>,
    pub(crate) figures: Vec<Figure>,
    /// One row for each group, condition and method.
    pub rows: Vec<Row>,
    /// Which method wins how often.
    pub duels: Vec<Duel>,
    /// References beside ours.
    pub compared: Vec<Compared>,
}

impl Report {
    /// Everything in Markdown; figures are linked.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let head = format!("# {}\n\n{}\n\n", self.title, self.intro.join("\n\n"));
        let tables = self.tables.iter().map(|table| table.to_markdown() + "\n");
        let figures = self
            .figures
            .iter()
            .map(|figure| format!("![{}]({}.svg)\n\n", figure.title(), figure.id()));
        let text: Vec<String> = std::iter::once(head).chain(tables).chain(figures).collect();
        text.concat().trim_end().to_owned() + "\n"
    }

    /// The figures behind the tables, for programs.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({
            "title": self.title,
            "rows": self.rows,
            "duels": self.duels,
            "references": self.compared,
        })
    }

    /// Writes `NAME.md`, `NAME.html`, one CSV a table, and each figure as SVG and PNG into a folder;
    /// returns the paths of the first two.
    ///
    /// # Errors
    /// [`ReproError::Write`] and [`ReproError::Figure`].
    pub fn write(&self, folder: &Path, name: &str) -> Result<[PathBuf; 2], ReproError> {
        let put = |file: String, bytes: &[u8]| -> Result<PathBuf, ReproError> {
            let path = folder.join(file);
            write_atomic(&path, bytes, true)?;
            Ok(path)
        };
        for table in &self.tables {
            put(format!("{}.csv", table.id), table.to_csv().as_bytes())?;
        }
        let mut drawn = Vec::new();
        for figure in &self.figures {
            let svg = figure.svg()?;
            put(format!("{}.svg", figure.id()), svg.as_bytes())?;
            figure.png(&folder.join(format!("{}.png", figure.id())))?;
            drawn.push((figure.title().to_owned(), svg));
        }
        let page = page::html(&self.title, &self.intro, &self.tables, &drawn);
        Ok([
            put(format!("{name}.md"), self.to_markdown().as_bytes())?,
            put(format!("{name}.html"), page.as_bytes())?,
        ])
    }
}

/// Every row with all its figures.
pub(crate) fn stats_table(id: &'static str, title: &str, note: &str, rows: &[&Row]) -> Table {
    let mut table = Table::new(
        id,
        title,
        note,
        &[
            "trials of",
            "coordinates",
            "told",
            "method",
            "n",
            "mean mse",
            "median mse",
            "p75 mse",
            "max mse",
            "mean mm",
            "median mm",
            "p95 mm",
            "bone mm",
            "unfilled",
            "failed",
            "s a trial",
        ],
    );
    table.rows = rows
        .iter()
        .map(|row| {
            let stats = &row.stats;
            vec![
                Entry::text(&row.class),
                Entry::text(row.coordinates),
                Entry::text(row.knowledge),
                Entry::text(&row.method),
                Entry::Count(stats.trials),
                Entry::Scientific(stats.mse_mean),
                Entry::Scientific(stats.mse_median),
                Entry::Scientific(stats.mse_p75),
                Entry::Scientific(stats.mse_max),
                Entry::Fixed(stats.mm_mean, 2),
                Entry::Fixed(stats.mm_median, 2),
                Entry::Fixed(stats.mm_p95, 2),
                Entry::Fixed(stats.bone_mm, 2),
                Entry::Count(stats.unfilled),
                Entry::Count(stats.failed),
                Entry::Fixed(stats.seconds, 3),
            ]
        })
        .collect();
    table
}

pub(crate) const STATS_NOTE: &str = "`mse` in m² per coordinate (Eq. 13 of the paper), `mm` 3-D \
    distances: mean and median over trials of the trial's mean, p95 the mean over trials of the 95 % \
    quantile within a trial. `bone mm`: mean deviation from the true mean lengths of the bones that \
    touch a hidden sample. `unfilled`: hidden samples left open, which no error counts. `failed`: \
    trials on which the method could not run.";
