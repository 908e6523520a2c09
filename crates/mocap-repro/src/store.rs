use std::{
    collections::HashMap,
    fs::{File, OpenOptions},
    io::{Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use crate::{Outcome, ReproError};

/// The finished cells of a matrix, in a file of JSON lines that grows by one line a cell.
///
/// A run that was killed leaves its finished lines and perhaps the start of one more; opening the
/// file again keeps the former and drops the latter.
#[derive(Debug)]
pub struct Store {
    path: PathBuf,
    file: File,
    done: HashMap<String, Outcome>,
    dropped: usize,
}

#[derive(Serialize, Deserialize)]
struct Line {
    key: String,
    /// For people who look into the file.
    what: String,
    outcome: Outcome,
}

impl Store {
    /// Opens the file or makes it.
    ///
    /// # Errors
    /// [`ReproError::Io`].
    pub fn open(path: &Path) -> Result<Self, ReproError> {
        let at = |source| ReproError::Io { path: path.to_owned(), source };
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(at)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(at)?;
        // What stands after the last line end was being written when the run was killed.
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1);
        file.set_len(whole as u64).map_err(at)?;
        file.seek(SeekFrom::End(0)).map_err(at)?;
        let mut store = Self {
            path: path.to_owned(),
            file,
            done: HashMap::new(),
            dropped: usize::from(whole < bytes.len()),
        };
        for line in bytes[..whole].split(|&byte| byte == b'\n').filter(|line| !line.is_empty()) {
            match serde_json::from_slice::<Line>(line) {
                Ok(Line { key, outcome, .. }) => drop(store.done.insert(key, outcome)),
                Err(_) => store.dropped += 1,
            }
        }
        Ok(store)
    }

    /// Lines that could not be read; their cells are computed again.
    #[must_use]
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    pub(crate) fn get(&self, key: &str) -> Option<&Outcome> {
        self.done.get(key)
    }

    /// Adds a cell, on disk before anything else happens.
    pub(crate) fn add(
        &mut self,
        key: String,
        what: String,
        outcome: Outcome,
    ) -> Result<(), ReproError> {
        let line = Line { key, what, outcome };
        let mut bytes = serde_json::to_vec(&line).map_err(|error| self.broken(error.into()))?;
        bytes.push(b'\n');
        self.file.write_all(&bytes).map_err(|error| self.broken(error))?;
        self.done.insert(line.key, line.outcome);
        Ok(())
    }

    fn broken(&self, source: std::io::Error) -> ReproError {
        ReproError::Io { path: self.path.clone(), source }
    }
}
