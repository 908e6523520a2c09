use std::path::Path;

use mocap_core::Mask;
use mocap_report::{MAX_SPOTS, ReportError, Spot, plot_spots};

use crate::{leg, xml};

fn spot(marker: usize, frames: std::ops::Range<usize>) -> Spot {
    Spot { marker, frames, note: "spike, 40 mm".to_owned() }
}

#[test]
fn each_spot_has_a_close_up_with_its_samples_marked() {
    let take = leg();
    let suspect =
        Mask::from_fn(take.frames(), take.marker_count(), |t, m| m == 1 && (30..33).contains(&t));
    let spots = [spot(1, 30..33), spot(0, 0..1)];
    let svg = plot_spots("a leg", &take, &suspect, &spots, Path::new("x.svg")).unwrap();
    let svg = String::from_utf8(svg).unwrap();
    xml::check(&svg).unwrap();
    assert!(svg.contains("2 faults") && svg.contains("suspect"));
    assert_eq!(svg.matches("spike, 40 mm").count(), 2);
    let png = plot_spots("a leg", &take, &suspect, &spots, Path::new("x.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG"));
}

#[test]
fn the_page_says_what_it_leaves_out() {
    let take = leg();
    let none = Mask::none(take.frames(), take.marker_count());
    let many: Vec<Spot> = (0..=MAX_SPOTS).map(|t| spot(0, t..t + 1)).collect();
    let draw = |spots: &[Spot]| {
        String::from_utf8(plot_spots("", &take, &none, spots, Path::new("x.svg")).unwrap()).unwrap()
    };
    assert!(draw(&many).contains(&format!("the {MAX_SPOTS} largest of {} faults", MAX_SPOTS + 1)));
    assert!(draw(&[]).contains("no faults found"));
    // Frames beyond the take leave an empty window, not a panic.
    draw(&[spot(0, 10_000..10_001)]);
}

#[test]
fn what_does_not_belong_to_the_take_is_refused() {
    let take = leg();
    let path = Path::new("x.svg");
    let short = Mask::none(1, 1);
    assert!(matches!(plot_spots("", &take, &short, &[], path), Err(ReportError::Shape { .. })));
    let none = Mask::none(take.frames(), take.marker_count());
    assert!(matches!(
        plot_spots("", &take, &none, &[spot(99, 0..1)], path),
        Err(ReportError::Core(_))
    ));
    let gif = Path::new("x.gif");
    assert!(matches!(plot_spots("", &take, &none, &[], gif), Err(ReportError::Format { .. })));
}
