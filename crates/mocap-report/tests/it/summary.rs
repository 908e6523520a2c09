use mocap_report::{FillSummary, TakeSummary};
use serde_json::{Value, json};

use crate::{filled, gap, hide, leg};

fn input() -> mocap_core::Take {
    hide(&leg(), &[gap(0, 0..50), gap(1, 5..6), gap(1, 10..20)])
}

#[test]
fn a_take_is_summed_up_by_hand() {
    let summary = TakeSummary::new(&input(), 101);
    assert_eq!((summary.markers, summary.frames, summary.gap_count), (3, 50, 3));
    assert_eq!((summary.first_frame, summary.last_frame), (101, 150));
    assert_eq!(summary.duration_s, 0.5);
    assert!((summary.labelled_percent - 100.0 * 89.0 / 150.0).abs() < 1e-12);
    assert_eq!(summary.unused_markers, ["HIP"]);
    let knee = serde_json::to_value(&summary.per_marker[1]).unwrap();
    let expected = json!({
        "marker": "KNEE", "missing_percent": 22.0, "gaps": 2, "longest_gap_frames": 10,
        "longest_gap_s": 0.1, "first_frame": 101, "last_frame": 150,
    });
    assert_eq!(knee, expected);
    let hip = &summary.per_marker[0];
    assert_eq!((hip.first_frame, hip.last_frame, hip.missing_percent), (None, None, 100.0));
    let gaps: Vec<_> =
        summary.gaps.iter().map(|g| (g.first_frame, g.last_frame, g.frames)).collect();
    assert_eq!(gaps, [(101, 150, 50), (106, 106, 1), (111, 120, 10)]);
}

#[test]
fn the_object_of_a_fill_has_the_promised_keys() {
    let object = serde_json::to_value(FillSummary::new(&filled(&leg()), 1, 2.0)).unwrap();
    let step = object["gaps"][0]["border_step_mm"].as_f64().unwrap();
    // The fill stands 20 mm above its surroundings, to the rounding of a few sums.
    assert!((step - 20.0).abs() < 0.1, "{step}");
    let mut rest = object;
    rest["gaps"][0]["border_step_mm"] = Value::Null;
    let expected = json!({
        "method": "lift", "termination": "iteration-limit", "iterations": 4, "seconds": 2.0,
        "seconds_per_iteration": 0.5,
        "gaps": [
            {
                "marker": "KNEE", "first_frame": 11, "last_frame": 20, "method": "lift",
                "sigma_mm": 5.0, "border_step_mm": null, "refused": null,
            },
            {
                "marker": "ANKLE", "first_frame": 31, "last_frame": 50, "method": "lift",
                "sigma_mm": null, "border_step_mm": null,
                "refused": "the gap lasts 0.200 s, longer than the limit of 0.150 s",
            },
        ],
    });
    assert_eq!(rest, expected);
}

#[test]
fn a_closed_form_has_no_time_per_iteration() {
    let report = mocap_core::FillReport::new("none", mocap_core::Termination::ClosedForm);
    let unchanged = mocap_core::Filled::unchanged(&input(), report).unwrap();
    let summary = FillSummary::new(&unchanged, 1, 0.25);
    assert_eq!(summary.seconds_per_iteration, None);
    // Open gaps that no refusal explains are told all the same.
    let told: Vec<_> = summary.gaps.iter().map(|g| g.refused.as_deref()).collect();
    assert_eq!(
        told,
        [
            Some("50 of 50 frames have no estimate"),
            Some("1 of 1 frames have no estimate"),
            Some("10 of 10 frames have no estimate")
        ]
    );
}

#[test]
fn text_lines_up() {
    let text = TakeSummary::new(&input(), 1).to_text();
    let expected = "\
3 markers, 50 frames at 100 Hz (0.50 s), frames 1 to 50
59.33 % labelled, 3 gaps

marker  missing %  gaps  longest frames  longest s  first seen  last seen
HIP        100.00     1              50      0.500           -          -
KNEE        22.00     2              10      0.100           1         50

unused markers: HIP
";
    assert_eq!(text, expected);
    let text = FillSummary::new(&filled(&leg()), 1, 2.0).to_text();
    assert!(text.starts_with(
        "lift: iteration-limit in 2.00 s, 4 iterations of 500.00 ms\n1 of 2 gaps filled\n\nmarker  first frame"
    ));
}

#[test]
fn csv_keeps_every_digit_and_quotes_what_it_must() {
    let names = ["a,b", "say \"hi\""];
    let take = hide(&crate::take(&names, 3), &[gap(0, 0..1), gap(1, 1..3)]);
    assert_eq!(
        TakeSummary::new(&take, 1).gaps_csv(),
        "marker,first_frame,last_frame,frames,seconds\n\"a,b\",1,1,1,0.01\n\"say \"\"hi\"\"\",2,3,2,0.02\n"
    );
    let csv = FillSummary::new(&filled(&leg()), 1, 2.0).gaps_csv();
    let mut lines = csv.lines();
    assert_eq!(
        lines.next(),
        Some("marker,first_frame,last_frame,method,sigma_mm,border_step_mm,refused")
    );
    assert!(lines.next().unwrap().starts_with("KNEE,11,20,lift,5,"));
    assert_eq!(
        lines.next(),
        Some("ANKLE,31,50,lift,,,\"the gap lasts 0.200 s, longer than the limit of 0.150 s\"")
    );
}

#[test]
fn an_empty_take_has_a_summary() {
    let summary = TakeSummary::new(&crate::take(&["A"], 0), 1);
    assert_eq!((summary.last_frame, summary.gap_count, summary.labelled_percent), (0, 0, 100.0));
    assert!(serde_json::to_string(&summary).is_ok());
    let far = TakeSummary::new(&leg(), i64::MAX);
    assert_eq!(far.first_frame, i64::MAX);
}
