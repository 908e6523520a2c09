use metrics::{bone_deviation, border_step, per_gap, score};
use mocap_core::{Bone, BoneSet, Mask, RigidTransform, Rotation, Take};
use ndarray::Array3;
use proptest::{collection::vec, prelude::*};

use crate::names;

const FRAMES: usize = 12;
const MARKERS: usize = 4;

/// Coordinates stay below 40 m after the motion; 1e-8 mm is a few thousand roundings of that.
const ROUNDING_MM: f64 = 1e-8;

#[derive(Debug, Clone)]
struct Case {
    truth: Take,
    filled: Take,
    hidden: Mask,
}

fn case() -> impl Strategy<Value = Case> {
    let cells = FRAMES * MARKERS;
    let (coordinates, noise) = (vec(-5.0..5.0, 3 * cells), vec(-0.1..0.1, 3 * cells));
    (coordinates, noise, vec(0_u8..4, cells)).prop_map(|(x, e, kind)| {
        let xyz = Array3::from_shape_vec((FRAMES, MARKERS, 3), x).unwrap();
        let error = Array3::from_shape_vec((FRAMES, MARKERS, 3), e).unwrap();
        let truth = Take::from_positions(names(MARKERS), 100.0, xyz.clone()).unwrap();
        let hidden = Mask::from_fn(FRAMES, MARKERS, |t, m| kind[t * MARKERS + m] > 1 || t + m == 3);
        let filled = Mask::from_fn(FRAMES, MARKERS, |t, m| kind[t * MARKERS + m] < 3);
        let filled = Take::new(names(MARKERS), 100.0, xyz + error, filled).unwrap();
        Case { truth, filled, hidden }
    })
}

fn motion() -> impl Strategy<Value = RigidTransform> {
    let vector = [-9.0..9.0, -9.0..9.0, -9.0..9.0];
    (vector.clone(), -3.0..3.0, vector).prop_map(|(axis, angle, translation)| RigidTransform {
        rotation: Rotation::about(axis, angle),
        translation,
    })
}

fn bones() -> BoneSet {
    BoneSet::new([Bone::new(0, 1, 2.0).unwrap(), Bone::new(1, 3, 1.0).unwrap()]).unwrap()
}

fn close(a: f64, b: f64) -> bool {
    (a.is_nan() && b.is_nan()) || (a - b).abs() < ROUNDING_MM
}

proptest! {
    #[test]
    fn figures_agree_with_each_other(c in case()) {
        let s = score(&c.truth, &c.filled, &c.hidden).unwrap();
        prop_assert_eq!(s.hidden_cells, c.hidden.count());
        let open = c.hidden.iter().filter(|&(t, m)| !c.filled.is_observed(t, m)).count();
        prop_assert_eq!(s.unfilled_cells, open);
        if s.unfilled_cells < s.hidden_cells {
            prop_assert!(close(s.rms_mm, 1000.0 * (3.0 * s.mse_m2).sqrt()));
            prop_assert!(s.mean_mm <= s.rms_mm + ROUNDING_MM && s.rms_mm <= s.max_mm + ROUNDING_MM);
            prop_assert!(s.median_mm <= s.p95_mm && s.p95_mm <= s.max_mm);
        }
    }

    #[test]
    fn gaps_add_up_to_the_take(c in case()) {
        let whole = score(&c.truth, &c.filled, &c.hidden).unwrap();
        let gaps = per_gap(&c.truth, &c.filled, &c.hidden).unwrap();
        prop_assert_eq!(gaps.iter().map(|g| g.gap.len()).sum::<usize>(), whole.hidden_cells);
        prop_assert_eq!(
            gaps.iter().map(|g| g.score.unfilled_cells).sum::<usize>(),
            whole.unfilled_cells
        );
        let count = |g: &metrics::GapScore| g.score.hidden_cells - g.score.unfilled_cells;
        let sum: f64 = gaps
            .iter()
            .filter(|g| count(g) > 0)
            .map(|g| g.score.mean_mm * count(g) as f64)
            .sum();
        let filled = whole.hidden_cells - whole.unfilled_cells;
        prop_assert!(filled == 0 || close(sum / filled as f64, whole.mean_mm));
    }

    #[test]
    fn rigid_motion_changes_nothing(c in case(), motion in motion()) {
        let moved = |take: &Take| take.map_positions(|_, _, p| motion.apply(p)).unwrap();
        let before = score(&c.truth, &c.filled, &c.hidden).unwrap();
        let after = score(&moved(&c.truth), &moved(&c.filled), &c.hidden).unwrap();
        prop_assert!(close(before.mean_mm, after.mean_mm) && close(before.p95_mm, after.p95_mm));
        let bones = bones();
        let before = bone_deviation(&c.filled, &bones, Some(&c.hidden)).unwrap();
        let after = bone_deviation(&moved(&c.filled), &bones, Some(&c.hidden)).unwrap();
        prop_assert!(close(before.mean_mm, after.mean_mm) && close(before.max_mm, after.max_mm));
        for gap in c.truth.hide(&c.hidden).unwrap().gaps() {
            let before = border_step(&c.filled, &gap).max_mm();
            let after = border_step(&moved(&c.filled), &gap).max_mm();
            prop_assert_eq!(before.is_some(), after.is_some());
            prop_assert!(before.zip(after).is_none_or(|(b, a)| close(b, a)));
        }
    }

    #[test]
    fn marker_order_changes_nothing(c in case(), order in Just([2, 0, 3, 1]).prop_shuffle()) {
        let permute = |take: &Take| take.select(&order).unwrap();
        let hidden = Mask::from_fn(FRAMES, MARKERS, |t, m| c.hidden.contains(t, order[m]));
        let before = score(&c.truth, &c.filled, &c.hidden).unwrap();
        let after = score(&permute(&c.truth), &permute(&c.filled), &hidden).unwrap();
        prop_assert!(close(before.mean_mm, after.mean_mm) && close(before.rms_mm, after.rms_mm));
        // Quantiles pick among the same sorted errors.
        prop_assert!(before.p95_mm.to_bits() == after.p95_mm.to_bits());
    }
}
