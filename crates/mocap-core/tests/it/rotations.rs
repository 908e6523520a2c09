//! Every way to write a rotation down leads back to it, also where the formulas have a hole.

use std::f64::consts::{FRAC_PI_2, PI};

use mocap_core::{
    Rotation,
    geometry::{cross, distance, dot, exp_jacobian, log_jacobian, norm, product, scale},
};
use proptest::prelude::*;

/// Roundings of a few dozen operations on numbers up to 10.
const EXACT: f64 = 1e-12;

type Matrix = [[f64; 3]; 3];

/// Largest difference of two rotations' matrices.
fn off(a: Rotation, b: Rotation) -> f64 {
    off_matrix(&a.matrix(), &b.matrix())
}

fn off_matrix(a: &Matrix, b: &Matrix) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// Rotation vectors of all lengths that make trouble: none, tiny, half a turn and nearly so, full turns.
fn vector() -> impl Strategy<Value = [f64; 3]> {
    let length = prop_oneof![
        0.0..7.0_f64,
        (-300.0..-1.0_f64).prop_map(|e| 10.0_f64.powf(e)),
        (-16.0..-1.0_f64).prop_map(|e| PI - 10.0_f64.powf(e)),
        (-16.0..-1.0_f64).prop_map(|e| PI + 10.0_f64.powf(e)),
        Just(0.0),
        Just(PI),
        Just(2.0 * PI),
        Just(FRAC_PI_2),
    ];
    let direction = prop_oneof![
        prop::array::uniform3(-1.0..1.0_f64),
        Just([1.0, 0.0, 0.0]),
        Just([0.0, -1.0, 0.0]),
        Just([0.0, 0.0, 1.0]),
        Just([1.0, 1.0, 0.0]),
    ];
    (direction, length)
        .prop_filter_map("no direction", |(d, l)| (norm(d) > 1e-3).then(|| scale(l / norm(d), d)))
}

proptest! {
    #[test]
    fn every_form_leads_back(v in vector()) {
        let rotation = Rotation::exp(v);
        prop_assert!(off(rotation, Rotation::about(v, norm(v))) < EXACT);
        let log = rotation.log();
        prop_assert!(norm(log) <= PI + EXACT);
        prop_assert!((rotation.angle() - norm(log)).abs() < EXACT);
        prop_assert!(off(Rotation::exp(log), rotation) < EXACT);
        prop_assert!(off(Rotation::from_matrix(&rotation.matrix()).unwrap(), rotation) < EXACT);
        prop_assert!(off(Rotation::nearest(&rotation.matrix()).unwrap(), rotation) < EXACT);
        let [a, b] = rotation.six();
        prop_assert!(off(Rotation::from_six(a, b).unwrap(), rotation) < EXACT);
        let (w, q) = rotation.quaternion();
        prop_assert!(off(Rotation::from_quaternion(-w, scale(-1.0, q)).unwrap(), rotation) < EXACT);
        // Short vectors come back themselves, to the last digits of their own size.
        if norm(v) < PI - 1e-6 {
            prop_assert!(distance(log, v) <= EXACT * norm(v).max(f64::MIN_POSITIVE), "{log:?} {v:?}");
        }
    }

    #[test]
    fn gram_and_schmidt_never_reflect(
        a in prop::array::uniform3(-2.0..2.0_f64),
        b in prop::array::uniform3(-2.0..2.0_f64),
        size in -150.0..150.0_f64,
    ) {
        prop_assume!(norm(cross(a, b)) > 1e-6 * norm(a) * norm(b));
        let grown = |p| scale(10.0_f64.powf(size), p);
        let m = Rotation::from_six(grown(a), grown(b)).unwrap().matrix();
        let column = |c: usize| [m[0][c], m[1][c], m[2][c]];
        let volume = dot(cross(column(0), column(1)), column(2));
        prop_assert!((volume - 1.0).abs() < EXACT);
        prop_assert!(distance(column(0), scale(1.0 / norm(a), a)) < EXACT);
        prop_assert!(dot(column(1), b) > 0.0 && dot(column(2), b).abs() < 1e-12 * norm(b));
    }

    #[test]
    fn the_nearest_rotation_is_nearer_than_its_neighbours(
        m in prop::array::uniform3(prop::array::uniform3(-1.0..1.0_f64)),
        by in prop::array::uniform3(-0.3..0.3_f64),
    ) {
        let best = Rotation::nearest(&m).unwrap();
        let cost = |r: Rotation| -> f64 {
            let pairs = r.matrix().into_iter().flatten().zip(m.into_iter().flatten());
            pairs.map(|(a, b): (f64, f64)| (a - b).powi(2)).sum()
        };
        prop_assert!(cost(best) <= cost(Rotation::exp(by).after(best)) + EXACT);
    }

    #[test]
    fn jacobians_of_exp_and_log_are_inverse_and_right(v in vector(), d in prop::array::uniform3(-1.0..1.0_f64)) {
        // Beyond a full turn exp is not one to one.
        prop_assume!(norm(v) < 2.0 * PI - 0.1);
        let (forward, back) = (exp_jacobian(v), log_jacobian(v));
        let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        // Near a full turn the inverse grows: 1/0.1 here, squared.
        prop_assert!(off_matrix(&product(&forward, &back), &one) < 1e-10);
        let h = 1e-5;
        let plus: [f64; 3] = std::array::from_fn(|a| v[a] + h * d[a]);
        let minus: [f64; 3] = std::array::from_fn(|a| v[a] - h * d[a]);
        let step = Rotation::exp(plus).after(Rotation::exp(minus).inverse()).log();
        let by_jacobian = forward.map(|row| dot(row, d));
        // Central differences: h² · third derivatives of order 1, and roundings over h.
        prop_assert!(distance(scale(0.5 / h, step), by_jacobian) < 1e-9);
    }

    #[test]
    fn halfway_is_halfway(v in vector(), w in vector()) {
        let (a, b) = (Rotation::exp(v), Rotation::exp(w));
        let middle = a.toward(b, 0.5);
        let apart = |p: Rotation, q: Rotation| p.inverse().after(q).angle();
        prop_assert!((apart(a, middle) - apart(middle, b)).abs() < 1e-11);
        prop_assert!(off(a.toward(b, 0.0), a) < EXACT && off(a.toward(b, 1.0), b) < EXACT);
    }
}

#[test]
fn what_is_no_rotation_is_refused() {
    let mirror = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
    assert_eq!(Rotation::from_matrix(&mirror), None);
    assert_eq!(Rotation::from_matrix(&[[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), None);
    assert_eq!(Rotation::from_matrix(&[[f64::NAN; 3]; 3]), None);
    assert_eq!(Rotation::nearest(&[[f64::NAN; 3]; 3]), None);
    assert_eq!(Rotation::nearest(&[[0.0; 3]; 3]), None);
    assert_eq!(Rotation::from_six([1.0, 0.0, 0.0], [-3.0, 0.0, 0.0]), None);
    assert_eq!(Rotation::from_six([0.0; 3], [0.0, 1.0, 0.0]), None);
    assert_eq!(Rotation::from_six([f64::INFINITY, 0.0, 0.0], [0.0, 1.0, 0.0]), None);
    // The rotation nearest to a reflection is a rotation.
    let m = Rotation::nearest(&mirror).unwrap().matrix();
    assert!((dot(cross(m[0], m[1]), m[2]) - 1.0).abs() < EXACT);
}
