//! Bad input is refused with an error that names it.

use std::ops::ControlFlow;

use lds_kalman::{
    Covariance, CovarianceStructure, EmParams, LdsError, LdsModel, LdsParts, NoiseStructure,
    Observations, Prediction, fit_em, smooth,
};
use ndarray::{Array1, Array2, array};

use crate::support::Random;

fn parts() -> LdsParts {
    LdsParts {
        transition: Array2::eye(2),
        emission: Array2::ones((3, 2)),
        state_noise: Covariance::Isotropic(1.0),
        observation_noise: Covariance::Diagonal(Array1::ones(3)),
        initial_mean: Array1::zeros(2),
        initial_covariance: Covariance::Full(Array2::eye(2)),
    }
}

fn refused(change: impl FnOnce(&mut LdsParts)) -> LdsError {
    let mut parts = parts();
    change(&mut parts);
    LdsModel::new(parts).unwrap_err()
}

#[test]
fn a_model_must_be_consistent() {
    assert!(LdsModel::new(parts()).is_ok());
    let shape =
        |what| move |error: LdsError| matches!(error, LdsError::Shape { what: w, .. } if w == what);
    assert!(shape("transition")(refused(|p| p.transition = Array2::eye(3))));
    assert!(shape("initial mean")(refused(|p| p.initial_mean = Array1::zeros(3))));
    assert!(shape("observation noise")(refused(|p| {
        p.observation_noise = Covariance::Diagonal(Array1::ones(2));
    })));
    assert_eq!(
        refused(|p| p.emission[(2, 1)] = f64::NAN),
        LdsError::NotFinite { what: "emission", row: 2, column: 1 }
    );
    for bad in [
        Covariance::Isotropic(0.0),
        Covariance::Isotropic(f64::NAN),
        Covariance::Diagonal(array![1.0, -1.0]),
        Covariance::Full(array![[1.0, 2.0], [2.0, 1.0]]),
        Covariance::Full(array![[1.0, 0.1], [0.0, 1.0]]),
    ] {
        assert_eq!(
            refused(|p| p.state_noise = bad),
            LdsError::NotPositiveDefinite { what: "state noise" }
        );
    }
    assert_eq!(
        refused(|p| p.observation_noise = Covariance::Full(Array2::eye(3))),
        LdsError::FullObservationNoise
    );
    assert_eq!(
        refused(|p| p.emission = Array2::ones((0, 2))),
        LdsError::ZeroDimension { what: "the observed dimension" }
    );
}

#[test]
fn observations_must_be_finite_where_observed() {
    let values = array![[1.0, 2.0], [f64::NAN, 4.0]];
    let all = Array2::from_elem((2, 2), true);
    assert_eq!(
        Observations::new(values.view(), all.view()).unwrap_err(),
        LdsError::ObservedNotFinite { frame: 1, dimension: 0 }
    );
    let mask = array![[true, true], [false, true]];
    let observations = Observations::new(values.view(), mask.view()).unwrap();
    assert_eq!(observations, Observations::from_finite(values.view()).unwrap());
    assert_eq!(observations.observed(), 3);
    assert_eq!(observations.interpolated(), array![[1.0, 2.0], [1.0, 4.0]]);
    assert!(Observations::new(values.view(), Array2::from_elem((1, 2), true).view()).is_err());
    assert!(Observations::from_finite(Array2::zeros((0, 2)).view()).is_err());
    let other = Observations::from_finite(Array2::zeros((4, 2)).view()).unwrap();
    let model = LdsModel::new(parts()).unwrap();
    assert!(matches!(smooth(&model, &other), Err(LdsError::Shape { .. })));
}

#[test]
fn interpolation_is_straight_inside_and_flat_outside() {
    let nan = f64::NAN;
    let values = array![[nan, nan], [1.0, nan], [nan, nan], [nan, nan], [4.0, nan], [nan, nan]];
    let filled = Observations::from_finite(values.view()).unwrap().interpolated();
    assert_eq!(filled.column(0).to_vec(), [1.0, 1.0, 2.0, 3.0, 4.0, 4.0]);
    assert_eq!(filled.column(1).to_vec(), [0.0; 6]);
}

fn fit_error(values: &Array2<f64>, params: &EmParams) -> LdsError {
    let observations = Observations::from_finite(values.view()).unwrap();
    fit_em(&observations, params, &mut Prediction, &mut |_| ControlFlow::Continue(())).unwrap_err()
}

#[test]
fn a_fit_refuses_what_it_cannot_learn_from() {
    let data = Random::new(1).matrix(9, 4);
    let params = EmParams { hidden: 2, ..EmParams::default() };
    assert_eq!(
        fit_error(&data, &EmParams { hidden: 5, ..params.clone() }),
        LdsError::HiddenTooLarge { hidden: 5, dimensions: 4 }
    );
    assert_eq!(
        fit_error(&data.slice(ndarray::s![..1, ..]).to_owned(), &params),
        LdsError::TooFewFrames { frames: 1, needed: 2 }
    );
    assert_eq!(fit_error(&Array2::from_elem((9, 4), f64::NAN), &params), LdsError::NothingObserved);
    let field = |error| match error {
        LdsError::Parameter { field, .. } => field,
        other => panic!("{other}"),
    };
    assert_eq!(field(fit_error(&data, &EmParams { hidden: 0, ..params.clone() })), "hidden");
    assert_eq!(
        field(fit_error(&data, &EmParams { iterations: 0, ..params.clone() })),
        "iterations"
    );
    assert_eq!(
        field(fit_error(&data, &EmParams { tolerance: f64::NAN, ..params.clone() })),
        "tolerance"
    );
    let structure = NoiseStructure { variance_floor: 0.0, ..NoiseStructure::default() };
    assert_eq!(
        field(fit_error(&data, &EmParams { structure, ..params.clone() })),
        "variance_floor"
    );
    let structure =
        NoiseStructure { observation: CovarianceStructure::Full, ..NoiseStructure::default() };
    assert_eq!(fit_error(&data, &EmParams { structure, ..params }), LdsError::FullObservationNoise);
}

#[test]
fn extreme_values_end_in_a_value_or_an_error() {
    for scale in [1e-200, 1e150, 1e300] {
        let data = Random::new(2).matrix(12, 4) * scale;
        let observations = Observations::from_finite(data.view()).unwrap();
        let params = EmParams { hidden: 2, iterations: 5, ..EmParams::default() };
        let result =
            fit_em(&observations, &params, &mut Prediction, &mut |_| ControlFlow::Continue(()));
        if let Ok(fit) = result {
            assert!(fit.states.iter().all(|x| x.is_finite()), "scale {scale}");
        }
    }
}
