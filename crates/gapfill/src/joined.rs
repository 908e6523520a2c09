use std::ops::ControlFlow;

use mocap_core::{
    CellState, Estimates, FillError, Filled, Gap, GapFiller, IterReport, Take,
    geometry::{add, scale},
};
use ndarray::Array2;

use crate::step::offsets;

/// What becomes of the step between the measured samples beside a gap and the fill.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Borders {
    /// The fill is shifted so that it joins them.
    Join,
    /// It stays as the method left it.
    Keep,
}

/// A filler whose fills join the measured samples on either side.
///
/// A model that explains a whole take misses each single sample by a little, and so its fill stands
/// beside the samples around the gap. The step at each border, which is the move across it less the
/// mean of the moves before and after, is taken out at the border and linearly less towards the other
/// side; a gap with one side is shifted as a whole. Bone lengths may change by as much.
#[derive(Debug, Clone)]
pub struct Joined<F> {
    inner: F,
}

impl<F: GapFiller> Joined<F> {
    /// Joins what `inner` fills.
    pub fn new(inner: F) -> Self {
        Self { inner }
    }
}

impl<F: GapFiller> GapFiller for Joined<F> {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let filled = self.inner.fill_observed(take, observer)?;
        Ok(join(take, &filled)?)
    }
}

/// The same fill with its border steps taken out.
fn join(input: &Take, filled: &Filled) -> Result<Filled, mocap_core::CoreError> {
    let take = filled.take();
    let mut positions = take.positions().to_owned();
    for gap in filled.gaps() {
        if filled.state(gap.frames.start, gap.marker) != CellState::Filled {
            continue;
        }
        for (t, shift) in gap.frames.clone().zip(shifts(take, &gap)) {
            for (axis, c) in shift.into_iter().enumerate() {
                positions[(t, gap.marker, axis)] -= c;
            }
        }
    }
    let sigma = |(t, m)| filled.sigma_m(t, m).unwrap_or(f64::NAN);
    let sigma_m = Array2::from_shape_fn((take.frames(), take.marker_count()), sigma);
    let estimates = Estimates { positions, sigma_m: Some(sigma_m) };
    // Joining moves the bones; what was measured before no longer holds.
    let mut report = filled.report().clone();
    report.bones = None;
    Filled::merge(input, estimates, report)
}

/// What to take off each frame of a gap, in metres.
fn shifts(take: &Take, gap: &Gap) -> Vec<[f64; 3]> {
    let path = |t: usize| (t < take.frames()).then(|| take.position(t, gap.marker)).flatten();
    let [entry, exit] = offsets(&path, &gap.frames);
    let last = gap.len().saturating_sub(1);
    let share = |k: usize| if last == 0 { 0.5 } else { k as f64 / last as f64 };
    let at = |k: usize| match (entry, exit) {
        (Some(entry), Some(exit)) => add(scale(1.0 - share(k), entry), scale(share(k), exit)),
        (Some(only), None) | (None, Some(only)) => only,
        (None, None) => [0.0; 3],
    };
    (0..gap.len()).map(at).collect()
}
