use std::collections::BTreeMap;

use super::Style;

/// The methods of a report in their order, and the style of each.
#[derive(Debug)]
pub(crate) struct Legend<'a>(BTreeMap<&'a str, usize>);

impl<'a> Legend<'a> {
    /// The styles of the methods in the order in which they first come.
    pub(crate) fn of(labels: impl IntoIterator<Item = &'a str>) -> Self {
        let mut places = BTreeMap::new();
        for label in labels {
            let next = places.len();
            places.entry(label).or_insert(next);
        }
        Self(places)
    }

    /// The place of a method, from 0; that after the last for one that is not there.
    pub(crate) fn place(&self, label: &str) -> usize {
        self.0.get(label).copied().unwrap_or(self.0.len())
    }

    /// The methods in their order.
    pub(crate) fn labels(&self) -> Vec<&'a str> {
        let mut labels: Vec<&'a str> = self.0.keys().copied().collect();
        labels.sort_by_key(|label| self.place(label));
        labels
    }

    pub(crate) fn style(&self, label: &str) -> Style {
        Style::of(self.place(label))
    }
}
