//! Where the pieces of a fill come together.

use std::{collections::BTreeMap, ops::Range};

use locality_ridge::join;
use mocap_core::{Choice, CoreError, Estimates, Gap, Take};
use ndarray::Array2;

use super::{
    ease,
    mixture::{Mixture, Stock},
};

/// A step between two pieces is spread over this long on either side.
const BLEND_S: f64 = 0.1;

/// A run of frames of one gap.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub marker: usize,
    pub frames: Range<usize>,
    pub fill: Option<Mixture>,
    /// What the fill was mixed from, if it is poor.
    pub stock: Option<Stock>,
}

/// The pieces of all gaps, and the finished fill.
pub(super) struct Canvas<'a> {
    take: &'a Take,
    /// By marker and first frame.
    pieces: BTreeMap<(usize, usize), Piece>,
    estimates: Estimates,
}

impl<'a> Canvas<'a> {
    pub fn new(take: &'a Take) -> Self {
        let shape = (take.frames(), take.marker_count());
        let estimates = Estimates {
            positions: take.positions().to_owned(),
            sigma_m: Some(Array2::from_elem(shape, f64::NAN)),
        };
        Self { take, pieces: BTreeMap::new(), estimates }
    }

    pub fn add(&mut self, pieces: Vec<Piece>) {
        for piece in pieces {
            self.pieces.insert((piece.marker, piece.frames.start), piece);
        }
    }

    pub fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.pieces.values()
    }

    /// The take with every piece filled but those that are `poor`.
    pub fn filled_but(&self, poor: &dyn Fn(&Piece) -> bool) -> Result<Take, CoreError> {
        let mut positions = self.take.positions().to_owned();
        for piece in self.pieces().filter(|piece| !poor(piece)) {
            let fills = piece.fill.iter().flat_map(|fill| &fill.positions);
            for (t, p) in piece.frames.clone().zip(fills) {
                for (a, c) in p.iter().enumerate() {
                    positions[(t, piece.marker, a)] = *c;
                }
            }
        }
        Take::from_positions(
            std::sync::Arc::clone(self.take.markers()),
            self.take.rate_hz(),
            positions,
        )
    }

    /// Another fill of some frames: pieces inside that have one already are mixed with it, or replaced where it was
    /// mixed from theirs.
    pub fn offer(&mut self, gap: &Gap, other: &Mixture, replace: bool) {
        let inside = (gap.marker, gap.frames.start)..(gap.marker, gap.frames.end);
        for (_, piece) in self.pieces.range_mut(inside) {
            let part = piece.frames.start - gap.frames.start..piece.frames.end - gap.frames.start;
            let other = Mixture {
                positions: other.positions[part.clone()].to_vec(),
                sigma_m: other.sigma_m[part].to_vec(),
                ..other.clone()
            };
            let own = piece.fill.as_ref().filter(|_| !replace);
            piece.fill = Some(own.map_or(other.clone(), |own| own.with(&other)));
        }
    }

    /// What a fill of exactly these frames was mixed from.
    pub fn stock(&self, gap: &Gap) -> Option<&Stock> {
        let piece = self.pieces.get(&(gap.marker, gap.frames.start));
        piece.filter(|piece| piece.frames == gap.frames)?.stock.as_ref()
    }

    /// Mean square error that is expected in a gap, in m².
    pub fn square_m2(&self, gap: &Gap) -> Option<f64> {
        let squares: Vec<f64> =
            self.of_gap(gap).filter_map(|piece| piece.fill.as_ref()?.square_m2).collect();
        (!squares.is_empty()).then(|| squares.iter().sum::<f64>() / squares.len() as f64)
    }

    /// Puts the pieces of a gap together; `None` if one has no fill.
    pub fn settle(&mut self, gap: &Gap) -> Option<Choice> {
        let pieces: Vec<&Piece> = self.of_gap(gap).collect();
        let fills = pieces.iter().map(|piece| piece.fill.as_ref()).collect::<Option<Vec<_>>>()?;
        if fills.is_empty() {
            return None;
        }
        let span = gap.frames.start.saturating_sub(1)..(gap.frames.end + 1).min(self.take.frames());
        let mut places: Vec<Option<[f64; 3]>> =
            span.clone().map(|t| self.take.position(t, gap.marker)).collect();
        let mut runs = Vec::new();
        if span.start < gap.frames.start {
            runs.push(0..1);
        }
        let mut sigmas = Vec::with_capacity(gap.len());
        for (piece, fill) in pieces.iter().zip(&fills) {
            let run = piece.frames.start - span.start..piece.frames.end - span.start;
            for (place, p) in places[run.clone()].iter_mut().zip(&fill.positions) {
                *place = Some(*p);
            }
            sigmas.extend(&fill.sigma_m);
            runs.push(run);
        }
        if span.end > gap.frames.end {
            runs.push(span.len() - 1..span.len());
        }
        if pieces.len() > 1 {
            join(&mut places, &runs, BLEND_S * self.take.rate_hz());
        }
        let shares = shares(&pieces, &fills, gap.len());
        let square = sigmas.iter().map(|s| s * s).sum::<f64>() / sigmas.len() as f64;
        let inside = gap.frames.start - span.start..gap.frames.end - span.start;
        for (t, (place, sigma)) in gap.frames.clone().zip(places[inside].iter().zip(&sigmas)) {
            for (a, c) in place.iter().flatten().enumerate() {
                self.estimates.positions[(t, gap.marker, a)] = *c;
            }
            if let Some(all) = &mut self.estimates.sigma_m {
                all[(t, gap.marker)] = *sigma;
            }
        }
        self.ease(gap);
        let expected_m = square.is_finite().then(|| square.sqrt());
        Some(Choice { gap: gap.clone(), expected_m, shares })
    }

    /// Draws a fill to the samples beside it where no body could move as fast.
    fn ease(&mut self, gap: &Gap) {
        let positions = &self.estimates.positions;
        let path = |t: usize| {
            let filled = gap.frames.contains(&t);
            let place = || std::array::from_fn(|a| positions[(t, gap.marker, a)]);
            let seen = || (t < self.take.frames()).then(|| self.take.position(t, gap.marker));
            if filled { Some(place()) } else { seen().flatten() }
        };
        let Some(excess) = ease::excess(&path, gap, self.take.rate_hz()) else { return };
        for (t, off) in gap.frames.clone().zip(excess) {
            for (a, c) in off.into_iter().enumerate() {
                self.estimates.positions[(t, gap.marker, a)] -= c;
            }
        }
    }

    /// Leaves a gap open.
    pub fn erase(&mut self, gap: &Gap) {
        for t in gap.frames.clone() {
            for a in 0..3 {
                self.estimates.positions[(t, gap.marker, a)] = f64::NAN;
            }
        }
    }

    pub fn into_estimates(self) -> Estimates {
        self.estimates
    }

    fn of_gap(&self, gap: &Gap) -> impl Iterator<Item = &Piece> {
        let inside = (gap.marker, gap.frames.start)..(gap.marker, gap.frames.end);
        self.pieces.range(inside).map(|(_, piece)| piece)
    }
}

/// Shares of the methods in all frames of a gap.
fn shares(pieces: &[&Piece], fills: &[&Mixture], frames: usize) -> Vec<(String, f64)> {
    let mut shares: Vec<(&'static str, f64)> = Vec::new();
    for (piece, fill) in pieces.iter().zip(fills) {
        let part = piece.frames.len() as f64 / frames as f64;
        for &(name, share) in &fill.shares {
            match shares.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum += part * share,
                None => shares.push((name, part * share)),
            }
        }
    }
    // Names break ties, so that the order is always the same.
    shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(b.0)));
    shares.into_iter().map(|(name, share)| (name.to_owned(), share)).collect()
}
