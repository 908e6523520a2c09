use std::{
    borrow::Borrow,
    collections::{BTreeMap, HashMap},
};

use mocap_core::{GapContext, Take};

use crate::{
    AugmentError, GapHistogram, LengthSpan, LogNormal, LogNormalFit, OcclusionModel,
    error::check_cells, model::same_rate,
};

/// Which markers go missing how often, and for how long, over a set of takes.
///
/// Markers are matched by their names without the subject prefix. A marker that a take never shows
/// counts as not worn in that take, not as occluded.
#[derive(Debug, Clone, PartialEq)]
pub struct GapStatistics {
    rate_hz: f64,
    markers: Vec<MarkerOcclusion>,
    lengths: Vec<LengthCount>,
}

/// How often one marker was missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarkerOcclusion {
    /// Name without subject prefix.
    pub name: String,
    /// Frames of the takes in which the marker was worn.
    pub worn_frames: u64,
    /// Those of them in which it was missing.
    pub missing_frames: u64,
    /// Number of its gaps.
    pub gaps: u64,
}

/// How many gaps were seen to last this many frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LengthCount {
    /// Length in frames, as far as it was recorded.
    pub frames: usize,
    /// Gaps with observed samples on both sides.
    pub whole: u64,
    /// Gaps cut by the start or the end of their take.
    pub cut: u64,
}

impl MarkerOcclusion {
    /// Share of the frames in which the marker was missing.
    #[must_use]
    pub fn probability(&self) -> f64 {
        share(self.missing_frames, self.worn_frames)
    }
}

impl GapStatistics {
    /// Counts the gaps of takes, which may be borrowed or come one by one from an iterator.
    ///
    /// # Errors
    /// [`AugmentError::NoTakes`], [`AugmentError::EmptyTake`], and [`AugmentError::MixedRates`] if two rates differ by more than 1 %.
    pub fn from_takes(takes: impl IntoIterator<Item: Borrow<Take>>) -> Result<Self, AugmentError> {
        let mut count = Count::default();
        for take in takes {
            count.add(take.borrow())?;
        }
        let rate_hz = count.rate_hz.ok_or(AugmentError::NoTakes)?;
        let lengths = count.lengths.into_iter();
        let lengths = lengths.map(|(frames, [whole, cut])| LengthCount { frames, whole, cut });
        Ok(Self { rate_hz, markers: count.markers, lengths: lengths.collect() })
    }

    /// Rate of the takes in Hz, in whose frames lengths are counted.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Every marker, in the order in which the takes brought them.
    #[must_use]
    pub fn markers(&self) -> &[MarkerOcclusion] {
        &self.markers
    }

    /// The gaps of all markers by length, shortest first.
    #[must_use]
    pub fn lengths(&self) -> &[LengthCount] {
        &self.lengths
    }

    /// Share of the cells of worn markers that were missing.
    #[must_use]
    pub fn occlusion(&self) -> f64 {
        let total = |f: fn(&MarkerOcclusion) -> u64| self.markers.iter().map(f).sum();
        share(total(|m| m.missing_frames), total(|m| m.worn_frames))
    }

    /// The gaps by their recorded lengths, those cut by an end of their take included.
    ///
    /// Cut gaps lasted longer than recorded, so in short takes this histogram is too short;
    /// [`fit`](Self::fit) is not.
    ///
    /// # Errors
    /// [`AugmentError::EmptyHistogram`] if the takes have no gaps.
    pub fn histogram(&self) -> Result<GapHistogram, AugmentError> {
        let gaps = |count: &LengthCount| (count.whole + count.cut) as f64;
        GapHistogram::new(self.lengths.iter().map(|count| (count.frames, gaps(count))))
    }

    /// The log-normal law behind the lengths, gaps cut by the ends of takes right-censored.
    ///
    /// Of the gaps that begin inside a take, those cut by its end are censored; that sample has no
    /// bias. The gaps that end inside a take are another such sample. The likelihood is the mean of
    /// both, so that a whole gap weighs 1 and a cut one ½. Gaps that began before the take would
    /// bias the first sample, since long gaps are likelier to reach over a start.
    ///
    /// # Errors
    /// [`AugmentError::TooFewLengths`] if fewer than two different lengths were seen in full.
    pub fn fit(&self) -> Result<LogNormalFit, AugmentError> {
        let spans = self.lengths.iter().flat_map(|count| {
            [
                LengthSpan::exact(count.frames, count.whole as f64),
                LengthSpan::at_least(count.frames, 0.5 * count.cut as f64),
            ]
        });
        LogNormal::fit(&spans.collect::<Vec<_>>())
    }

    /// What a sampler needs to draw such gaps: the recorded lengths and the probability of each marker.
    ///
    /// # Errors
    /// [`AugmentError::EmptyHistogram`] if the takes have no gaps.
    pub fn model(&self) -> Result<OcclusionModel, AugmentError> {
        self.model_with(self.histogram()?)
    }

    /// The same probabilities with the fitted lengths of 1 to `longest` frames.
    ///
    /// # Errors
    /// As [`fit`](Self::fit) and [`LogNormal::histogram`].
    pub fn fitted_model(&self, longest: usize) -> Result<OcclusionModel, AugmentError> {
        self.model_with(self.fit()?.law.histogram(longest)?)
    }

    fn model_with(&self, lengths: GapHistogram) -> Result<OcclusionModel, AugmentError> {
        let markers = self.markers.iter().map(|m| (m.name.clone(), m.probability()));
        OcclusionModel::new(markers, lengths, self.rate_hz)
    }
}

#[derive(Default)]
struct Count {
    rate_hz: Option<f64>,
    markers: Vec<MarkerOcclusion>,
    index: HashMap<String, usize>,
    lengths: BTreeMap<usize, [u64; 2]>,
}

impl Count {
    fn add(&mut self, take: &Take) -> Result<(), AugmentError> {
        check_cells(take.frames(), take.marker_count())?;
        let (first_hz, other_hz) = (*self.rate_hz.get_or_insert(take.rate_hz()), take.rate_hz());
        if !same_rate(first_hz, other_hz) {
            return Err(AugmentError::MixedRates { first_hz, other_hz });
        }
        for m in 0..take.marker_count() {
            self.add_marker(take, m);
        }
        Ok(())
    }

    fn add_marker(&mut self, take: &Take, m: usize) {
        let slot = self.slot(take.markers().split(m).1);
        let gaps = take.gaps_of(m);
        let context = |gap: &mocap_core::Gap| gap.context(take.frames());
        if gaps.iter().any(|gap| context(gap) == GapContext::Whole) {
            return;
        }
        let marker = &mut self.markers[slot];
        marker.worn_frames += take.frames() as u64;
        for gap in &gaps {
            marker.missing_frames += gap.len() as u64;
            marker.gaps += 1;
            let cut = usize::from(context(gap) != GapContext::Interior);
            self.lengths.entry(gap.len()).or_default()[cut] += 1;
        }
    }

    fn slot(&mut self, name: &str) -> usize {
        if let Some(&slot) = self.index.get(name) {
            return slot;
        }
        self.index.insert(name.to_owned(), self.markers.len());
        let name = name.to_owned();
        self.markers.push(MarkerOcclusion { name, worn_frames: 0, missing_frames: 0, gaps: 0 });
        self.markers.len() - 1
    }
}

fn share(part: u64, whole: u64) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}
