//! One gap: borders, neighbours, and the frames between.

use mocap_core::{Gap, Refusal, Take};

use crate::{
    EdmParams,
    neighbours::{Neighbour, choose, rank},
    solve::{Pose, Setting},
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
    ranking: Vec<Neighbour>,
}

impl<'a> MarkerFiller<'a> {
    pub fn new(take: &'a Take, params: &'a EdmParams, marker: usize) -> Self {
        Self { take, params, marker, ranking: rank(take, marker, params.min_shared) }
    }

    /// Positions for the frames of the gap.
    pub fn fill(&self, gap: &Gap) -> Result<Vec<[f64; 3]>, Refusal> {
        let seen = self.take.observed().marker(self.marker).iter().filter(|&&seen| seen).count();
        if seen < self.params.min_shared {
            return Err(Refusal::TooFewSamples { seen, needed: self.params.min_shared });
        }
        let start = gap.frames.start.checked_sub(1);
        let end = Some(gap.frames.end).filter(|&e| e < self.take.frames());
        let borders: Vec<usize> = start.into_iter().chain(end).collect();
        let seen_at = |m: usize, t: usize| self.take.is_observed(t, m);
        let at_borders = |m: usize| borders.iter().all(|&t| seen_at(m, t));
        let whole = choose(&self.ranking, self.params, |m| {
            at_borders(m) && gap.frames.clone().all(|t| seen_at(m, t))
        });
        let mut cast = Cast::of(self, &borders, whole);
        let own = cast.neighbours.len() < FEW;
        let mut positions = Vec::with_capacity(gap.len());
        for t in gap.frames.clone() {
            if own {
                let here = choose(&self.ranking, self.params, |m| at_borders(m) && seen_at(m, t));
                if here != cast.neighbours {
                    cast = Cast::of(self, &borders, here);
                }
            }
            if cast.neighbours.is_empty() {
                return Err(Refusal::NoNeighbour);
            }
            let position = cast.solve(self, t);
            if !position.iter().all(|c| c.is_finite()) {
                return Err(Refusal::NotFinite);
            }
            positions.push(position);
        }
        Ok(positions)
    }

    fn pose(&self, t: usize, neighbours: &[Neighbour]) -> Pose {
        Pose { marker: point(self.take, t, self.marker), neighbours: self.places(t, neighbours) }
    }

    fn places(&self, t: usize, neighbours: &[Neighbour]) -> Vec<[f64; 3]> {
        neighbours.iter().map(|n| point(self.take, t, n.marker)).collect()
    }
}

/// Neighbours with their poses at the borders.
struct Cast {
    neighbours: Vec<Neighbour>,
    weights: Vec<f64>,
    /// Frame and pose of each border, in time order.
    borders: Vec<(usize, Pose)>,
}

impl Cast {
    fn of(filler: &MarkerFiller<'_>, borders: &[usize], neighbours: Vec<Neighbour>) -> Self {
        let weights =
            neighbours.iter().map(|n| 1.0 / (n.variance + TRUSTED_M * TRUSTED_M)).collect();
        let borders = borders.iter().map(|&t| (t, filler.pose(t, &neighbours))).collect();
        Self { neighbours, weights, borders }
    }

    /// The position at a frame, from the borders' distances in linear interpolation; those of one
    /// border stay as they are.
    fn solve(&self, filler: &MarkerFiller<'_>, t: usize) -> [f64; 3] {
        let share = |border: usize, other: usize| {
            t.abs_diff(other) as f64 / border.abs_diff(other).max(1) as f64
        };
        let shares: Vec<(f64, &Pose)> = match &self.borders[..] {
            [(s, before), (e, after)] => vec![(share(*s, *e), before), (share(*e, *s), after)],
            alone => alone.iter().map(|(_, pose)| (1.0, pose)).collect(),
        };
        let neighbours = filler.places(t, &self.neighbours);
        let setting = Setting { borders: &shares, neighbours: &neighbours, weights: &self.weights };
        setting.solve(filler.params.solver)
    }
}

/// The position of a marker; NaN where it is missing.
fn point(take: &Take, t: usize, m: usize) -> [f64; 3] {
    let positions = take.positions();
    std::array::from_fn(|a| positions[(t, m, a)])
}
