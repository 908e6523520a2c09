//! The equations of a frame against the Jacobian of the core and against finite differences.

use mocap_core::{Rotation, geometry::sub};

use super::*;
use crate::{Body, body::Habit};

/// Numbers between −1 and 1 without a pattern.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / f64::from(1_u32 << 31) / f64::from(1_u32 << 21) - 1.0
    }

    fn three(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| size * self.roll())
    }
}

struct Scene {
    body: Body,
    tree: Tree,
    state: State,
    target: State,
    seen: Vec<Seen>,
    turns: Vec<f64>,
}

/// A crooked body far from the origin whose markers were measured somewhere near.
fn scene(noise: f64) -> Scene {
    let body = Body::cmu_41();
    let columns: Vec<Option<usize>> = (0..body.sites.len()).map(Some).collect();
    let tree = Tree::new(&body, &columns);
    let mut dice = Dice(7);
    let mut state = tree.rest();
    state.root_m = [3.0, -2.0, 0.9];
    state.turns.iter_mut().for_each(|turn| *turn = Rotation::exp(dice.three(0.9)));
    let mut target = state.clone();
    target.turns.iter_mut().for_each(|turn| *turn = Rotation::exp(dice.three(0.9)));
    let mut placed = vec![Placed::NOWHERE; tree.len()];
    tree.place(&state, &mut placed);
    let seen = (0..)
        .zip(&tree.anchors)
        .map(|(index, anchor)| (index, add(tree.marker(anchor, &placed), dice.three(noise))))
        .collect();
    let turns = (0..tree.len()).map(|j| 0.1 * j as f64).collect();
    Scene { body, tree, state, target, seen, turns }
}

#[test]
fn the_blocks_are_those_of_the_full_jacobian() {
    let mut scene = scene(0.005);
    scene.tree.habits.iter_mut().for_each(|habit| {
        *habit = Habit { spread: [f64::INFINITY; 3], limits: [-9.0, 9.0], ..*habit };
    });
    let params = IkParams { marker_m: 1.0, robust_m: 1.0, ..IkParams::default() };
    let free = vec![0.0; scene.tree.len()];
    let ties = Ties { target: &scene.state, shift: 0.0, turns: &free };
    let mut solver = FrameSolver::new(&scene.tree, &params);
    solver.cost(&scene.state, &scene.seen, &ties);
    solver.linearise(&scene.state, &scene.seen, &ties);
    let found = solver.normal.dense();

    let skeleton = &scene.body.skeleton;
    let pose = scene.tree.pose(&scene.state, skeleton);
    let frames = skeleton.frames(&pose).unwrap();
    let n = 3 * (scene.tree.len() + 1);
    let (mut matrix, mut gradient) = (vec![vec![0.0; n]; n], vec![0.0; n]);
    for (&(anchor, at), site) in scene.seen.iter().zip(&scene.body.sites) {
        // A marker on two joints is a blend of two points, one fixed to each.
        let near = frames.point(site.near, site.place);
        let mut predicted = near;
        let mut jacobian = skeleton.jacobian(&frames, site.near, near);
        if let Some((far, share)) = site.far {
            let local = sub(site.place, skeleton.joints()[far].offset_m);
            let point = frames.point(far, local);
            jacobian = jacobian * (1.0 - share) + skeleton.jacobian(&frames, far, point) * share;
            predicted = add(scale(1.0 - share, near), scale(share, point));
        }
        assert!(
            norm(sub(
                predicted,
                scene.tree.marker(&scene.tree.anchors[anchor as usize], &solver.placed)
            )) < 1e-13
        );
        let column = |k: usize| match k {
            0..3 => k,
            _ => 3 + 3 * scene.tree.joints[k / 3 - 1] + k % 3,
        };
        for i in 0..n {
            for a in 0..3 {
                gradient[i] += jacobian[(a, column(i))] * (predicted[a] - at[a]);
                for j in 0..n {
                    matrix[i][j] += jacobian[(a, column(i))] * jacobian[(a, column(j))];
                }
            }
        }
    }
    for i in 0..n {
        // Sums of forty products of numbers below 2.
        assert!((solver.normal.gradient[i / 3][i % 3] - gradient[i]).abs() < 1e-12, "{i}");
        for j in 0..n {
            assert!(
                (found[i][j] - matrix[i][j]).abs() < 1e-11,
                "{i} {j}: {} {}",
                found[i][j],
                matrix[i][j]
            );
        }
    }
}

#[test]
fn the_gradient_is_the_slope_of_the_cost() {
    // Some markers miss by more than the reach, and some hinges leave their limits.
    let scene = scene(0.03);
    let params = IkParams::default();
    let ties = Ties { target: &scene.target, shift: 3.0, turns: &scene.turns };
    let mut solver = FrameSolver::new(&scene.tree, &params);
    solver.cost(&scene.state, &scene.seen, &ties);
    solver.linearise(&scene.state, &scene.seen, &ties);
    let gradient = solver.normal.gradient.clone();
    let placed = solver.placed.clone();
    let h = 1e-6;
    for row in 0..solver.normal.rows() {
        for a in 0..3 {
            let mut at = |by: f64| {
                let mut step = vec![[0.0; 3]; gradient.len()];
                step[row][a] = by;
                solver.placed.copy_from_slice(&placed);
                let moved = solver.moved(&scene.state, &step);
                solver.cost(&moved, &scene.seen, &ties)
            };
            let slope = (at(h) - at(-h)) / (2.0 * h);
            // The cost is a sum of squares, its gradient that of half of it. Costs of 1e4 round at 1e-12, over h.
            assert!(
                (0.5 * slope - gradient[row][a]).abs() < 1e-4,
                "{row} {a}: {slope} {}",
                gradient[row][a]
            );
        }
    }
}

#[test]
fn elimination_along_the_tree_solves_the_full_system() {
    let scene = scene(0.01);
    let ties = Ties { target: &scene.target, shift: 3.0, turns: &scene.turns };
    let mut solver = FrameSolver::new(&scene.tree, &IkParams::default());
    solver.cost(&scene.state, &scene.seen, &ties);
    solver.linearise(&scene.state, &scene.seen, &ties);
    solver.normal.factor(0.0).unwrap();
    let mut x = solver.normal.gradient.clone();
    let mut half = x.clone();
    solver.normal.solve(&mut x);
    solver.normal.half_solve(&mut half);
    let full = solver.normal.dense();
    let flat: Vec<f64> = x.iter().flatten().copied().collect();
    let wanted: Vec<f64> = solver.normal.gradient.iter().flatten().copied().collect();
    let scale = wanted.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    for (row, wanted) in full.iter().zip(&wanted) {
        let found: f64 = row.iter().zip(&flat).map(|(a, b)| a * b).sum();
        // Condition of some ten thousands times a rounding.
        assert!((found - wanted).abs() < 1e-9 * scale, "{found} {wanted}");
    }
    let by_half: f64 = half.iter().flatten().map(|c| c * c).sum();
    let by_full: f64 = flat.iter().zip(&wanted).map(|(a, b)| a * b).sum();
    assert!((by_half - by_full).abs() < 1e-9 * by_full);
}

#[test]
fn a_frame_is_found_again_from_afar() {
    let scene = scene(0.0);
    // Without priors the true pose has no cost at all.
    let params = IkParams { marker_m: 1e-6, robust_m: 10.0, ..IkParams::default() };
    let free = vec![0.0; scene.tree.len()];
    let mut solver = FrameSolver::new(&scene.tree, &params);
    let mut state = scene.state.clone();
    let mut dice = Dice(1);
    for turn in &mut state.turns {
        *turn = Rotation::exp(dice.three(0.2)).after(*turn);
    }
    let target = scene.state.clone();
    let ties = Ties { target: &target, shift: 0.0, turns: &free };
    let fit = solver.solve(&mut state, &scene.seen, &ties, 50);
    assert!(fit.converged, "{fit:?}");
    solver.cost(&state, &scene.seen, &ties);
    let worst = solver.misses.iter().map(|m| norm(*m)).fold(0.0, f64::max);
    // The step that ended it was below 1e-4, and the next would have been its square.
    assert!(worst < 1e-6, "{worst} m");
}
