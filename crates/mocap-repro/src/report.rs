use std::path::{Path, PathBuf};

use mocap_io::write_atomic;
use mocap_report::{Entry, escape, web_page};

use crate::{Compared, Duel, ReproError, Row, Section, figure::Figure, section::paragraph};

/// Tables and figures, and what they were made from.
#[derive(Debug)]
pub struct Report {
    pub(crate) title: String,
    pub(crate) intro: Vec<String>,
    /// What a reader has to know of the results, under headings.
    pub(crate) findings: Vec<Finding>,
    pub(crate) sections: Vec<Section>,
    pub(crate) figures: Vec<Figure>,
    /// One row for each group, condition and method.
    pub rows: Vec<Row>,
    /// Which method wins how often.
    pub duels: Vec<Duel>,
    /// References beside ours.
    pub compared: Vec<Compared>,
}

/// Something that the figures show, in words.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Finding {
    pub claim: String,
    pub text: String,
}

/// Heading of the findings.
const FINDINGS: &str = "Where this differs from the paper, and why";

impl Report {
    /// Everything in Markdown; figures are linked.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let mut parts = vec![format!("# {}\n\n{}\n\n", self.title, self.intro.join("\n\n"))];
        if !self.findings.is_empty() {
            parts.push(format!("## {FINDINGS}\n\n"));
        }
        let finding = |finding: &Finding| format!("**{}** {}\n\n", finding.claim, finding.text);
        parts.extend(self.findings.iter().map(finding));
        let figure = |figure: &Figure| {
            format!("![{}]({}.svg)\n\n{}\n\n", figure.title, figure.id, figure.caption)
        };
        parts.extend(self.figures.iter().map(figure));
        parts.extend(self.sections.iter().map(|section| section.to_markdown() + "\n"));
        parts.concat().trim_end().to_owned() + "\n"
    }

    /// One web page that loads nothing from elsewhere, with the figures as they were drawn.
    fn to_html(&self, drawn: &[String]) -> String {
        let mut parts: Vec<String> = self.intro.iter().map(|text| paragraph(text)).collect();
        if !self.findings.is_empty() {
            parts.push(format!("<h2>{}</h2>\n", escape(FINDINGS)));
        }
        parts.extend(self.findings.iter().map(|finding| {
            let claim = format!("<p><strong>{}</strong> ", escape(&finding.claim));
            paragraph(&finding.text).replacen("<p>", &claim, 1)
        }));
        parts.extend(self.figures.iter().zip(drawn).map(|(figure, svg)| {
            let title = escape(&figure.title);
            format!("<h2>{title}</h2>\n{svg}\n{}", paragraph(&figure.caption))
        }));
        parts.extend(self.sections.iter().map(Section::to_html));
        web_page(&escape(&self.title), &parts.concat())
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
        for section in &self.sections {
            put(format!("{}.csv", section.id), section.table.to_csv().as_bytes())?;
        }
        let mut drawn = Vec::new();
        for figure in &self.figures {
            let svg = figure.svg()?;
            put(format!("{}.svg", figure.id), svg.as_bytes())?;
            put(format!("{}.png", figure.id), &figure.png()?)?;
            drawn.push(svg);
        }
        Ok([
            put(format!("{name}.md"), self.to_markdown().as_bytes())?,
            put(format!("{name}.html"), self.to_html(&drawn).as_bytes())?,
        ])
    }
}

/// Every row with all its figures.
pub(crate) fn stats_table(id: &str, title: &str, note: &str, rows: &[&Row]) -> Section {
    let columns = [
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
        "border mm",
        "jerk ratio",
        "unfilled",
        "failed",
        "s a trial",
    ];
    let row = |row: &&Row| {
        let stats = &row.stats;
        vec![
            Entry::text(&row.class),
            Entry::text(row.coordinates),
            Entry::text(row.knowledge),
            Entry::text(&row.method),
            Entry::count(stats.trials),
            Entry::scientific(stats.mse_mean),
            Entry::scientific(stats.mse_median),
            Entry::scientific(stats.mse_p75),
            Entry::scientific(stats.mse_max),
            Entry::number(stats.mm_mean, 2),
            Entry::number(stats.mm_median, 2),
            Entry::number(stats.mm_p95, 2),
            Entry::number(stats.bone_mm, 2),
            Entry::number(stats.border_mm, 2),
            Entry::number(stats.jerk_ratio, 2),
            Entry::count(stats.unfilled),
            Entry::count(stats.failed),
            Entry::number(stats.seconds, 3),
        ]
    };
    Section::new(id, title, note, &columns, rows.iter().map(row))
}

pub(crate) const STATS_NOTE: &str = "`mse` in m² per coordinate (Eq. 13 of the paper), `mm` 3-D \
    distances: mean and median over trials of the trial's mean, p95 the mean over trials of the 95 % \
    quantile within a trial. `bone mm`: mean deviation from the true mean lengths of the bones that \
    touch a hidden sample. `border mm`: mean step beside the measured samples. `jerk ratio`: root mean \
    square jerk of the fill by that of the truth, median over trials. `unfilled`: hidden samples left \
    open, which no error counts. `failed`: trials on which the method could not run.";
