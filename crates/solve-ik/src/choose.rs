//! Frames to calibrate on.

use mocap_core::Rotation;

use crate::{calibrate::Sample, sight::Sight, track::Scout, tree::State};

/// Chooses frames among those of the scout, one after the other the one whose pose is farthest from those chosen
/// so far. Frames that show few markers are left out, where others show more.
pub(crate) fn diverse(scout: &Scout, sight: &Sight, count: usize) -> Vec<Sample> {
    /// Share of the most markers seen in a frame.
    const COMPLETE: f64 = 0.8;
    let frame = |k: usize| k * scout.stride;
    let shown = |k: usize| sight.at(frame(k)).len();
    let most = (0..scout.states.len()).map(shown).max().unwrap_or(0);
    let candidates: Vec<usize> =
        (0..scout.states.len()).filter(|&k| shown(k) as f64 >= COMPLETE * most as f64).collect();
    let mut distance = vec![f64::INFINITY; candidates.len()];
    let mut chosen = Vec::new();
    // The clearest of all, then the farthest of the rest.
    let mut next =
        (0..candidates.len()).max_by_key(|&c| (shown(candidates[c]), std::cmp::Reverse(c)));
    while let Some(c) = next.filter(|_| chosen.len() < count) {
        let state = &scout.states[candidates[c]];
        chosen.push(candidates[c]);
        for (d, &k) in distance.iter_mut().zip(&candidates) {
            *d = d.min(apart(state, &scout.states[k]));
        }
        next = (0..candidates.len())
            .filter(|&c| distance[c] > 0.0)
            .max_by(|&a, &b| distance[a].total_cmp(&distance[b]).then(b.cmp(&a)));
    }
    chosen.sort_unstable();
    let sample = |k: usize| Sample {
        seen: sight.at(frame(k)).to_vec(),
        state: scout.states[k].clone(),
        pose: None,
    };
    chosen.into_iter().map(sample).collect()
}

/// Sum of squared angles between two poses; where the body stands and faces does not count.
fn apart(a: &State, b: &State) -> f64 {
    let angle = |(p, q): (&Rotation, &Rotation)| p.inverse().after(*q).angle().powi(2);
    a.turns.iter().zip(&b.turns).skip(1).map(angle).sum()
}
