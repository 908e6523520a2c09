//! Which markers to learn a marker from, and in which frames.

use mocap_core::Take;

use crate::{LocalRidgeParams, frame::is_linear};

/// Distances that vary by less than 0.1 µm are constant up to rounding.
const CONSTANT_M2: f64 = 1e-14;

/// Markers a local frame needs.
const RIGID: usize = 3;

/// The markers of [`rank_with_spread`] alone.
pub(crate) fn rank(take: &Take, target: usize, params: &LocalRidgeParams) -> Vec<usize> {
    rank_with_spread(take, target, params).into_iter().map(|(m, _)| m).collect()
}

/// The markers that are seen together with `target` in at least `min_training` frames, at a distance
/// that spreads by no more than `max_spread_m`, with this spread in metres: those with the steadiest
/// distance first; of equally steady ones, the nearest first.
pub(crate) fn rank_with_spread(
    take: &Take,
    target: usize,
    params: &LocalRidgeParams,
) -> Vec<(usize, f64)> {
    let most = params.max_spread_m * params.max_spread_m;
    let mut found: Vec<(f64, f64, usize)> = (0..take.marker_count())
        .filter(|&m| m != target)
        .filter_map(|m| {
            let (variance, mean) = distance_moments(take, target, m, params.min_training)?;
            (variance <= most).then(|| (variance.max(CONSTANT_M2), mean, m))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    found.into_iter().map(|(variance, _, m)| (m, variance.sqrt())).collect()
}

/// Variance and mean of the distance over the frames that show both markers.
fn distance_moments(take: &Take, a: usize, b: usize, least: usize) -> Option<(f64, f64)> {
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
    (n >= least.max(1)).then(|| (squares / n as f64 - mean * mean, first.unwrap_or(0.0) + mean))
}

/// The markers to learn from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Neighbours {
    /// Steadiest first, the core in front.
    pub regressors: Vec<usize>,
    /// How many of the regressors carry the local frame.
    pub core: usize,
    /// Frames that show the target and all regressors.
    pub training: Vec<usize>,
}

impl Neighbours {
    /// Picks from `usable`, which is in order of rank.
    ///
    /// A marker that would cost too many training frames is passed over: half of the frames that show
    /// the target are to remain or, where that leaves fewer markers than the core, a quarter, an
    /// eighth, a sixteenth. Never fewer than `min_training`.
    pub fn choose(take: &Take, target: usize, usable: &[usize], params: &LocalRidgeParams) -> Self {
        let seen = take.observed().marker(target).iter().filter(|&&seen| seen).count();
        let pick = |share: usize| {
            let least = params.min_training.max(seen / share);
            pick(take, target, usable, params, least)
        };
        let mut best = pick(2);
        for share in [4, 8, 16, usize::MAX] {
            let rigid = best.regressors.len() >= RIGID.min(usable.len());
            let full = best.regressors.len() >= params.core.min(usable.len());
            if full || (rigid && share == usize::MAX) {
                break;
            }
            let next = pick(share);
            if next.regressors.len() > best.regressors.len() {
                best = next;
            }
        }
        best
    }

    /// The frame whose pose local frames refer to.
    pub fn reference_frame(&self) -> Option<usize> {
        self.training.get(self.training.len() / 2).copied()
    }

    /// Positions of the core in a frame.
    pub fn core_pose(&self, take: &Take, t: usize) -> Vec<[f64; 3]> {
        self.regressors[..self.core].iter().map(|&m| point(take, t, m)).collect()
    }
}

fn pick(
    take: &Take,
    target: usize,
    usable: &[usize],
    params: &LocalRidgeParams,
    least: usize,
) -> Neighbours {
    let mut together: Vec<bool> = take.observed().marker(target).to_vec();
    let mut regressors = Vec::new();
    for &m in usable {
        if regressors.len() == params.regressors {
            break;
        }
        let column = take.observed().marker(m);
        let both: Vec<bool> = together.iter().zip(column).map(|(&a, &b)| a && b).collect();
        if both.iter().filter(|&&b| b).count() >= least {
            together = both;
            regressors.push(m);
        }
    }
    let training: Vec<usize> = (0..take.frames()).filter(|&t| together[t]).collect();
    let mut neighbours = Neighbours { core: regressors.len(), regressors, training };
    neighbours.core = core_size(take, &neighbours, params.core);
    neighbours
}

/// The core grows beyond its size while its markers lie on a line and there are more.
fn core_size(take: &Take, neighbours: &Neighbours, core: usize) -> usize {
    let all = neighbours.regressors.len();
    let Some(t) = neighbours.reference_frame() else { return all };
    let pose = neighbours.core_pose(take, t);
    (core.min(all)..=all).find(|&n| !is_linear(&pose[..n])).unwrap_or(core.min(all))
}

/// The position of a marker; NaN where it is missing.
pub(crate) fn point(take: &Take, t: usize, m: usize) -> [f64; 3] {
    let positions = take.positions();
    std::array::from_fn(|a| positions[(t, m, a)])
}
