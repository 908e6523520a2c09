//! One gap: borders, neighbours, and the frames between.

use mocap_core::{Gap, Refusal, Take};

use crate::{
    EdmParams,
    neighbours::{Neighbour, choose, rank},
    params::MAX_NEIGHBOURS,
    solve::Borders,
};

/// Spread in metres below which neighbours are trusted alike.
const TRUSTED_M: f64 = 0.001;

/// So few neighbours throughout a gap that each frame looks for its own.
const FEW: usize = 3;

/// Fills the gaps of one marker.
pub(crate) struct MarkerFiller<'a> {
    take: &'a Take,
    params: &'a EdmParams,
    marker: usize,
    /// Frames that show the marker.
    seen: usize,
    ranking: Vec<Neighbour>,
}

impl<'a> MarkerFiller<'a> {
    pub fn new(take: &'a Take, params: &'a EdmParams, marker: usize) -> Self {
        let seen = take.observed().marker(marker).iter().filter(|&&seen| seen).count();
        Self { take, params, marker, seen, ranking: rank(take, marker, params.min_shared) }
    }

    /// Positions for the frames of the gap.
    pub fn fill(&self, gap: &Gap) -> Result<Vec<[f64; 3]>, Refusal> {
        if self.seen < self.params.min_shared {
            let needed = self.params.min_shared;
            return Err(Refusal::TooFewSamples { seen: self.seen, needed });
        }
        let start = gap.frames.start.checked_sub(1);
        let end = Some(gap.frames.end).filter(|&e| e < self.take.frames());
        // A gap at the start or the end of the take has one border, which counts as both.
        let Some((start, end)) = start.or(end).zip(end.or(start)) else {
            return Err(Refusal::NeverSeen);
        };
        let seen_at = |m: usize, t: usize| self.take.is_observed(t, m);
        let at_borders = |m: usize| seen_at(m, start) && seen_at(m, end);
        let whole = choose(&self.ranking, self.params, |m| {
            at_borders(m) && gap.frames.clone().all(|t| seen_at(m, t))
        });
        let mut cast = Cast::of(self, [start, end], whole.collect());
        let own = cast.neighbours.len() < FEW;
        let mut positions = Vec::with_capacity(gap.len());
        for t in gap.frames.clone() {
            if own {
                let here =
                    || choose(&self.ranking, self.params, |m| at_borders(m) && seen_at(m, t));
                if !here().eq(cast.neighbours.iter().copied()) {
                    cast = Cast::of(self, [start, end], here().collect());
                }
            }
            if cast.neighbours.is_empty() {
                return Err(Refusal::NoNeighbour);
            }
            let share = if start == end { 0.0 } else { (t - start) as f64 / (end - start) as f64 };
            let position = cast.solve(self, share, t);
            if !position.iter().all(|c| c.is_finite()) {
                return Err(Refusal::NotFinite);
            }
            positions.push(position);
        }
        Ok(positions)
    }
}

/// Neighbours with their poses at the borders.
struct Cast {
    neighbours: Vec<Neighbour>,
    borders: Borders,
}

impl Cast {
    fn of(filler: &MarkerFiller<'_>, borders: [usize; 2], neighbours: Vec<Neighbour>) -> Self {
        let weights =
            neighbours.iter().map(|n| 1.0 / (n.variance + TRUSTED_M * TRUSTED_M)).collect();
        let [before, after] = borders.map(|t| {
            let members = std::iter::once(filler.marker).chain(neighbours.iter().map(|n| n.marker));
            members.map(|m| point(filler.take, t, m)).collect::<Vec<_>>()
        });
        Self { borders: Borders::new([&before, &after], weights), neighbours }
    }

    /// The position at a frame, so far on the way from border to border.
    fn solve(&self, filler: &MarkerFiller<'_>, share: f64, t: usize) -> [f64; 3] {
        let mut here = [[0.0; 3]; MAX_NEIGHBOURS];
        for (place, neighbour) in here.iter_mut().zip(&self.neighbours) {
            *place = point(filler.take, t, neighbour.marker);
        }
        self.borders.solve(share, &here[..self.neighbours.len()], filler.params.solver)
    }
}

/// The position of a marker; NaN where it is missing.
fn point(take: &Take, t: usize, m: usize) -> [f64; 3] {
    let positions = take.positions();
    std::array::from_fn(|a| positions[(t, m, a)])
}
