use std::collections::HashMap;

use crate::CoreError;

/// The ordered, unique marker names of a take.
///
/// Names keep the spelling of their file, subject prefix included (`jane:LFHD`).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarkerSet {
    names: Vec<String>,
    index: HashMap<String, usize>,
}

impl MarkerSet {
    /// Takes the names in the order of the take's columns.
    ///
    /// # Errors
    /// [`CoreError::EmptyMarkerName`] and [`CoreError::DuplicateMarkerName`].
    ///
    /// ```
    /// let set = mocap_core::MarkerSet::new(["jane:LFHD", "jane:RFHD"])?;
    /// assert_eq!(set.find("RFHD")?, 1);
    /// assert!(mocap_core::MarkerSet::new(["C7", "C7"]).is_err());
    /// # Ok::<(), mocap_core::CoreError>(())
    /// ```
    pub fn new<S: Into<String>>(names: impl IntoIterator<Item = S>) -> Result<Self, CoreError> {
        let names: Vec<String> = names.into_iter().map(Into::into).collect();
        let mut index = HashMap::with_capacity(names.len());
        for (second, name) in names.iter().enumerate() {
            if name.trim().is_empty() {
                return Err(CoreError::EmptyMarkerName { index: second });
            }
            if let Some(first) = index.insert(name.clone(), second) {
                return Err(CoreError::DuplicateMarkerName { name: name.clone(), first, second });
            }
        }
        Ok(Self { names, index })
    }

    /// Number of markers M.
    #[must_use]
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether the set holds no marker.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// All names, in column order.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The name of a marker, prefix included.
    ///
    /// # Panics
    /// If `marker` is not below [`len`](Self::len).
    #[must_use]
    pub fn name(&self, marker: usize) -> &str {
        &self.names[marker]
    }

    /// Subject prefix and bare name: `jane:LFHD` gives `("jane", "LFHD")`, `LFHD` gives `("", "LFHD")`.
    ///
    /// # Panics
    /// If `marker` is not below [`len`](Self::len).
    #[must_use]
    pub fn split(&self, marker: usize) -> (&str, &str) {
        split_name(&self.names[marker])
    }

    /// Finds a marker by its full name, or by its bare name where only one subject has it.
    ///
    /// # Errors
    /// [`CoreError::UnknownMarker`], with the names that look alike.
    pub fn find(&self, name: &str) -> Result<usize, CoreError> {
        if let Some(&marker) = self.index.get(name) {
            return Ok(marker);
        }
        let mut same_bare = (0..self.len()).filter(|&m| self.split(m).1 == name);
        if let (Some(marker), None) = (same_bare.next(), same_bare.next()) {
            return Ok(marker);
        }
        let wanted = split_name(name).1.to_lowercase();
        let similar = (0..self.len())
            .filter(|&m| self.split(m).1.to_lowercase() == wanted)
            .map(|m| self.names[m].clone())
            .collect();
        Err(CoreError::UnknownMarker { name: name.into(), similar })
    }
}

/// Splits a label into subject prefix and bare name.
pub(crate) fn split_name(name: &str) -> (&str, &str) {
    name.rsplit_once(':').unwrap_or(("", name))
}
