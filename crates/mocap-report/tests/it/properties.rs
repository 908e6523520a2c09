use mocap_core::{BoneSet, MarkerSet, Mask, Take};
use mocap_report::{PlotInput, TakeSummary, html_page, render_svg};
use ndarray::Array3;
use proptest::{collection::vec, prelude::*};

use crate::xml;

fn any_take() -> impl Strategy<Value = Take> {
    let name = "[^ ]\\PC{0,12}|.{1,5}";
    (0_usize..40, vec(name, 0..5), vec(any::<f64>(), 600), vec(any::<bool>(), 200), 0.01..1e4)
        .prop_map(|(frames, names, x, seen, rate_hz)| {
            let names = names.into_iter().enumerate().map(|(i, name)| format!("{i}{name}"));
            let names = MarkerSet::new(names).unwrap();
            let markers = names.len();
            let at = |t: usize, m: usize| t * markers + m;
            let xyz = Array3::from_shape_fn((frames, markers, 3), |(t, m, a)| x[3 * at(t, m) + a]);
            let finite = |t, m| (0..3).all(|a| xyz[(t, m, a)].is_finite());
            let observed = Mask::from_fn(frames, markers, |t, m| seen[at(t, m)] && finite(t, m));
            Take::new(names, rate_hz, xyz, observed).unwrap()
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_take_and_any_name_give_well_formed_pages(take in any_take(), title in ".{0,20}") {
        let bones = BoneSet::default();
        let input = PlotInput::take(&title, &take, &bones);
        let svg = render_svg(&input).unwrap();
        prop_assert_eq!(xml::check(std::str::from_utf8(&svg).unwrap()), Ok(()));
        prop_assert_eq!(&svg, &render_svg(&input).unwrap());
        let page = html_page(&title, &TakeSummary::new(&take, 1), None, Some(&svg));
        let body = page.split_once('\n').unwrap().1.replace("<meta charset=\"utf-8\">", "");
        prop_assert_eq!(xml::check(&body), Ok(()));
    }

    #[test]
    fn the_summary_adds_up(take in any_take(), first in -1000_i64..1000) {
        let summary = TakeSummary::new(&take, first);
        let missing: usize = summary.gaps.iter().map(|gap| gap.frames).sum();
        prop_assert_eq!(missing + take.observed().count(), take.frames() * take.marker_count());
        prop_assert_eq!(summary.per_marker.iter().map(|m| m.gaps).sum::<usize>(), summary.gap_count);
        for gap in &summary.gaps {
            prop_assert_eq!(gap.last_frame - gap.first_frame + 1, i64::try_from(gap.frames).unwrap());
            prop_assert!(gap.first_frame >= first && gap.last_frame <= summary.last_frame);
        }
        prop_assert_eq!(summary.gaps_csv().matches('\n').count() - name_breaks(&summary), 1 + summary.gap_count);
    }
}

/// Line ends inside of quoted names.
fn name_breaks(summary: &TakeSummary) -> usize {
    summary.gaps.iter().map(|gap| gap.marker.matches('\n').count()).sum()
}
