//! Errors in gaps that are longer than any pseudo-gap.

use locality_ridge::ensemble::{Candidate, PseudoGap};

/// Errors of regressions and models of motion grow with the length of a gap to this power.
pub(super) const OF_MODELS: f64 = 0.5;

/// Where pseudo-gaps are shorter than a gap of so many frames, makes the candidate's errors those to be expected at
/// its length, if errors grow with the length to the power `growth`.
///
/// Without it a curve that is good for short pseudo-gaps would win a gap that only a model of the body can bridge.
pub(super) fn extrapolate<'a>(
    candidate: &mut Candidate,
    pseudo_gaps: impl IntoIterator<Item = &'a PseudoGap>,
    frames: usize,
    growth: f64,
) {
    for (errors, tried) in candidate.errors.iter_mut().zip(pseudo_gaps) {
        let times = (frames as f64 / tried.frames.len() as f64).max(1.0).powf(growth);
        errors.iter_mut().flatten().for_each(|c| *c *= times);
    }
}

#[cfg(test)]
mod tests {
    use locality_ridge::ensemble::Sides;

    use super::*;

    #[test]
    fn errors_grow_in_longer_gaps_alone() {
        let pseudo_gap = |frames: std::ops::Range<usize>| PseudoGap {
            frames: frames.clone(),
            hidden: frames,
            sides: Sides { left: true, right: true },
        };
        let tried = [pseudo_gap(0..10), pseudo_gap(20..60)];
        let mut candidate = Candidate {
            name: "a",
            positions: Vec::new(),
            errors: vec![vec![[1.0, 0.0, 0.0]], vec![[1.0, 0.0, 0.0]]],
        };
        extrapolate(&mut candidate, &tried, 40, 0.5);
        assert_eq!(candidate.errors, [[[2.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]]);
    }
}
