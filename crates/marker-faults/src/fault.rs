use std::{fmt, ops::Range};

use mocap_core::{CoreError, Mask, Take};

/// What is wrong with a run of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum FaultKind {
    /// One to three frames away from the marker's own path.
    Spike,
    /// A longer stay away from the path, left and entered again by a step.
    Jump,
    /// The labels of two markers are exchanged.
    Swap {
        /// Index of the other marker.
        with: usize,
    },
    /// Samples beside a gap that do not continue the path.
    GapEdge,
    /// A run between gaps at distances that the marker never keeps to its neighbours.
    Misplaced,
    /// A point that stands still while the body moves.
    Ghost,
}

impl FaultKind {
    /// The name that reports use.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Spike => "spike",
            Self::Jump => "jump",
            Self::Swap { .. } => "swap",
            Self::GapEdge => "gap-edge",
            Self::Misplaced => "misplaced",
            Self::Ghost => "ghost",
        }
    }
}

impl fmt::Display for FaultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A run of samples that no body can have made, and the evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Marker index.
    pub marker: usize,
    /// Zero-based frames, end exclusive.
    pub frames: Range<usize>,
    /// What is wrong.
    pub kind: FaultKind,
    /// How far the samples are off, in metres: from the path (spike, jump, gap edge), from the exchanged
    /// marker (swap), beyond the usual distances (misplaced); for a ghost, by how much its distance to the body
    /// changes.
    pub size_m: f64,
    /// What would have passed, in metres.
    pub limit_m: f64,
}

/// The faults of a take, marker by marker and in time order.
#[derive(Debug, Clone, PartialEq)]
pub struct Faults {
    list: Vec<Fault>,
    mask: Mask,
}

impl Faults {
    /// Keeps of each fault the observed samples that no fault before it in the list has.
    pub(crate) fn new(take: &Take, mut list: Vec<Fault>) -> Self {
        list.sort_by_key(|fault| (fault.marker, fault.frames.start, fault.frames.end, fault.kind));
        let mut rows = vec![vec![false; take.frames()]; take.marker_count()];
        for fault in &list {
            rows[fault.marker][fault.frames.clone()].fill(true);
        }
        let is_faulty = |t: usize, m: usize| rows[m][t] && take.is_observed(t, m);
        let mask = Mask::from_fn(take.frames(), take.marker_count(), is_faulty);
        Self { list, mask }
    }

    /// Those faults alone that `keep` says yes to.
    ///
    /// # Panics
    /// For another take than the one that was looked at.
    #[must_use]
    pub fn only(mut self, take: &Take, keep: impl FnMut(&Fault) -> bool) -> Self {
        self.list.retain(keep);
        Self::new(take, self.list)
    }

    /// The faults.
    #[must_use]
    pub fn list(&self) -> &[Fault] {
        &self.list
    }

    /// The faulty samples, `(T, M)`.
    #[must_use]
    pub fn mask(&self) -> &Mask {
        &self.mask
    }

    /// The take without its faulty samples. Nothing else changes, and the take itself stays as it is.
    ///
    /// # Errors
    /// [`CoreError::Shape`] for another take than the one that was looked at.
    pub fn hide(&self, take: &Take) -> Result<Take, CoreError> {
        take.hide(&self.mask)
    }
}
