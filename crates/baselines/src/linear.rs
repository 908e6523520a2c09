use std::ops::ControlFlow;

use mocap_core::{FillError, Filled, GapFiller, IterReport, Take};

use crate::{Edges, per_marker};

/// A straight line from the last position before a gap to the first one after it.
///
/// # Cost
/// Linear in the frames of the markers that have gaps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Linear {
    /// What becomes of one-sided gaps.
    pub edges: Edges,
}

impl GapFiller for Linear {
    fn name(&self) -> &'static str {
        "linear"
    }

    fn fill_observed(
        &self,
        take: &Take,
        _: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        per_marker::fill(take, self.name(), self.edges, |samples| {
            let (frames, values) = (samples.frames, samples.values);
            move |t| {
                let after = frames.partition_point(|&f| f < t).clamp(1, frames.len() - 1);
                let (s, e) = (frames[after - 1], frames[after]);
                let share = (t - s) as f64 / (e - s) as f64;
                let (p, q) = (values[after - 1], values[after]);
                std::array::from_fn(|a| p[a] + share * (q[a] - p[a]))
            }
        })
    }
}
