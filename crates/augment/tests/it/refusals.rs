use augment::{
    AugmentError, GapHistogram, GapSampler, GapSamplerParams, Neighbours, Occluder, OcclusionModel,
    Unlisted,
};
use mocap_core::Mask;

use crate::{model, names, take};

fn lengths() -> GapHistogram {
    GapHistogram::new([(1, 1.0), (4, 1.0)]).unwrap()
}

fn refused(params: GapSamplerParams) -> AugmentError {
    GapSampler::new(model(2, lengths()), params).unwrap_err()
}

#[test]
fn parameters_out_of_range_are_named() {
    let base = GapSamplerParams::default();
    for occlusion in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        let error = refused(GapSamplerParams { occlusion, ..base });
        assert!(matches!(error, AugmentError::OutOfRange { name: "occlusion", .. }));
    }
    let error = refused(GapSamplerParams { marker_limit: 2.0, ..base });
    assert!(matches!(error, AugmentError::OutOfRange { name: "marker_limit", .. }));
    let occluder = Some(Occluder { reach: 0, coupling: 0.5 });
    let error = refused(GapSamplerParams { occluder, ..base });
    assert!(matches!(error, AugmentError::OutOfRange { name: "reach", .. }));
    let occluder = Some(Occluder { reach: 1, coupling: 1.5 });
    let error = refused(GapSamplerParams { occluder, ..base });
    assert!(matches!(error, AugmentError::OutOfRange { name: "coupling", .. }));
    let error = refused(GapSamplerParams { occlusion: 0.6, ..base });
    assert_eq!(error, AugmentError::AboveLimit { occlusion: 0.6, limit: 0.5 });
    let odd = OcclusionModel::new([("A", 1.5)], lengths(), 120.0).unwrap_err();
    assert!(matches!(odd, AugmentError::OutOfRange { name: "probability", .. }));
    let odd = OcclusionModel::new([("A", 0.5)], lengths(), 0.0).unwrap_err();
    assert!(matches!(odd, AugmentError::OutOfRange { name: "rate_hz", .. }));
    assert!(model(1, lengths()).at_rate(f64::NAN).is_err());
}

#[test]
fn takes_that_do_not_fit_are_refused() {
    let sampler = GapSampler::new(model(2, lengths()), GapSamplerParams::default()).unwrap();
    let empty = AugmentError::EmptyTake { frames: 0, markers: 2 };
    assert_eq!(sampler.sample(&take(0, 2)).unwrap_err(), empty);
    let empty = AugmentError::EmptyTake { frames: 9, markers: 0 };
    assert_eq!(sampler.sample(&take(9, 0)).unwrap_err(), empty);
    let unlisted = AugmentError::UnlistedMarker { marker: "M2".into(), listed: 2 };
    assert_eq!(sampler.sample(&take(9, 3)).unwrap_err(), unlisted);
    let narrow = sampler.draw(&names(2), &Mask::all(9, 1), None);
    assert!(matches!(narrow, Err(AugmentError::Core(_))));
    let slow = GapSampler::new(model(2, lengths()).at_rate(60.0).unwrap(), *sampler.params());
    let mismatch = AugmentError::RateMismatch { model_hz: 60.0, take_hz: 120.0 };
    assert_eq!(slow.unwrap().sample(&take(9, 2)).unwrap_err(), mismatch);
    let never = OcclusionModel::new([("M0", 0.0), ("X", 1.0)], lengths(), 120.0).unwrap();
    let never = GapSampler::new(never, GapSamplerParams::default()).unwrap();
    assert_eq!(never.sample(&take(9, 1)).unwrap_err(), AugmentError::NeverOccluded);
}

#[test]
fn unlisted_markers_are_treated_as_asked() {
    let rates = |unlisted| {
        let params = GapSamplerParams { unlisted, ..GapSamplerParams::default() };
        let sampler = GapSampler::new(model(2, lengths()), params).unwrap();
        let draw = sampler.sample(&take(20_000, 3)).unwrap().draw;
        [0, 1, 2].map(|m: usize| (1e3 * draw.rates[m].realised).round() / 1e3)
    };
    // Odds 1 : 2, and 1.5 for the one whose probability is the mean.
    assert_eq!(rates(Unlisted::Mean), [0.067, 0.133, 0.1]);
    assert_eq!(rates(Unlisted::Spare), [0.067, 0.133, 0.0]);
    let nobody = GapSamplerParams { unlisted: Unlisted::Mean, ..GapSamplerParams::default() };
    let other = OcclusionModel::new([("X", 0.5)], lengths(), 120.0).unwrap();
    let nobody = GapSampler::new(other, nobody).unwrap().sample(&take(9, 2)).unwrap_err();
    assert_eq!(nobody, AugmentError::NeverOccluded);
}

#[test]
fn an_occluder_needs_neighbours_of_the_take() {
    let params =
        GapSamplerParams { occluder: Some(Occluder::default()), ..GapSamplerParams::default() };
    let sampler = GapSampler::new(model(2, lengths()), params).unwrap();
    let draw = |near| sampler.draw(&names(2), &Mask::all(99, 2), near).map(|draw| draw.rates.len());
    assert_eq!(draw(None), Err(AugmentError::NeighbourCount { expected: 2, found: 0 }));
    let three = Neighbours::by_mean_distance(&take(9, 3)).unwrap();
    assert_eq!(draw(Some(&three)), Err(AugmentError::NeighbourCount { expected: 2, found: 3 }));
    let two = Neighbours::by_mean_distance(&take(9, 2)).unwrap();
    assert_eq!(draw(Some(&two)), Ok(2));
}

#[test]
fn messages_name_the_value_and_the_way_out() {
    let error = refused(GapSamplerParams { occlusion: 1.5, ..GapSamplerParams::default() });
    let text = "`occlusion` = 1.5 is not between 0 and 1; choose a value in that range";
    assert_eq!(error.to_string(), text);
}
