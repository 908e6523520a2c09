//! Captures with gaps of their own, below `MOCAP_DATA`; skipped without it.

use augment::{GapSampler, GapSamplerParams, GapStatistics};
use mocap_core::Take;
use mocap_io::{MarkerFile, ReadOptions};

fn capture(name: &str) -> Option<Take> {
    let file = mocap_testkit::recording(name)?;
    Some(MarkerFile::read(&file, &ReadOptions::default()).unwrap().take().clone())
}

#[test]
fn statistics_agree_with_the_gaps_of_real_captures() {
    for name in [
        "captures/keenon+nimblephysics__nick_freeform_001.c3d",
        "captures/keenon+nimblephysics__squat.c3d",
        "captures/kineticstoolkit+kineticstoolkit__kinematics_basket_sprint.c3d",
        "hands/dfki_hand_embodiment_recording.tsv",
    ] {
        let Some(take) = capture(name) else { return };
        let statistics = GapStatistics::from_takes([&take]).unwrap();
        let worn: Vec<_> = (0..take.marker_count())
            .filter(|&m| take.observed().marker(m).iter().any(|&seen| seen))
            .collect();
        let missing: usize = worn
            .iter()
            .map(|&m| take.gaps_of(m).iter().map(mocap_core::Gap::len).sum::<usize>())
            .sum();
        let share = missing as f64 / (worn.len() * take.frames()) as f64;
        assert!((statistics.occlusion() - share).abs() < 1e-12, "{name}");
        let gaps: u64 = statistics.lengths().iter().map(|count| count.whole + count.cut).sum();
        let fit = statistics.fit();
        println!("{name}: {:.3} % missing in {gaps} gaps, {fit:?}", 100.0 * share);
        assert!(gaps > 0, "{name} is listed because it has gaps");
    }
}

/// What is drawn from a hand capture has its statistics.
#[test]
fn a_draw_repeats_the_statistics_of_a_capture() {
    let Some(hand) = capture("hands/dfki_hand_embodiment_recording.tsv") else { return };
    let statistics = GapStatistics::from_takes([&hand]).unwrap();
    let params = GapSamplerParams { occlusion: statistics.occlusion(), ..Default::default() };
    let sampler = GapSampler::new(statistics.model().unwrap(), params).unwrap();
    let observed = mocap_core::Mask::all(500_000, hand.marker_count());
    let draw = sampler.draw(hand.markers(), &observed, None).unwrap();
    assert!((draw.occlusion / statistics.occlusion() - 1.0).abs() < 0.01, "{}", draw.occlusion);
    for (rate, marker) in draw.rates.iter().zip(statistics.markers()) {
        // Rounding is off by at most one longest gap.
        let longest = statistics.histogram().unwrap().longest_frames() as f64 / 500_000.0;
        assert!((rate.realised - marker.probability()).abs() <= longest + 1e-9, "{marker:?}");
    }
}
