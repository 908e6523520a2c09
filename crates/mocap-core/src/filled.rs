use std::sync::Arc;

use ndarray::{Array2, Array3};

use crate::{
    BoneReport, BoneSet, CoreError, FillReport, Gap, Mask, Refusal, Take, filler::Refused,
    take::check_shape,
};

/// Where a sample of a filled take comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellState {
    /// Measured.
    Observed,
    /// Estimated.
    Filled,
    /// Neither.
    Missing,
}

/// What a filler proposes: positions in metres, `(T, M, 3)`, NaN where it has none.
#[derive(Debug, Clone)]
pub struct Estimates {
    /// Proposed positions `(T, M, 3)` in metres; only those of missing cells are used.
    pub positions: Array3<f64>,
    /// Standard deviation of the 3-D error `(T, M)` in metres, where the method knows it; NaN else.
    pub sigma_m: Option<Array2<f64>>,
}

/// A take with its gaps filled, and the account of what was filled.
///
/// The one way to build it copies the observed cells from the input, so no method can alter a
/// measurement.
#[derive(Debug, Clone)]
pub struct Filled {
    take: Take,
    input: Mask,
    sigma_m: Option<Array2<f64>>,
    report: FillReport,
}

impl Filled {
    /// Puts estimates into the gaps of a take. An estimate that is not finite leaves its cell missing.
    ///
    /// # Errors
    /// [`CoreError::Shape`] if the estimates have another shape than the take.
    pub fn merge(
        input: &Take,
        estimates: Estimates,
        report: FillReport,
    ) -> Result<Self, CoreError> {
        let (frames, markers) = (input.frames(), input.marker_count());
        check_shape("estimates", &[frames, markers, 3], estimates.positions.shape())?;
        if let Some(sigma_m) = &estimates.sigma_m {
            check_shape("sigma", &[frames, markers], sigma_m.shape())?;
        }
        let mut positions = estimates.positions;
        for (t, m) in input.observed().iter() {
            for a in 0..3 {
                positions[(t, m, a)] = input.positions()[(t, m, a)];
            }
        }
        let take = Take::from_positions(Arc::clone(input.markers()), input.rate_hz(), positions)?;
        Ok(Self { take, input: input.observed().clone(), sigma_m: estimates.sigma_m, report })
    }

    /// A fill that left everything as it is.
    ///
    /// # Errors
    /// None in practice; the signature is that of [`merge`](Self::merge).
    pub fn unchanged(input: &Take, report: FillReport) -> Result<Self, CoreError> {
        let estimates = Estimates { positions: input.positions().to_owned(), sigma_m: None };
        Self::merge(input, estimates, report)
    }

    /// Observed and filled samples together.
    #[must_use]
    pub fn take(&self) -> &Take {
        &self.take
    }

    /// Where a sample comes from.
    ///
    /// # Panics
    /// If the cell lies outside of the take.
    #[must_use]
    pub fn state(&self, frame: usize, marker: usize) -> CellState {
        if self.input.contains(frame, marker) {
            CellState::Observed
        } else if self.take.is_observed(frame, marker) {
            CellState::Filled
        } else {
            CellState::Missing
        }
    }

    /// The cells that were filled, `(T, M)`.
    #[must_use]
    pub fn filled_cells(&self) -> Mask {
        Mask::from_fn(self.take.frames(), self.take.marker_count(), |t, m| {
            self.state(t, m) == CellState::Filled
        })
    }

    /// The cells that were measured, `(T, M)`.
    #[must_use]
    pub fn observed_cells(&self) -> &Mask {
        &self.input
    }

    /// Standard deviation of a filled sample's 3-D error in metres, where the method knows it.
    ///
    /// # Panics
    /// If the cell lies outside of the take.
    #[must_use]
    pub fn sigma_m(&self, frame: usize, marker: usize) -> Option<f64> {
        let sigma = self.sigma_m.as_ref()?[(frame, marker)];
        (sigma.is_finite() && self.state(frame, marker) == CellState::Filled).then_some(sigma)
    }

    /// The gaps of the input, filled or not, marker by marker and in time order.
    #[must_use]
    pub fn gaps(&self) -> Vec<Gap> {
        crate::gap::gaps(&self.input)
    }

    /// How the fill came about.
    #[must_use]
    pub fn report(&self) -> &FillReport {
        &self.report
    }

    /// The same fill with its bones measured for the report.
    #[must_use]
    pub fn measure_bones(mut self, bones: &BoneSet) -> Self {
        self.report.bones = Some(BoneReport::measure(&self, bones));
        self
    }

    /// The same fill with one gap left open, and the reason.
    ///
    /// # Errors
    /// [`CoreError::OutOfRange`] if the gap lies outside of the take.
    pub fn refuse(mut self, gap: Gap, reason: Refusal) -> Result<Self, CoreError> {
        let mut open = Mask::none(self.take.frames(), self.take.marker_count());
        for t in gap.frames.clone() {
            open.insert(t, gap.marker)?;
        }
        let keep = Mask::from_fn(self.take.frames(), self.take.marker_count(), |t, m| {
            open.contains(t, m) && !self.input.contains(t, m)
        });
        self.take = self.take.hide(&keep)?;
        self.report.refusals.retain(|r| r.gap != gap);
        self.report.refusals.push(Refused { gap, reason });
        Ok(self)
    }
}
