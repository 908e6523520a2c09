use std::collections::{HashMap, HashSet};

use super::{TextError, lines::shorten};

/// Makes labels unique and non-empty, and notes each label that had to change.
pub(super) fn unique(labels: Vec<String>, what: &str, notes: &mut Vec<String>) -> Vec<String> {
    let mut taken: HashSet<String> = HashSet::with_capacity(labels.len());
    let given: HashSet<String> = labels.iter().cloned().collect();
    // Where the search for a free number goes on, so that many equal labels stay cheap.
    let mut next: HashMap<String, usize> = HashMap::new();
    let mut names = Vec::with_capacity(labels.len());
    for (index, label) in labels.into_iter().enumerate() {
        if !label.trim().is_empty() && taken.insert(label.clone()) {
            names.push(label);
            continue;
        }
        let stem = if label.trim().is_empty() { "unnamed" } else { label.as_str() };
        let number = next.entry(stem.to_owned()).or_insert(if stem == label { 2 } else { 1 });
        let mut name = format!("{stem}_{number}");
        while given.contains(&name) || !taken.insert(name.clone()) {
            *number += 1;
            name = format!("{stem}_{number}");
        }
        *number += 1;
        notes.push(format!(
            "{what} {} is called `{label}` in the file and `{name}` here",
            index + 1
        ));
        names.push(name);
    }
    names
}

/// Columns of one marker.
pub(super) struct Triple {
    pub label: String,
    pub columns: [usize; 3],
}

/// Groups (label, axis, column) into markers, in the order of their first columns.
///
/// A label whose axis comes again opens another marker of the same label.
pub(super) fn triples(
    columns: impl IntoIterator<Item = (String, usize, usize)>,
    line: usize,
) -> Result<Vec<Triple>, TextError> {
    let mut found: Vec<(String, [Option<usize>; 3])> = Vec::new();
    let mut open: HashMap<String, usize> = HashMap::new();
    for (label, axis, column) in columns {
        let known = open.get(&label).copied().filter(|&i| found[i].1[axis].is_none());
        let index = known.unwrap_or_else(|| {
            found.push((label.clone(), [None; 3]));
            open.insert(label, found.len() - 1);
            found.len() - 1
        });
        found[index].1[axis] = Some(column);
    }
    if found.is_empty() {
        return Err(TextError::NoMarkers { line });
    }
    let complete = |(label, axes): (String, [Option<usize>; 3])| match axes {
        [Some(x), Some(y), Some(z)] => Ok(Triple { label, columns: [x, y, z] }),
        [x, y, _] => {
            let axis = if x.is_none() {
                'x'
            } else if y.is_none() {
                'y'
            } else {
                'z'
            };
            let marker = shorten(label.as_bytes());
            Err(TextError::IncompleteMarker { line, marker, axis })
        }
    };
    found.into_iter().map(complete).collect()
}
