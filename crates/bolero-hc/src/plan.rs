//! Which bones constrain which unknown markers, for frames that miss the same ones.

use std::collections::VecDeque;

use crate::problem::{End, Stick};

/// A bone between two triples of columns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Segment {
    pub(crate) ends: [usize; 2],
    pub(crate) length_m: f64,
}

/// Unknown markers that bones join to each other, and all bones at them. Groups of a frame are
/// independent of each other.
#[derive(Debug, Default)]
pub(crate) struct Group {
    /// Triples of columns, neighbours close to each other.
    pub(crate) unknown: Vec<usize>,
    pub(crate) segments: Vec<Segment>,
    /// For each of `unknown`, the lowest that a bone joins it to, or itself.
    pub(crate) lowest: Vec<usize>,
}

impl Group {
    /// The bones within a frame.
    pub(crate) fn sticks(&self, row: &[f64]) -> Vec<Stick> {
        let end = |k: usize| match self.unknown.iter().position(|&u| u == k) {
            Some(i) => End::Unknown(i),
            None => End::Known(std::array::from_fn(|a| row[3 * k + a])),
        };
        let stick = |s: &Segment| Stick { ends: s.ends.map(end), length_m: s.length_m };
        self.segments.iter().map(stick).collect()
    }

    /// The entries of a row that belong to the unknown markers.
    pub(crate) fn gather(&self, row: &[f64]) -> Vec<f64> {
        self.unknown.iter().flat_map(|&k| row[3 * k..3 * k + 3].iter().copied()).collect()
    }
}

/// The groups of a frame in which the markers `seen` are seen.
pub(crate) fn groups(bones: &[Segment], seen: &[bool]) -> Vec<Group> {
    let loose = |segment: &&Segment| segment.ends.iter().any(|&k| !seen[k]);
    let segments: Vec<Segment> = bones.iter().filter(loose).copied().collect();
    let mut neighbours = vec![Vec::new(); seen.len()];
    let mut constrained = vec![false; seen.len()];
    for Segment { ends: [a, b], .. } in segments.iter().copied() {
        constrained[a] |= !seen[a];
        constrained[b] |= !seen[b];
        if !seen[a] && !seen[b] {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
    }
    let mut groups = Vec::new();
    let mut waiting = constrained;
    for k in 0..waiting.len() {
        if waiting[k] {
            // From the far end of the first walk, the second is a chain of narrow layers.
            let there = walk(k, &neighbours);
            let unknown = walk(there[there.len() - 1], &neighbours);
            for &k in &unknown {
                waiting[k] = false;
            }
            groups.push(group(unknown, &neighbours, &segments));
        }
    }
    groups
}

fn group(unknown: Vec<usize>, neighbours: &[Vec<usize>], segments: &[Segment]) -> Group {
    let place = |k: &usize| unknown.iter().position(|u| u == k);
    let lowest = unknown
        .iter()
        .enumerate()
        .map(|(i, &k)| neighbours[k].iter().filter_map(place).fold(i, usize::min))
        .collect();
    let here = |segment: &&Segment| segment.ends.iter().any(|k| unknown.contains(k));
    let segments = segments.iter().filter(here).copied().collect();
    Group { unknown, segments, lowest }
}

/// All that can be reached from a marker, nearest first.
fn walk(from: usize, neighbours: &[Vec<usize>]) -> Vec<usize> {
    let mut reached = vec![from];
    let mut next = VecDeque::from([from]);
    while let Some(k) = next.pop_front() {
        for &other in &neighbours[k] {
            if !reached.contains(&other) {
                reached.push(other);
                next.push_back(other);
            }
        }
    }
    reached
}
