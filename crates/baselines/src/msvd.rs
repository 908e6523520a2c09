use std::ops::ControlFlow;

use mocap_core::{
    Estimates, FillError, FillReport, Filled, GapFiller, IterReport, Refusal, Refused, Take,
    Termination,
};
use ndarray::{Array1, Array2, Axis};

use crate::{Edges, Linear, spectrum::Spectrum};

/// How [`Msvd`] fills.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MsvdParams {
    /// Rank of the approximation, at least 1. Default: 16, as [Li10] ran it.
    pub rank: usize,
    /// Most iterations, at least 1. Default: 99, where the authors' program stops.
    pub iterations: usize,
    /// Stops when the distance to the approximation changes by at most this share of itself; 0 or
    /// more. Default: 1e-6, the authors' value.
    pub tolerance: f64,
}

impl Default for MsvdParams {
    fn default() -> Self {
        Self { rank: 16, iterations: 99, tolerance: 1e-6 }
    }
}

/// Missing-value SVD: what is missing is taken from the best approximation of low rank, again and again.
///
/// A take of T frames and m seen coordinates is a `(T, m)` matrix. It starts with straight lines across
/// gaps (the nearest position beyond the first and the last sample). Each iteration replaces the missing entries by
/// those of the best approximation of the given rank. The objective is the Frobenius distance between matrix and
/// approximation, in metres.
///
/// It works on coordinates as recorded: the origin matters, because a matrix of low rank has no constant
/// term. One-sided gaps are filled; markers that are never seen stay open.
///
/// Implements the iteration that [Li10] Sec. 4 compares with as MSVD.
///
/// # When not to use
/// It is a yardstick. In long gaps of a marker it hardly leaves the straight line it started from.
///
/// # Cost
/// Each iteration decomposes one `(m, m)` matrix; only frames with gaps enter it anew.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Msvd {
    params: MsvdParams,
}

const NAME: &str = "msvd";

impl Msvd {
    /// A filler with these parameters.
    ///
    /// # Errors
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn new(params: MsvdParams) -> Result<Self, FillError> {
        for (field, value) in [("rank", params.rank), ("iterations", params.iterations)] {
            if value == 0 {
                return Err(FillError::Parameter { field, value: 0.0, rule: "at least 1" });
            }
        }
        if !(params.tolerance.is_finite() && params.tolerance >= 0.0) {
            let (field, value) = ("tolerance", params.tolerance);
            return Err(FillError::Parameter { field, value, rule: "a finite number from 0" });
        }
        Ok(Self { params })
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &MsvdParams {
        &self.params
    }
}

impl GapFiller for Msvd {
    fn name(&self) -> &'static str {
        NAME
    }

    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let gaps = take.gaps();
        if gaps.is_empty() {
            let report = FillReport::new(NAME, Termination::NothingToFill);
            return Ok(Filled::unchanged(take, report)?);
        }
        if take.observed().count() == 0 {
            return Err(FillError::NothingObserved);
        }
        let seen: Vec<usize> = (0..take.marker_count())
            .filter(|&m| take.observed().marker(m).iter().any(|&seen| seen))
            .collect();
        let start = Linear { edges: Edges::Hold }.fill(take)?;
        let mut matrix = Completion::new(take, &seen, start.take());
        let mut report = FillReport::new(NAME, Termination::IterationLimit);
        let mut previous = 0.0;
        for iteration in 1..=self.params.iterations {
            let distance = matrix.approximate(self.params.rank)?;
            report.iterations = iteration;
            report.objective.push(distance);
            let limit = self.params.iterations;
            if observer(&IterReport { iteration, limit, objective: distance }).is_break() {
                report.termination = Termination::Stopped;
                break;
            }
            // Also where the distance is zero.
            if (distance - previous).abs() <= self.params.tolerance * distance {
                report.termination = Termination::Converged;
                break;
            }
            previous = distance;
        }
        let mut positions = take.positions().to_owned();
        for (row, &t) in matrix.rows.outer_iter().zip(&matrix.frames) {
            for (j, x) in row.iter().enumerate() {
                positions[(t, seen[j / 3], j % 3)] = *x;
            }
        }
        let never = gaps.into_iter().filter(|gap| seen.binary_search(&gap.marker).is_err());
        report.refusals = never.map(|gap| Refused { gap, reason: Refusal::NeverSeen }).collect();
        Ok(Filled::merge(take, Estimates { positions, sigma_m: None }, report)?)
    }
}

/// A matrix whose missing entries are being completed; only rows that have some are kept.
struct Completion {
    /// The frame of each row.
    frames: Vec<usize>,
    /// `(rows, m)`.
    rows: Array2<f64>,
    /// Which entries are missing, `(rows, m)`.
    missing: Array2<bool>,
    /// Gram matrix of the rows without missing entries, `(m, m)`.
    complete: Array2<f64>,
}

impl Completion {
    fn new(take: &Take, seen: &[usize], start: &Take) -> Self {
        let has_gap = |t: &usize| seen.iter().any(|&m| !take.is_observed(*t, m));
        let (frames, complete): (Vec<usize>, Vec<usize>) = (0..take.frames()).partition(has_gap);
        let matrix = |frames: &[usize]| {
            Array2::from_shape_fn((frames.len(), 3 * seen.len()), |(r, j)| {
                start.positions()[(frames[r], seen[j / 3], j % 3)]
            })
        };
        let (rows, complete) = (matrix(&frames), matrix(&complete));
        let missing = Array2::from_shape_fn(rows.raw_dim(), |(r, j)| {
            !take.is_observed(frames[r], seen[j / 3])
        });
        Self { frames, rows, missing, complete: complete.t().dot(&complete) }
    }

    /// Takes the missing entries from the best approximation of this rank; its Frobenius distance from the matrix.
    fn approximate(&mut self, rank: usize) -> Result<f64, FillError> {
        let gram = &self.complete + &self.rows.t().dot(&self.rows);
        let spectrum = Spectrum::of_gram(NAME, &gram)?;
        let directions = spectrum.leading(rank);
        let approximation = self.rows.dot(&directions).dot(&directions.t());
        ndarray::Zip::from(&mut self.rows).and(&approximation).and(&self.missing).for_each(
            |x, &y, &missing| {
                if missing {
                    *x = y;
                }
            },
        );
        let rest: Array1<f64> = spectrum
            .values
            .slice_axis(Axis(0), (rank.min(spectrum.values.len())..).into())
            .mapv(|value| value * value);
        Ok(rest.sum().sqrt())
    }
}
