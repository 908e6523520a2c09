use augment::{LogNormal, Preset};

/// Gap lengths per preset as published: gaps, overall missing percent, fitted nats per gap.
const SUMMARY: [(Preset, usize, f64, f64); 5] = [
    (Preset::FrontWaist, 53, 12_480.0, 0.794),
    (Preset::Production, 57, 27_711.0, 0.527),
    (Preset::TenFinger, 20, 28_309.0, 2.870),
    (Preset::FiveFinger, 10, 197_558.0, 4.922),
    (Preset::ThreeFinger, 6, 2_140.0, 2.599),
];

#[test]
fn tables_add_up_to_the_totals_of_their_source() {
    for (preset, markers, gaps, percent) in SUMMARY {
        assert_eq!(preset.markers().count(), markers);
        assert_eq!(preset.spans().iter().map(|span| span.weight).sum::<f64>(), gaps, "{preset}");
        // The markers' percentages are rounded to 0.0005.
        assert!((100.0 * preset.occlusion() - percent).abs() < 0.001, "{preset}");
    }
}

#[test]
fn the_laws_are_the_best_fit_to_the_counts() {
    for preset in Preset::ALL {
        let fit = LogNormal::fit(&preset.spans()).unwrap();
        // The laws were fitted to single lengths, this fit sees 23 spans; it loses little by that.
        assert!((fit.law.mu() - preset.law().mu()).abs() < 0.1, "{preset}: {fit:?}");
        assert!((fit.law.sigma() - preset.law().sigma()).abs() < 0.05, "{preset}: {fit:?}");
    }
}

#[test]
fn gaps_below_200_frames_have_the_published_mean() {
    let published = [19.8, 18.1, 9.1, 11.1, 12.8];
    for (preset, mean) in Preset::ALL.into_iter().zip(published) {
        let lengths = preset.model().unwrap().clipped(1, 199).unwrap();
        // The law smooths the counts; it is within 10 % of their mean.
        let law = lengths.lengths().mean_frames();
        assert!((law / mean - 1.0).abs() < 0.1, "{preset}: {law} against {mean}");
    }
}

#[test]
fn every_preset_has_a_name_and_unique_markers() {
    for preset in Preset::ALL {
        assert_eq!(preset.name().parse(), Ok(preset));
        let mut names: Vec<_> = preset.markers().map(|marker| marker.0).collect();
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
        assert!(preset.model().is_ok() && preset.frames() > 0);
    }
}
