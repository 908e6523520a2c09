use mocap_core::{Gap, Holdout, MarkerSet, Mask, Take};

use crate::{
    AugmentError, GapSamplerParams, Neighbours, OcclusionModel, Rounding,
    counts::{Rates, fitting, gap_lengths, rates},
    dice::{Dice, Stream},
    error::check_cells,
    model::same_rate,
    place::Column,
};

/// Draws gaps like those that a model describes.
#[derive(Debug, Clone)]
pub struct GapSampler {
    model: OcclusionModel,
    params: GapSamplerParams,
}

/// What was asked of a marker, and what it got, as shares of its observed frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkerRate {
    /// The rate that `occlusion` and the model ask for.
    pub requested: f64,
    /// The rate after the limit.
    pub planned: f64,
    /// The rate of the gaps that were drawn and placed.
    pub realised: f64,
    /// Gaps that found no room.
    pub unplaced_gaps: usize,
}

/// Drawn gaps.
#[derive(Debug, Clone)]
pub struct GapDraw {
    /// The cells to hide, `(T, M)`; all of them observed.
    pub hidden: Mask,
    /// The gaps, marker by marker and in time order.
    pub gaps: Vec<Gap>,
    /// One entry a marker, `(M,)`.
    pub rates: Vec<MarkerRate>,
    /// Share of the observed cells that is hidden.
    pub occlusion: f64,
}

/// A take with drawn gaps.
#[derive(Debug, Clone)]
pub struct Sampled {
    /// The take with the gaps, and the truth.
    pub holdout: Holdout,
    /// The gaps and the rates.
    pub draw: GapDraw,
}

impl GapSampler {
    /// Combines what gaps are like with how many to draw.
    ///
    /// # Errors
    /// [`AugmentError::OutOfRange`], and [`AugmentError::AboveLimit`] if no spreading can reach the mean.
    ///
    /// ```
    /// use augment::{AugmentError, GapSampler, GapSamplerParams, Preset};
    /// let params = GapSamplerParams { occlusion: 1.2, ..GapSamplerParams::default() };
    /// let refused = GapSampler::new(Preset::FiveFinger.model()?, params);
    /// assert!(matches!(refused, Err(AugmentError::OutOfRange { name: "occlusion", .. })));
    /// # Ok::<(), AugmentError>(())
    /// ```
    pub fn new(model: OcclusionModel, params: GapSamplerParams) -> Result<Self, AugmentError> {
        params.check()?;
        Ok(Self { model, params })
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &GapSamplerParams {
        &self.params
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &OcclusionModel {
        &self.model
    }

    /// The same sampler with another seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.params.seed = seed;
        self
    }

    /// Hides gaps in a take.
    ///
    /// # Errors
    /// [`AugmentError::RateMismatch`] if the rates of take and model differ by more than 1 %, and as
    /// [`draw`](Self::draw).
    pub fn sample(&self, take: &Take) -> Result<Sampled, AugmentError> {
        let (model_hz, take_hz) = (self.model.rate_hz(), take.rate_hz());
        if !same_rate(model_hz, take_hz) {
            return Err(AugmentError::RateMismatch { model_hz, take_hz });
        }
        let near = self.params.occluder.map(|_| Neighbours::by_mean_distance(take)).transpose()?;
        let draw = self.draw(take.markers(), take.observed(), near.as_ref())?;
        let holdout = Holdout::new(take.clone(), &draw.hidden)?;
        Ok(Sampled { holdout, draw })
    }

    /// Draws gaps for a set of observed cells `(T, M)`, counted in frames at the model's rate.
    ///
    /// Lengths are placed from longest to shortest, each at a random place among observed frames,
    /// with an observed frame left on either side: drawn gaps touch neither each other, nor gaps
    /// of the take, nor its ends. Lengths for which a marker has no room are left out, and the
    /// others get their frames.
    ///
    /// # Errors
    /// [`AugmentError::EmptyTake`], [`AugmentError::UnlistedMarker`], [`AugmentError::NeverOccluded`];
    /// [`AugmentError::NeighbourCount`] if an occluder is asked for and `near` does not fit the
    /// markers; [`AugmentError::Core`] if `observed` has another number of markers than `markers`.
    ///
    /// Implements [Pan23] Eq. (6) and the placement below it.
    pub fn draw(
        &self,
        markers: &MarkerSet,
        observed: &Mask,
        near: Option<&Neighbours>,
    ) -> Result<GapDraw, AugmentError> {
        check_cells(observed.frames(), markers.len())?;
        check_columns(markers, observed)?;
        let found = near.map_or(0, Neighbours::markers);
        if self.params.occluder.is_some() && found != markers.len() {
            return Err(AugmentError::NeighbourCount { expected: markers.len(), found });
        }
        let rates = rates(&self.model.resolve(markers, self.params.unlisted)?, &self.params);
        let mut columns: Vec<_> = (0..markers.len()).map(|m| Column::new(observed, m)).collect();
        let frames: Vec<usize> = columns.iter().map(Column::free_frames).collect();
        let lengths = self.lengths(&rates, &columns, &frames)?;
        let unplaced = self.place_all(&mut columns, &lengths, near);
        collect(observed, columns, &frames, &rates, &unplaced)
    }

    /// The lengths of each marker, longest first.
    fn lengths(
        &self,
        rates: &Rates,
        columns: &[Column],
        frames: &[usize],
    ) -> Result<Vec<Vec<usize>>, AugmentError> {
        let mut dice = Dice::new(self.params.seed, Stream::Counts);
        let each = columns.iter().zip(frames).zip(&rates.planned);
        each.map(|((column, &frames), &rate)| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "≤ frames")]
            let allowed = (self.params.marker_limit * frames as f64) as usize;
            let longest = column.longest_room().min(allowed);
            let Some(fitting) = fitting(self.model.lengths(), longest)? else {
                return Ok(Vec::new());
            };
            let hidden = frames as f64 * rate;
            let lengths = gap_lengths(&fitting, hidden, self.params.rounding, &mut dice);
            let is_too_much = lengths.iter().sum::<usize>() > frames;
            if is_too_much && self.params.rounding == Rounding::Bernoulli {
                return Ok(gap_lengths(&fitting, hidden, Rounding::Floor, &mut dice));
            }
            Ok(lengths)
        })
        .collect()
    }

    /// Places the gaps of all markers, longest first, and counts those without room.
    fn place_all(
        &self,
        columns: &mut [Column],
        lengths: &[Vec<usize>],
        near: Option<&Neighbours>,
    ) -> Vec<usize> {
        let mut places = Dice::new(self.params.seed, Stream::Places);
        let mut occluders = Dice::new(self.params.seed, Stream::Occluders);
        let mut order: Vec<(usize, usize)> = lengths
            .iter()
            .enumerate()
            .flat_map(|(marker, lengths)| lengths.iter().map(move |&length| (length, marker)))
            .collect();
        order.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut visited = vec![0; columns.len()];
        let mut spent = vec![0; columns.len()];
        let mut unplaced = vec![0; columns.len()];
        for (length, marker) in order {
            visited[marker] += 1;
            if visited[marker] <= spent[marker] {
                continue;
            }
            spent[marker] += 1;
            let Some(frames) = columns[marker].place(length, &mut places) else {
                unplaced[marker] += 1;
                continue;
            };
            let (Some(occluder), Some(near)) = (self.params.occluder, near) else { continue };
            for &other in near.of(marker).iter().take(occluder.reach) {
                let Some(&open) = lengths[other].get(spent[other]) else { continue };
                let is_hidden = occluders.chance(occluder.coupling)
                    && columns[other].place_within(&frames, open, &mut occluders).is_some();
                spent[other] += usize::from(is_hidden);
            }
        }
        unplaced
    }
}

fn check_columns(markers: &MarkerSet, observed: &Mask) -> Result<(), AugmentError> {
    if observed.markers() == markers.len() {
        return Ok(());
    }
    let (what, frames) = ("observed mask", observed.frames());
    let expected = vec![frames, markers.len()];
    let found = vec![frames, observed.markers()];
    Err(mocap_core::CoreError::Shape { what, expected, found }.into())
}

fn collect(
    observed: &Mask,
    columns: Vec<Column>,
    frames: &[usize],
    rates: &Rates,
    unplaced: &[usize],
) -> Result<GapDraw, AugmentError> {
    let mut hidden = Mask::none(observed.frames(), observed.markers());
    let (mut gaps, mut reports) = (Vec::new(), Vec::with_capacity(columns.len()));
    let mut hidden_cells = 0_usize;
    for (m, column) in columns.into_iter().enumerate() {
        let mut own = column.into_gaps();
        own.sort_by_key(|gap| gap.frames.start);
        let mut count = 0_usize;
        for t in own.iter().flat_map(|gap| gap.frames.clone()) {
            hidden.insert(t, m)?;
            count += 1;
        }
        reports.push(MarkerRate {
            requested: rates.requested[m],
            planned: rates.planned[m],
            realised: count as f64 / frames[m].max(1) as f64,
            unplaced_gaps: unplaced[m],
        });
        hidden_cells += count;
        gaps.append(&mut own);
    }
    let cells = frames.iter().sum::<usize>().max(1);
    let occlusion = hidden_cells as f64 / cells as f64;
    Ok(GapDraw { hidden, gaps, rates: reports, occlusion })
}
