use augment::{
    Excess, GapHistogram, GapSampler, GapSamplerParams, LogNormal, Neighbours, Normalisation,
    Occluder, OcclusionModel, Preset, Rounding,
};
use mocap_core::{Gap, MarkerSet, Mask};
use proptest::prelude::*;

use crate::{model, names, take, take_seen};

fn preset_names(preset: Preset) -> MarkerSet {
    MarkerSet::new(preset.markers().map(|marker| marker.0)).unwrap()
}

fn short_gaps() -> GapHistogram {
    LogNormal::new(0.5, 1.2).unwrap().histogram(60).unwrap()
}

/// Pearson's statistic of the drawn lengths and its degrees of freedom; neighbouring lengths are
/// pooled until 20 gaps are due.
fn chi_square(lengths: &GapHistogram, drawn: impl Iterator<Item = usize>) -> (f64, usize) {
    let mut counts = vec![0.0; lengths.longest_frames() + 1];
    drawn.for_each(|length| counts[length] += 1.0);
    let total: f64 = counts.iter().sum();
    let (mut statistic, mut cells, mut expected, mut found) = (0.0, 0, 0.0, 0.0);
    for &(length, share) in lengths.bins() {
        expected += share * total;
        found += counts[length];
        if expected >= 20.0 {
            statistic += (found - expected).powi(2) / expected;
            (cells, expected, found) = (cells + 1, 0.0, 0.0);
        }
    }
    (statistic, cells - 1)
}

/// The 99.9 % quantile of the chi-square law, by the cube-root approximation of Wilson and Hilferty.
fn quantile(degrees: usize) -> f64 {
    let k = 2.0 / (9.0 * degrees as f64);
    degrees as f64 * (1.0 - k + 3.09 * k.sqrt()).powi(3)
}

/// Ten million cells: 500 000 frames of 20 finger markers.
#[test]
fn lengths_pass_a_chi_square_test_and_rates_are_kept_on_ten_million_cells() {
    let preset = Preset::TenFinger;
    let (set, observed) = (preset_names(preset), Mask::all(500_000, 20));
    let model = preset.model().unwrap();
    // Rolling for each length on its own leaves a standard error of 1.6 %, mostly from long gaps.
    for (rounding, tolerance) in [(Rounding::Systematic, 0.01), (Rounding::Bernoulli, 0.05)] {
        let params =
            GapSamplerParams { occlusion: 0.1, rounding, seed: 1, ..GapSamplerParams::default() };
        let draw = GapSampler::new(model.clone(), params).unwrap();
        let draw = draw.draw(&set, &observed, None).unwrap();
        assert!((draw.occlusion / 0.1 - 1.0).abs() < tolerance, "{rounding:?}: {}", draw.occlusion);
        assert!(draw.rates.iter().all(|rate| rate.unplaced_gaps == 0));
        let (statistic, degrees) = chi_square(model.lengths(), draw.gaps.iter().map(Gap::len));
        assert!(degrees > 100, "only {degrees} degrees of freedom");
        // Rounded numbers scatter less than independent draws, so true lengths lie far below this.
        assert!(statistic < quantile(degrees), "{rounding:?}: {statistic} of {degrees}");
        // The same gaps against the law of another layout: the test has teeth.
        let other = Preset::FiveFinger.model().unwrap();
        let (statistic, degrees) = chi_square(other.lengths(), draw.gaps.iter().map(Gap::len));
        assert!(statistic > quantile(degrees), "{statistic} of {degrees}");
    }
}

#[test]
fn each_marker_gets_its_rate() {
    // Without a limit in the way, rates are as p̂: 1 to 5 parts of 15, 0.1 on average.
    let sampler = GapSampler::new(model(5, short_gaps()), GapSamplerParams::default()).unwrap();
    let draw = sampler.draw(&names(5), &Mask::all(200_000, 5), None).unwrap();
    for (m, rate) in draw.rates.iter().enumerate() {
        let due = 0.1 * 5.0 * (m + 1) as f64 / 15.0;
        assert!((rate.requested - due).abs() < 1e-12 && rate.planned == rate.requested);
        // Systematic rounding is within one longest gap: 60 of at least 6666 frames.
        assert!((rate.realised - due).abs() <= 60.0 / 200_000.0, "{m}: {rate:?}");
    }
}

#[test]
fn the_printed_normalisation_hides_m_times_less() {
    let draw = |params| {
        let sampler = GapSampler::new(model(5, short_gaps()), params).unwrap();
        sampler.draw(&names(5), &Mask::all(200_000, 5), None).unwrap()
    };
    let sum = GapSamplerParams { normalisation: Normalisation::Sum, ..GapSamplerParams::default() };
    assert!((draw(sum).occlusion / 0.02 - 1.0).abs() < 0.01);
    let printed = draw(GapSamplerParams::printed()).occlusion;
    // Rounding down costs less than one gap of each of 60 lengths a marker.
    assert!(printed <= 0.02 && printed > 0.02 - 5.0 * 1830.0 / 1e6, "{printed}");
}

#[test]
fn rounding_down_loses_what_a_short_take_needs() {
    let draw = |rounding| {
        let params = GapSamplerParams { rounding, ..GapSamplerParams::default() };
        let sampler = GapSampler::new(Preset::FrontWaist.model().unwrap(), params).unwrap();
        let draws = (0..20).map(|seed| {
            let set = preset_names(Preset::FrontWaist);
            sampler.clone().with_seed(seed).draw(&set, &Mask::all(1000, 53), None).unwrap()
        });
        draws.map(|draw| draw.occlusion).sum::<f64>() / 20.0
    };
    assert!(draw(Rounding::Floor) < 0.02, "no gap is due as a whole");
    // 20 draws of 53 markers with 100 hidden frames each, each off by at most one gap of 500.
    assert!((draw(Rounding::Systematic) - 0.1).abs() < 0.01);
}

#[test]
fn what_a_limit_cuts_off_is_spread_or_lost() {
    // MFWT would lose 86 % of its frames at a mean of 10 %, and MBWT 57 %.
    let draw = |excess| {
        let params = GapSamplerParams { excess, ..GapSamplerParams::default() };
        let model = Preset::FrontWaist.model().unwrap().clipped(1, 199).unwrap();
        let set = preset_names(Preset::FrontWaist);
        let draw = GapSampler::new(model, params).unwrap().draw(&set, &Mask::all(60_000, 53), None);
        (set.find("MFWT").unwrap(), draw.unwrap())
    };
    let (mfwt, spread) = draw(Excess::Spread);
    assert!((spread.rates[mfwt].requested - 0.855).abs() < 0.005);
    assert_eq!(spread.rates[mfwt].planned, 0.5);
    let planned =
        |draw: &augment::GapDraw| draw.rates.iter().map(|r| r.planned).sum::<f64>() / 53.0;
    assert!((planned(&spread) - 0.1).abs() < 1e-12);
    assert!((spread.occlusion / 0.1 - 1.0).abs() < 0.01, "{}", spread.occlusion);
    let (_, lost) = draw(Excess::Drop);
    let due = 0.1 - (0.855 - 0.5 + 0.570 - 0.5) / 53.0;
    assert!((planned(&lost) - due).abs() < 1e-3, "{}", planned(&lost));
}

#[test]
fn crowded_takes_report_what_found_no_room() {
    // Gaps of 9 with a frame beside each cannot hide more than 90 %.
    let lengths = GapHistogram::new([(9, 1.0)]).unwrap();
    let params =
        GapSamplerParams { occlusion: 0.95, marker_limit: 1.0, ..GapSamplerParams::default() };
    let odds = OcclusionModel::new([("M0", 0.5)], lengths, 120.0).unwrap();
    let draw = GapSampler::new(odds, params).unwrap();
    let draw = draw.draw(&names(1), &Mask::all(10_000, 1), None).unwrap();
    assert!(draw.rates[0].unplaced_gaps > 0);
    let gaps = draw.gaps.len() + draw.rates[0].unplaced_gaps;
    assert!((gaps as f64 - 0.95 * 10_000.0 / 9.0).abs() <= 1.0);
    // Random packing of segments of 10 on a line jams at 0.75 to 0.8; ours has to get there.
    assert!(draw.occlusion > 0.6, "{}", draw.occlusion);
}

#[test]
fn takes_without_room_stay_as_they_are() {
    let sampler = GapSampler::new(model(2, short_gaps()), GapSamplerParams::default()).unwrap();
    for frames in [1, 2] {
        assert_eq!(sampler.sample(&take(frames, 2)).unwrap().draw.gaps, []);
    }
    let unseen = take_seen(50, 2, |_, m| m == 0);
    assert!(sampler.sample(&unseen).unwrap().draw.gaps.iter().all(|gap| gap.marker == 0));
    let none = GapSamplerParams { occlusion: 0.0, ..GapSamplerParams::default() };
    let sampler = GapSampler::new(model(2, short_gaps()), none).unwrap();
    assert_eq!(sampler.sample(&take(500, 2)).unwrap().draw.occlusion, 0.0);
}

/// How often two markers next to each other are hidden together, over what chance gives.
fn togetherness(hidden: &Mask) -> f64 {
    let (frames, markers) = (hidden.frames(), hidden.markers());
    let (mut both, mut chance) = (0.0, 0.0);
    for m in 1..markers {
        let count = |f: &dyn Fn(usize) -> bool| (0..frames).filter(|&t| f(t)).count() as f64;
        both += count(&|t| hidden.contains(t, m) && hidden.contains(t, m - 1));
        chance += count(&|t| hidden.contains(t, m)) * count(&|t| hidden.contains(t, m - 1));
    }
    both * frames as f64 / chance
}

#[test]
fn an_occluder_hides_neighbours_together_and_changes_no_marker() {
    let take = take(40_000, 8);
    let draw = |occluder| {
        let params = GapSamplerParams { occluder, ..GapSamplerParams::default() };
        let sampler = GapSampler::new(model(8, short_gaps()), params).unwrap();
        sampler.sample(&take).unwrap().draw
    };
    let alone = draw(None);
    let together = draw(Some(Occluder { reach: 2, coupling: 0.8 }));
    let lengths = |draw: &augment::GapDraw| {
        let mut lengths: Vec<_> = draw.gaps.iter().map(|gap| (gap.marker, gap.len())).collect();
        lengths.sort_unstable();
        lengths
    };
    assert_eq!(lengths(&alone), lengths(&together));
    assert_eq!(alone.occlusion, together.occlusion);
    // Chance is 1 ± 0.05 with thousands of gaps; an occluder makes it several times that.
    assert!((togetherness(&alone.hidden) - 1.0).abs() < 0.2, "{}", togetherness(&alone.hidden));
    assert!(togetherness(&together.hidden) > 3.0, "{}", togetherness(&together.hidden));
    let uncoupled = draw(Some(Occluder { reach: 2, coupling: 0.0 }));
    assert_eq!(uncoupled.hidden, alone.hidden);
}

#[test]
fn neighbours_are_sorted_by_distance() {
    let near = Neighbours::by_mean_distance(&take_seen(700, 5, |_, m| m < 4)).unwrap();
    assert_eq!(near.of(0), [1, 2, 3]);
    assert_eq!(near.of(2), [1, 3, 0], "equal distances go by index; marker 4 is never seen");
    assert_eq!((near.of(4), near.markers()), (&[][..], 5));
}

#[test]
fn durations_survive_another_rate() {
    let model = model(2, GapHistogram::new([(1, 1.0), (120, 1.0)]).unwrap());
    let slow = model.at_rate(30.0).unwrap();
    assert_eq!(slow.lengths().bins(), [(1, 0.5), (30, 0.5)]);
    assert_eq!(slow.rate_hz(), 30.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// What the guarantees of the front page promise, on takes with holes of their own.
    #[test]
    fn gaps_touch_nothing_and_hide_only_what_was_seen(
        seed in any::<u64>(),
        frames in 1..400_usize,
        markers in 1..6_usize,
        occlusion in 0.0..=0.5_f64,
        marker_limit in 0.5..=1.0_f64,
        hole in 0..400_usize,
        coupling in prop::option::of(0.0..=1.0_f64),
        rounding in prop::sample::select(
            vec![Rounding::Systematic, Rounding::Bernoulli, Rounding::Floor],
        ),
    ) {
        let take = take_seen(frames, markers, |t, m| (t * 7 + m * 131) % 97 > 2 && t + m != hole);
        let occluder = coupling.map(|coupling| Occluder { reach: 2, coupling });
        let params = GapSamplerParams {
            occlusion, marker_limit, rounding, occluder, seed, ..GapSamplerParams::default()
        };
        let sampler = GapSampler::new(model(markers, short_gaps()), params).unwrap();
        let sampled = sampler.sample(&take).unwrap();
        let (draw, holdout) = (&sampled.draw, &sampled.holdout);
        prop_assert_eq!(&draw.hidden, holdout.hidden());
        prop_assert!(draw.hidden.iter().all(|(t, m)| take.is_observed(t, m)));
        prop_assert_eq!(draw.gaps.iter().map(Gap::len).sum::<usize>(), draw.hidden.count());
        // No gap touches another or the take's own: the visible take has both lists, unmerged.
        let mut both = take.gaps();
        both.extend(draw.gaps.iter().cloned());
        both.sort_by_key(|gap| (gap.marker, gap.frames.start));
        prop_assert_eq!(holdout.visible().gaps(), both);
        let inside = |gap: &Gap| gap.frames.start > 0 && gap.frames.end < frames;
        prop_assert!(draw.gaps.iter().all(inside));
        let again = sampler.sample(&take).unwrap();
        prop_assert_eq!(&again.draw.hidden, &draw.hidden);
    }

    #[test]
    fn long_takes_lose_what_was_asked_for(
        seed in any::<u64>(), occlusion in 0.02..0.3_f64, markers in 1..8_usize,
    ) {
        let params = GapSamplerParams { occlusion, seed, ..GapSamplerParams::default() };
        let sampler = GapSampler::new(model(markers, short_gaps()), params).unwrap();
        // Off by at most a gap of 60 a marker, of 600 hidden frames and more: 1 % from 300 000 frames.
        let draw = sampler.draw(&names(markers), &Mask::all(300_000, markers), None).unwrap();
        prop_assert!((draw.occlusion / occlusion - 1.0).abs() < 0.01, "{}", draw.occlusion);
    }
}

#[test]
fn seeds_differ() {
    let sampler = GapSampler::new(model(3, short_gaps()), GapSamplerParams::default()).unwrap();
    let draw = |seed| sampler.clone().with_seed(seed).sample(&take(2000, 3)).unwrap().draw.hidden;
    assert_ne!(draw(1), draw(2));
    assert_eq!(draw(1), draw(1));
}

/// Bits that another platform or a later version must reproduce.
#[test]
fn the_draw_of_a_seed_is_fixed() {
    let params = GapSamplerParams { seed: 42, ..GapSamplerParams::default() };
    let sampler = GapSampler::new(model(2, short_gaps()), params).unwrap();
    let gaps = sampler.sample(&take(120, 2)).unwrap().draw.gaps;
    let found: Vec<_> = gaps.iter().map(|gap| (gap.marker, gap.frames.clone())).collect();
    let fixed =
        [(0, 8..9), (0, 19..25), (1, 7..8), (1, 15..16), (1, 56..60), (1, 68..93), (1, 100..102)];
    assert_eq!(found, fixed);
}
