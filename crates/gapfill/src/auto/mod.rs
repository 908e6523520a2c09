//! The best mixture of methods for each gap, chosen by trying them on gaps whose truth is known.

mod canvas;
mod ease;
mod growth;
mod mixture;
mod pace;
mod rival;
mod rivals;
mod sigma;
mod simplex;
mod stack;

use std::{
    ops::{ControlFlow, Range},
    sync::Arc,
};

use baselines::{CubicSpline, Pca, Pchip, QuinticSpline};
use bolero_sc::{BoleroSc, BoleroScParams};
use lds_kalman::filler::{LdsFiller, LdsFillerParams};
use locality_ridge::ensemble::{Ensemble, Part, Session};
use mocap_core::{
    Choice, FillError, FillReport, Filled, Gap, GapContext, GapFiller, IterReport, Refusal,
    Refused, Take, Termination,
};
use solve_ik::{Body, IkFiller, IkParams};

use self::{
    canvas::{Canvas, Piece},
    mixture::{Mixture, Stock, Tried},
    rival::Rival,
    rivals::compete,
};
use crate::{Edges, Joined, own_axes::OwnAxes};

/// Where the neighbours expect to err by more, other methods are asked too.
const POOR_M: f64 = 0.025;

/// Where they expect to err by more, even those that take long.
const HOPELESS_M: f64 = 0.06;

/// A fill that expects to err by more tells nothing about a body.
const MOST_M: f64 = 1.0;

/// In shorter gaps a curve through the marker may be as good as anything.
const CURVE_S: f64 = 0.12;

/// What a user may ask of [`Auto`].
#[derive(Debug, Clone, Default)]
pub struct AutoParams {
    /// Gaps that it expects to fill with a larger error stay open; positive. `None`: a metre, which is no error but a
    /// sign that nothing in the take is like the gap.
    ///
    /// # Units
    /// Metres, root mean square of the 3-D error over a gap.
    pub max_error_m: Option<f64>,
    /// What becomes of gaps that reach to where the start or end of the take shows no marker at all: they stay open, or
    /// are filled by curves that hold the nearest position and by models that go on moving.
    pub edges: Edges,
    /// Other takes of the session to learn from: the same person with the same markers, by whose names they go.
    pub session: Vec<Arc<Take>>,
}

/// Fills each gap with a mixture of the methods that do best in pseudo-gaps like it.
///
/// For one gap:
/// 1. Eight pseudo-gaps of its length, with the same neighbours seen, are cut where the marker is observed.
/// 2. Regressions on the neighbours ([`Ensemble`]) fill gap and pseudo-gaps; given other takes of the session, they
///    learn from those as well.
/// 3. In gaps of up to a tenth of a second, where no neighbour is seen, and where the regressions err by centimetres in
///    the pseudo-gaps, methods of other kinds fill them too: curves, principal components, and in longer gaps the
///    dynamical systems `lds` and `bolero-sc` and the body of `ik`. They work on the take as filled so far.
/// 4. The fill is the mixture with the least error in the pseudo-gaps, of which those count most that are like the
///    gap. That error, by the distance from the borders, is the sigma of each filled sample: about 68 % of errors are
///    within one sigma, 95 % within two.
/// 5. A fill that leaves the samples beside the gap faster than bodies can is drawn to them.
///
/// # Cost
/// Linear in the number of gaps; memory linear in the frames of the take.
pub struct Auto {
    params: AutoParams,
    rivals: Vec<Rival>,
}

/// Methods that learn a model of the whole take.
pub(crate) struct Models {
    pub lds: Box<dyn GapFiller>,
    pub bolero: Box<dyn GapFiller>,
    pub ik: Box<dyn GapFiller>,
}

impl std::fmt::Debug for Auto {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Auto").field("params", &self.params).finish_non_exhaustive()
    }
}

impl Auto {
    /// A filler with these parameters, and with dynamical systems and bodies as they come.
    ///
    /// # Errors
    /// [`FillError::Parameter`] that names the field, its value and the rule.
    pub fn new(params: AutoParams) -> Result<Self, FillError> {
        let lds = LdsFiller::new(LdsFillerParams::default())?;
        let bolero = BoleroSc::new(BoleroScParams::default())?;
        let failed = |source| FillError::Method { method: "ik", source: Box::new(source) };
        let ik = IkFiller::new(Body::built_in(), IkParams::default()).map_err(failed)?;
        let models = Models {
            lds: Box::new(Joined::new(lds)),
            bolero: Box::new(Joined::new(bolero)),
            ik: Box::new(ik),
        };
        Self::with_models(params, models)
    }

    /// A filler with these parameters and these models.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(crate) fn with_models(params: AutoParams, models: Models) -> Result<Self, FillError> {
        if let Some(value) = params.max_error_m.filter(|&m| !(m.is_finite() && m > 0.0)) {
            let rule = "positive and finite";
            return Err(FillError::Parameter { field: "max_error_m", value, rule });
        }
        let edges = params.edges;
        let rivals = vec![
            Rival::quick("spline", 1.2, CubicSpline { edges }),
            Rival::quick("pchip", 1.0, OwnAxes::new(Pchip { edges })),
            Rival::quick("vicon-spline", 1.6, QuinticSpline),
            Rival::quick("pca", 0.8, OwnAxes::new(Pca::default())),
            Rival::model("lds", models.lds),
            Rival::model("bolero-sc", models.bolero),
            Rival { growth: 0.4, body: true, ..Rival::model("ik", models.ik) },
        ];
        Ok(Self { params, rivals })
    }
}

impl GapFiller for Auto {
    fn name(&self) -> &'static str {
        "auto"
    }

    fn fill_observed(
        &self,
        take: &Take,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Result<Filled, FillError> {
        let gaps = take.gaps();
        if gaps.is_empty() {
            let report = FillReport::new(self.name(), Termination::NothingToFill);
            return Ok(Filled::unchanged(take, report)?);
        }
        if take.observed().count() == 0 {
            return Err(FillError::NothingObserved);
        }
        let mut report = FillReport::new(self.name(), Termination::ClosedForm);
        let lit = lit(take);
        let mut seen = Vec::new();
        for gap in gaps {
            match self.hopeless(take, &gap, &lit) {
                Some(reason) => report.refusals.push(Refused { gap, reason }),
                None => seen.push(gap),
            }
        }

        let mut canvas = Canvas::new(take);
        let others = &self.params.session;
        let session = (!others.is_empty()).then(|| Session::new(take, others)).transpose()?;
        let mut ensemble = Ensemble::new(take).with_session(session.as_ref());
        for (k, gap) in seen.iter().enumerate() {
            canvas.add(local(take, &mut ensemble, gap));
            let expected = canvas.square_m2(gap).unwrap_or(0.0).sqrt();
            let done = IterReport { iteration: k + 1, limit: seen.len(), objective: expected };
            if observer(&done).is_break() {
                report.termination = Termination::Stopped;
                break;
            }
        }
        if report.termination != Termination::Stopped {
            self.compete(take, &mut canvas)?;
        }
        for gap in seen {
            match self.settle(&mut canvas, &gap, report.termination) {
                Ok(choice) => report.choices.push(choice),
                Err(reason) => report.refusals.push(Refused { gap, reason }),
            }
        }
        Ok(Filled::merge(take, canvas.into_estimates(), report)?)
    }
}

/// A gap filled from its neighbours, piece by piece.
fn local(take: &Take, ensemble: &mut Ensemble<'_>, gap: &Gap) -> Vec<Piece> {
    let piece = |mut part: Part| {
        for candidate in &mut part.candidates {
            let growth = growth::OF_MODELS;
            growth::extrapolate(candidate, &part.pseudo_gaps, part.frames.len(), growth);
        }
        let frames = part.frames.clone();
        let runs: Vec<_> = part.pseudo_gaps.iter().map(|gap| gap.frames.clone()).collect();
        let likeness = pace::likeness(take, gap.marker, &frames, &runs);
        let tried =
            Tried { pseudo_gaps: &part.pseudo_gaps, scored: &part.scored, likeness: &likeness };
        let fill = (!part.candidates.is_empty())
            .then(|| Mixture::of(&part.candidates, tried, &frames, part.sides, take.rate_hz()));
        let mut piece = Piece { marker: gap.marker, frames, fill, stock: None };
        if piece.fill.is_some() && is_contested(&piece, take.rate_hz()) {
            piece.stock = Some(Stock {
                candidates: part.candidates,
                pseudo_gaps: part.pseudo_gaps,
                scored: part.scored,
            });
        }
        piece
    };
    ensemble.parts(gap).into_iter().map(piece).collect()
}

/// From the first to the last frame that shows any marker. What a body does before and after nobody can know.
fn lit(take: &Take) -> Range<usize> {
    let shows = |&t: &usize| (0..take.marker_count()).any(|m| take.is_observed(t, m));
    let first = (0..take.frames()).find(shows).unwrap_or(0);
    first..(first..take.frames()).rev().find(shows).map_or(first, |t| t + 1)
}

/// Whether other methods may do better than the neighbours.
fn is_contested(piece: &Piece, rate_hz: f64) -> bool {
    is_short(piece.frames.len(), rate_hz)
        || piece.fill.as_ref().is_none_or(|fill| fill.is_poor(POOR_M))
}

/// Whether a gap of so many frames is one for curves.
fn is_short(frames: usize, rate_hz: f64) -> bool {
    frames as f64 <= CURVE_S * rate_hz
}

impl Auto {
    /// Why nothing is to be tried for a gap; `None` where something is.
    fn hopeless(&self, take: &Take, gap: &Gap, lit: &Range<usize>) -> Option<Refusal> {
        let inside = gap.frames.start >= lit.start && gap.frames.end <= lit.end;
        if gap.context(take.frames()) == GapContext::Whole {
            Some(Refusal::NeverSeen)
        } else if inside || self.params.edges == Edges::Hold {
            None
        } else {
            Some(Refusal::OneSided)
        }
    }

    /// Asks other methods where these may do better than the neighbours.
    fn compete(&self, take: &Take, canvas: &mut Canvas<'_>) -> Result<(), FillError> {
        let rate_hz = take.rate_hz();
        let base = canvas.filled_but(&|piece| is_contested(piece, rate_hz))?;
        let lit = lit(take);
        let open: Vec<Gap> = base
            .gaps()
            .into_iter()
            .filter(|gap| self.hopeless(take, gap, &lit).is_none())
            .collect();
        if open.is_empty() {
            return Ok(());
        }
        let costly = canvas.pieces().any(|piece| {
            !is_short(piece.frames.len(), rate_hz)
                && piece.fill.as_ref().is_none_or(|fill| fill.is_poor(HOPELESS_M))
        });
        for answer in compete(&base, &open, &|gap| canvas.stock(gap), &self.rivals, costly) {
            canvas.offer(&answer.gap, &answer.mixture, answer.of_stock);
        }
        Ok(())
    }

    /// Finishes a gap, or gives the reason why it stays open.
    fn settle(
        &self,
        canvas: &mut Canvas<'_>,
        gap: &Gap,
        termination: Termination,
    ) -> Result<Choice, Refusal> {
        let stopped = termination == Termination::Stopped;
        let missing = if stopped { Refusal::Stopped } else { Refusal::NoNeighbour };
        let choice = canvas.settle(gap).ok_or(missing)?;
        let limit_m = self.params.max_error_m.unwrap_or(MOST_M);
        match choice.expected_m {
            Some(expected_m) if expected_m > limit_m => {
                canvas.erase(gap);
                Err(Refusal::TooUncertain { expected_m, limit_m })
            }
            None if self.params.max_error_m.is_some() => {
                canvas.erase(gap);
                Err(Refusal::Untested)
            }
            _ => Ok(choice),
        }
    }
}
