use mocap_report::Entry;
use serde::{Deserialize, Serialize};

use crate::{Coordinates, Knowledge, Row, Section};

/// A figure that somebody else measured, with its source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Set of trials.
    pub set: String,
    /// Group within the set.
    pub class: String,
    /// Coordinates.
    pub coordinates: Coordinates,
    /// What the method was told.
    pub knowledge: Knowledge,
    /// Our name of the method.
    pub method: String,
    /// Name of the figure, as a field of [`Stats`](crate::Stats) is called.
    pub figure: String,
    /// Its value, in the unit of that field.
    pub value: f64,
    /// Who measured it.
    pub source: String,
}

/// A reference beside ours.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// What others measured.
    pub reference: Reference,
    /// What we measured.
    pub ours: f64,
}

impl Compared {
    /// Ours by theirs: below 1, ours is the smaller.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.ours / self.reference.value
    }
}

static BUILT_IN: &str = include_str!("../data/reference.csv");

impl Reference {
    /// The figures that come with this crate; lines that cannot be read are left out, and a test sees
    /// to it that there are none.
    #[must_use]
    pub fn built_in() -> Vec<Self> {
        let mut reader = csv::Reader::from_reader(BUILT_IN.as_bytes());
        reader.deserialize().filter_map(Result::ok).collect()
    }
}

/// The references that the rows have a figure for.
#[must_use]
pub fn compare(rows: &[Row], references: &[Reference]) -> Vec<Compared> {
    let compared = |reference: &Reference| {
        let row = rows.iter().find(|row| {
            row.set == reference.set
                && row.class == reference.class
                && row.coordinates == reference.coordinates
                && row.knowledge == reference.knowledge
                && row.method == reference.method
        })?;
        let ours = row.stats.named(&reference.figure)?;
        Some(Compared { reference: reference.clone(), ours })
    };
    references.iter().filter_map(compared).collect()
}

/// Ours beside theirs.
pub(crate) fn table(compared: &[Compared]) -> Section {
    let row = |both: &Compared| {
        let theirs = &both.reference;
        let value = |value| {
            let small = theirs.figure.starts_with("mse");
            if small { Entry::scientific(Some(value)) } else { Entry::number(Some(value), 2) }
        };
        vec![
            Entry::text(&theirs.class),
            Entry::text(theirs.coordinates),
            Entry::text(theirs.knowledge),
            Entry::text(&theirs.method),
            Entry::text(theirs.figure.replace('_', " ")),
            value(theirs.value),
            value(both.ours),
            ratio(both.ratio()),
            Entry::text(&theirs.source),
        ]
    };
    Section::new(
        "reference",
        "Reference figures beside ours",
        "Ratio: ours by the reference, so below 1 ours is the smaller. `mse` in m², `mm` in mm.",
        &[
            "case",
            "coordinates",
            "told",
            "method",
            "figure",
            "reference",
            "ours",
            "ratio",
            "source",
        ],
        compared.iter().map(row),
    )
}

/// A ratio beyond all sense is one of a fill that ran away.
fn ratio(value: f64) -> Entry {
    if value < 1e4 { Entry::number(Some(value), 2) } else { Entry::scientific(Some(value)) }
}
