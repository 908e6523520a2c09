use std::ops::ControlFlow;

use mocap_core::{IterReport, Termination};

use super::CalibrationRound;
use crate::{
    IkParams,
    body::Body,
    bridge::Bridges,
    frame::Fit,
    sight::Sight,
    track::{self, Inertia, Scout, Track},
    tree::Tree,
};

/// A body on a take, ready to be tracked.
pub(crate) struct Ready {
    pub(crate) body: Body,
    pub(crate) tree: Tree,
    pub(crate) sight: Sight,
    pub(crate) scout: Scout,
    pub(crate) rounds: Vec<CalibrationRound>,
}

/// Poses of a take, and why they ended.
pub(crate) struct Outcome {
    pub(crate) track: Track,
    pub(crate) termination: Termination,
}

impl Outcome {
    pub(crate) fn steps(&self) -> usize {
        self.track.fits.iter().map(|fit| fit.iterations).sum()
    }
}

impl Ready {
    /// Tracks every frame, and again those in which a joint is not seen, this time bridged.
    pub(crate) fn poses(
        &self,
        params: &IkParams,
        rate_hz: f64,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Outcome {
        let inertia = Inertia::new(params, rate_hz);
        let mut outcome = self.track(params, &inertia, observer);
        if outcome.termination == Termination::Stopped {
            return outcome;
        }
        let bridges =
            Bridges::new(&self.tree, &self.sight, &outcome.track.states, inertia, rate_hz);
        if let Some(bridges) = bridges {
            let redone = track::retrack(&self.tree, &self.sight, params, &outcome.track, &bridges);
            for (frame, state, fit) in redone {
                outcome.track.states[frame] = state;
                outcome.track.fits[frame] = fit;
            }
        }
        outcome
    }

    /// Tracks a batch of chunks at a time, so that the observer is asked in between.
    fn track(
        &self,
        params: &IkParams,
        inertia: &Inertia,
        observer: &mut dyn FnMut(&IterReport) -> ControlFlow<()>,
    ) -> Outcome {
        let frames = self.sight.frames();
        let mut track =
            Track { states: Vec::with_capacity(frames), fits: Vec::with_capacity(frames) };
        let mut objective = 0.0;
        let mut termination = Termination::Converged;
        while track.states.len() < frames {
            let start = track.states.len();
            let end = (start + track::BATCH).min(frames);
            let part =
                track::track(&self.tree, &self.sight, params, &self.scout, inertia, start..end);
            objective += part.fits.iter().map(|fit| fit.cost).sum::<f64>();
            track.states.extend(part.states);
            track.fits.extend(part.fits);
            let report = IterReport { iteration: end, limit: frames, objective };
            if observer(&report).is_break() {
                termination = Termination::Stopped;
                break;
            }
        }
        let held = Fit { cost: f64::NAN, iterations: 0, converged: false };
        for frame in track.states.len()..frames {
            track.states.push(self.scout.states[frame / self.scout.stride].clone());
            track.fits.push(held);
        }
        Outcome { track, termination }
    }
}
