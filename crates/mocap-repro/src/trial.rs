use std::path::Path;

use mocap_core::{Holdout, Mask, Take};
use serde::Serialize;

use crate::ReproError;

/// What is hidden of one motion, and the group that its result belongs to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// The table that it belongs to: `cases`, `trials90`, `multi`, …
    pub set: String,
    /// The row group within the table.
    pub class: String,
    /// Name, unique within the set.
    pub name: String,
    /// Name of the motion.
    pub motion: String,
    /// What is hidden.
    pub hidden: Vec<Hide>,
    /// Seed of a random start.
    pub seed: u64,
    /// Iterations at most, where the trial has its own number.
    pub iterations: Option<usize>,
}

/// A run of frames of one marker.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Hide {
    /// Name of the marker; `*` for all.
    pub marker: String,
    /// First frame, from 0.
    pub start: usize,
    /// The frame after the last.
    pub end: usize,
}

impl Trial {
    /// Hides what the trial says.
    ///
    /// # Errors
    /// [`ReproError::Misfit`] for a marker or a frame that the take does not have,
    /// [`ReproError::NothingHidden`] if none of the hidden samples was measured.
    pub fn cut(&self, take: &Take) -> Result<Holdout, ReproError> {
        let misfit = |source| ReproError::Misfit {
            trial: self.name.clone(),
            motion: self.motion.clone(),
            source,
        };
        let mask = self.mask(take).map_err(misfit)?;
        let holdout = Holdout::new(take.clone(), &mask).map_err(misfit)?;
        if holdout.hidden().count() == 0 {
            let (trial, motion) = (self.name.clone(), self.motion.clone());
            return Err(ReproError::NothingHidden { trial, motion });
        }
        Ok(holdout)
    }

    fn mask(&self, take: &Take) -> Result<Mask, mocap_core::CoreError> {
        let mut mask = Mask::none(take.frames(), take.marker_count());
        for hide in &self.hidden {
            let markers = if hide.marker == "*" {
                0..take.marker_count()
            } else {
                let marker = take.markers().find(&hide.marker)?;
                marker..marker + 1
            };
            for marker in markers {
                for t in hide.start..hide.end {
                    mask.insert(t, marker)?;
                }
            }
        }
        Ok(mask)
    }
}

/// Hides the same frames of several markers. `first` and `last` count from 1, both included, as
/// papers write them.
pub(crate) fn hide(markers: &[&str], first: usize, last: usize) -> Vec<Hide> {
    let one = |marker: &&str| Hide { marker: (*marker).to_owned(), start: first - 1, end: last };
    markers.iter().map(one).collect()
}

const COLUMNS: [&str; 5] = ["trial", "motion", "marker", "start", "end"];
const SEED: &str = "init_seed";

/// Reads a list of trials: a table with the columns `trial`, `motion`, `marker`, `start` and `end`
/// (frames from 1, the last one included), and perhaps `init_seed`.
///
/// # Errors
/// [`ReproError::Io`], [`ReproError::Csv`], [`ReproError::Column`] for a missing column, and
/// [`ReproError::Trial`] for a value that cannot be.
pub fn read_trials(path: &Path, set: &str, class: &str) -> Result<Vec<Trial>, ReproError> {
    let file = std::fs::File::open(path)
        .map_err(|source| ReproError::Io { path: path.to_owned(), source })?;
    let broken = |source| ReproError::Csv { path: path.to_owned(), source };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(file);
    let header = reader.headers().map_err(broken)?.clone();
    let columns = Columns::find(path, &header)?;
    let mut trials: Vec<Trial> = Vec::new();
    for record in reader.records() {
        let trial = columns.read(&record.map_err(broken)?, set, class)?;
        if trials.iter().any(|other| other.name == trial.name) {
            let line = 2 + trials.len() as u64;
            return Err(columns.wrong(line, 0, &trial.name, "a name that no other trial has"));
        }
        trials.push(trial);
    }
    Ok(trials)
}

/// Where the columns of a list of trials stand.
struct Columns<'a> {
    path: &'a Path,
    at: [usize; 5],
    seed: Option<usize>,
}

impl<'a> Columns<'a> {
    fn find(path: &'a Path, header: &csv::StringRecord) -> Result<Self, ReproError> {
        let find = |name: &str| header.iter().position(|column| column == name);
        let mut at = [0; 5];
        for (place, column) in at.iter_mut().zip(COLUMNS) {
            *place = find(column).ok_or_else(|| ReproError::Column {
                path: path.to_owned(),
                column,
                needed: COLUMNS.join(", "),
                found: header.iter().collect::<Vec<_>>().join(", "),
            })?;
        }
        Ok(Self { path, at, seed: find(SEED) })
    }

    fn read(
        &self,
        record: &csv::StringRecord,
        set: &str,
        class: &str,
    ) -> Result<Trial, ReproError> {
        let line = record.position().map_or(0, csv::Position::line);
        let [name, motion, marker, first, last] = self.at.map(|c| record.get(c).unwrap_or(""));
        let frame = |column: usize, text: &str, from: usize| -> Result<usize, ReproError> {
            let frame = text.parse().ok().filter(|frame| *frame >= from);
            let rule = format!("a frame number from {from} on");
            frame.ok_or_else(|| self.wrong(line, column, text, &rule))
        };
        let first = frame(3, first, 1)?;
        let last = frame(4, last, first)?;
        let seed = match self.seed.and_then(|c| record.get(c)) {
            None => 0,
            Some(text) => text.parse().map_err(|_| ReproError::Trial {
                path: self.path.to_owned(),
                line,
                column: SEED,
                value: text.to_owned(),
                rule: "a whole number from 0 on".to_owned(),
            })?,
        };
        Ok(Trial {
            set: set.to_owned(),
            class: class.to_owned(),
            name: name.to_owned(),
            motion: motion.to_owned(),
            hidden: hide(&[marker], first, last),
            seed,
            iterations: None,
        })
    }

    fn wrong(&self, line: u64, column: usize, value: &str, rule: &str) -> ReproError {
        ReproError::Trial {
            path: self.path.to_owned(),
            line,
            column: COLUMNS[column],
            value: value.to_owned(),
            rule: rule.to_owned(),
        }
    }
}

/// A small list on the project's own synthetic recordings `run`, `walk`, `throw` and `jump`.
#[must_use]
pub fn fixture_trials() -> Vec<Trial> {
    let arm = ["RUPA", "RELB", "RFRM", "RWRA", "RWRB"];
    let list: [(&str, &[&str], usize, usize); 8] = [
        ("run", &["RKNE", "RSHN"], 90, 149),
        ("run", &["LELB"], 60, 179),
        ("walk", &["LKNE"], 60, 119),
        ("walk", &["RFHD"], 80, 159),
        ("throw", &["RELB", "RFRM"], 30, 79),
        ("throw", &arm, 50, 79),
        ("jump", &["LANK"], 20, 79),
        ("jump", &["*"], 55, 66),
    ];
    let trial = |(seed, (motion, markers, first, last)): (u64, (&str, &[&str], usize, usize))| {
        let names = if markers == ["*"] { "all markers".to_owned() } else { markers.join("+") };
        Trial {
            set: "fixtures".to_owned(),
            class: "synthetic".to_owned(),
            name: format!("{motion} {names} {first}\u{2013}{last}"),
            motion: motion.to_owned(),
            hidden: hide(markers, first, last),
            seed,
            iterations: None,
        }
    };
    (1..).zip(list).map(trial).collect()
}
