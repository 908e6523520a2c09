//! The fills of Vicon Nexus under their rules: where a rule does not hold, the gap stays open.

mod pattern;
mod rigid;
mod seeds;

use mocap_core::{
    Estimates, FillError, FillReport, Filled, Gap, GapContext, Refusal, Refused, Take, Termination,
};

pub use pattern::PatternFill;
pub use rigid::RigidBodyFill;
pub use seeds::QuinticSpline;

/// One position a frame of a gap, or why not.
type Curve = Result<Vec<[f64; 3]>, Refusal>;

/// Fills gap by gap with what `prepare` finds out once about each marker that has gaps and is seen.
fn fill<D>(
    take: &Take,
    method: &str,
    prepare: impl Fn(usize) -> D,
    rule: impl Fn(&Gap, &D) -> Curve,
) -> Result<Filled, FillError> {
    let gaps = take.gaps();
    if gaps.is_empty() {
        return Ok(Filled::unchanged(take, FillReport::new(method, Termination::NothingToFill))?);
    }
    if take.observed().count() == 0 {
        return Err(FillError::NothingObserved);
    }
    let mut report = FillReport::new(method, Termination::ClosedForm);
    let mut positions = take.positions().to_owned();
    for of_marker in gaps.chunk_by(|g, h| g.marker == h.marker) {
        let marker = of_marker[0].marker;
        let is_seen = of_marker[0].context(take.frames()) != GapContext::Whole;
        let known = is_seen.then(|| prepare(marker));
        for gap in of_marker {
            match known.as_ref().map_or(Err(Refusal::NeverSeen), |known| rule(gap, known)) {
                Err(reason) => report.refusals.push(Refused { gap: gap.clone(), reason }),
                Ok(curve) => {
                    for (t, p) in gap.frames.clone().zip(curve) {
                        for (axis, c) in p.into_iter().enumerate() {
                            positions[(t, marker, axis)] = c;
                        }
                    }
                }
            }
        }
    }
    Ok(Filled::merge(take, Estimates { positions, sigma_m: None }, report)?)
}

/// Frames in which two markers must be seen together before one may be the other's donor.
const LEAST_TOGETHER: usize = 10;

/// The other markers, the one at the steadiest distance first.
fn steadiest(take: &Take, marker: usize) -> Vec<usize> {
    let mut found: Vec<(f64, usize)> = (0..take.marker_count())
        .filter(|&m| m != marker)
        .filter_map(|m| Some((variance_of_distance(take, marker, m)?, m)))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.into_iter().map(|(_, m)| m).collect()
}

fn variance_of_distance(take: &Take, a: usize, b: usize) -> Option<f64> {
    let mut first = None;
    let (mut n, mut sum, mut squares) = (0_usize, 0.0, 0.0);
    for d in (0..take.frames()).filter_map(|t| take.distance(t, a, b)) {
        // Around the first distance, so that no digits are lost where they hardly vary.
        let x = d - *first.get_or_insert(d);
        n += 1;
        sum += x;
        squares += x * x;
    }
    let mean = sum / n as f64;
    (n >= LEAST_TOGETHER).then(|| squares / n as f64 - mean * mean)
}

/// The last frame before a gap and the first one after it.
fn borders(take: &Take, gap: &Gap) -> (Option<usize>, Option<usize>) {
    (gap.frames.start.checked_sub(1), Some(gap.frames.end).filter(|&t| t < take.frames()))
}
