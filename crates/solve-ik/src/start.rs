//! The pose of a frame of which nothing is known.

use mocap_core::geometry::{add, best_rotation, scale, sub};

use crate::{
    frame::{FrameSolver, Seen, Ties},
    tree::{State, Tree},
};

/// Steps for each further level of joints, and in the end.
const LEVEL_STEPS: usize = 6;
const LAST_STEPS: usize = 60;

/// Puts the root where its markers are, then joins in the markers level by level, from the root to the hands and
/// feet, so that each limb starts from a trunk that is right. `None` where fewer than three markers of the root are seen.
pub(crate) fn cold_start(solver: &mut FrameSolver<'_>, seen: &[Seen]) -> Option<State> {
    let tree = solver.tree;
    let mut state = root_fit(tree, seen)?;
    let levels = levels(tree);
    let deepest = levels.iter().copied().max().unwrap_or(0);
    let free = vec![0.0; tree.len()];
    let level = |anchor: &Seen| {
        let anchor = &tree.anchors[anchor.0 as usize];
        levels[anchor.far.map_or(anchor.near, |(far, _)| far)]
    };
    for depth in 0..=deepest {
        let part: Vec<Seen> = seen.iter().copied().filter(|s| level(s) <= depth).collect();
        let target = state.clone();
        let ties = Ties { target: &target, shift: 1e-6, turns: &free };
        // A touch of a tie, so that what no marker shows yet is determined.
        solver.solve(&mut state, &part, &ties, LEVEL_STEPS);
    }
    let target = state.clone();
    let ties = Ties { target: &target, shift: 1e-6, turns: &free };
    solver.solve(&mut state, seen, &ties, LAST_STEPS);
    Some(state)
}

/// Joints between each joint and the root.
fn levels(tree: &Tree) -> Vec<usize> {
    let mut levels: Vec<usize> = vec![0; tree.len()];
    for j in 1..tree.len() {
        levels[j] = levels[tree.parents[j]] + 1;
    }
    levels
}

/// The rest pose, carried to the markers of the root. Implements [Kabsch76], by quaternions.
pub(crate) fn root_fit(tree: &Tree, seen: &[Seen]) -> Option<State> {
    let on_root = seen.iter().filter_map(|&(anchor, at)| {
        let anchor = &tree.anchors[anchor as usize];
        anchor.is_on_root().then_some((anchor.place, at))
    });
    let pairs: Vec<([f64; 3], [f64; 3])> = on_root.collect();
    if pairs.len() < 3 {
        return None;
    }
    let mut state = tree.rest();
    let share = 1.0 / pairs.len() as f64;
    let sum = pairs.iter().fold(([0.0; 3], [0.0; 3]), |s, p| (add(s.0, p.0), add(s.1, p.1)));
    let (from, to) = (scale(share, sum.0), scale(share, sum.1));
    let mut sums = [[0.0; 3]; 3];
    for (p, q) in &pairs {
        let (p, q) = (sub(*p, from), sub(*q, to));
        for a in 0..3 {
            sums[a] = add(sums[a], scale(p[a], q));
        }
    }
    state.turns[0] = best_rotation(&sums);
    state.root_m = sub(sub(to, state.turns[0].apply(from)), tree.offsets[0]);
    Some(state)
}
