use std::path::Path;

use mocap_core::{BoneSet, CoreError, MarkerSet, Mask, Take};
use mocap_report::{
    FigureFormat, MAX_FIGURE_MARKERS, PlotInput, ReportError, plot_take, render_png, render_svg,
};
use ndarray::Array3;

use crate::{chain, filled, gap, hide, leg, take, xml};

/// Colours of the states in a figure.
const FILLED: &str = "#0072B2";
const MISSING: &str = "#D55E00";

fn svg(input: &PlotInput<'_>) -> String {
    let svg = String::from_utf8(render_svg(input).unwrap()).unwrap();
    xml::check(&svg).unwrap();
    svg
}

/// Left edges and widths, in pixels of the figure, of the bars of a colour.
fn bars(svg: &str, colour: &str) -> Vec<(f64, f64)> {
    let attribute = |line: &str, name: &str| -> f64 {
        let (_, after) = line.split_once(&format!(" {name}=\"")).unwrap();
        after.split('"').next().unwrap().parse::<f64>().unwrap() / 4.0
    };
    svg.lines()
        .filter(|line| line.starts_with("<rect") && line.contains(colour))
        .map(|line| (attribute(line, "x"), attribute(line, "width")))
        .collect()
}

fn curves(svg: &str, colour: &str) -> usize {
    svg.lines().filter(|line| line.starts_with("<polyline") && line.contains(colour)).count()
}

#[test]
fn a_fill_shows_its_markers_and_spans() {
    let truth = leg();
    let (filled, bones) = (filled(&truth), chain(&truth));
    let svg = svg(&PlotInput { truth: Some(&truth), ..PlotInput::fill("a fill", &filled, &bones) });
    for text in ["a fill", "KNEE", "ANKLE", "KNEE x (mm)", "HIP \u{2013} KNEE (mm)", "time (s)"] {
        let shown = svg.lines().any(|line| line.split_whitespace().eq(text.split_whitespace()));
        assert!(shown, "`{text}` is missing");
    }
    let (blue, red) = (bars(&svg, FILLED), bars(&svg, MISSING));
    assert_eq!((blue.len(), red.len()), (1, 1));
    // Ten and twenty of fifty frames; bars are whole quarters of a pixel.
    assert!((red[0].1 / blue[0].1 - 2.0).abs() < 0.01, "{blue:?} {red:?}");
    // One key of the legend; x, y, z of the knee; its two bones.
    assert_eq!(curves(&svg, FILLED), 1 + 3 + 2);
}

#[test]
fn a_measured_take_shows_no_fill() {
    let input = hide(&leg(), &[gap(1, 10..20)]);
    let svg = svg(&PlotInput::take("measured", &input, &BoneSet::default()));
    assert!(!svg.contains(FILLED));
    assert_eq!(bars(&svg, MISSING).len(), 1);
}

#[test]
fn two_files_show_the_same_as_a_fill() {
    let truth = leg();
    let (filled, bones) = (filled(&truth), chain(&truth));
    let input = hide(&truth, &[gap(1, 10..20), gap(2, 30..50)]);
    let pair = PlotInput::pair("same", &input, filled.take(), &bones);
    assert_eq!(svg(&pair), svg(&PlotInput::fill("same", &filled, &bones)));
}

#[test]
fn the_subject_is_named_only_where_there_are_two() {
    let bones = BoneSet::default();
    let (one, two) = (take(&["jane:A", "jane:B"], 5), take(&["jane:A", "joe:A"], 5));
    assert!(!svg(&PlotInput::take("", &one, &bones)).contains("jane:"));
    let both = svg(&PlotInput::take("", &two, &bones));
    assert!(both.contains("jane:A") && both.contains("joe:A"));
}

#[test]
fn chosen_markers_are_drawn_and_no_other() {
    let input = hide(&leg(), &[gap(1, 10..20)]);
    let bones = BoneSet::default();
    let chosen = PlotInput { markers: Some(vec![0]), ..PlotInput::take("", &input, &bones) };
    let svg = svg(&chosen);
    assert!(svg.contains("HIP  z (mm)") && !svg.contains("KNEE  z (mm)"));
}

#[test]
fn png_has_the_size_of_the_svg_twice() {
    let truth = leg();
    let (filled, bones) = (filled(&truth), chain(&truth));
    let input = PlotInput::fill("both", &filled, &bones);
    let png = render_png(&input).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    let svg = svg(&input);
    assert!(svg.starts_with(&format!(
        "<svg width=\"{}\" height=\"{}\"",
        number(16) / 2,
        number(20) / 2
    )));
    assert_eq!(number(16), 2400);
    let image = png::Decoder::new(png.as_slice());
    let mut reader = image.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size()];
    reader.next_frame(&mut pixels).unwrap();
    let has = |rgb: [u8; 3]| pixels.chunks_exact(3).any(|p| p == rgb);
    assert!(has([255; 3]) && has([0, 114, 178]) && has([213, 94, 0]));
}

#[test]
fn sharp_turns_stay_inside_their_chart() {
    let xyz = Array3::from_shape_fn((2000, 1, 3), |(t, _, _)| if t % 2 == 0 { 0.0 } else { 1.0 });
    let take = Take::from_positions(MarkerSet::new(["ZIGZAG"]).unwrap(), 100.0, xyz).unwrap();
    let png = render_png(&PlotInput::take("zigzag", &take, &BoneSet::default())).unwrap();
    let mut reader = png::Decoder::new(png.as_slice()).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size()];
    reader.next_frame(&mut pixels).unwrap();
    // Above the right part of the first chart, whose data begin at 180 units, nothing is drawn.
    let mut above = pixels.chunks_exact(3 * 2400).skip(200).take(150);
    assert!(above.all(|row| row[3 * 500..3 * 780].iter().all(|&c| c == 255)));
}

#[test]
fn any_take_gives_a_figure() {
    let odd = ["a<b>&\"c'", "名前", "\u{7}bell\nline", "é:", "x".repeat(300).leak()];
    let full = take(&odd, 30);
    let nothing = hide(&full, &(0..5).map(|m| gap(m, 0..30)).collect::<Vec<_>>());
    let many: Vec<String> = (0..300).map(|m| format!("M{m}")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    let crowd = take(&many, 20);
    let crowd = hide(&crowd, &(0..300).map(|m| gap(m, m % 10..10 + m % 7)).collect::<Vec<_>>());
    let huge = full.map_positions(|t, _, _| [1e305 * t as f64, -1e308, f64::MAX]).unwrap();
    for take in
        [&full, &nothing, &crowd, &huge, &take(&["ONE"], 1), &take(&["NONE"], 0), &take(&[], 9)]
    {
        let bones = chain(take);
        svg(&PlotInput::take("any", take, &bones));
        let open = Mask::none(take.frames(), take.marker_count());
        let guessed = PlotInput { measured: &open, ..PlotInput::take("guessed", take, &bones) };
        svg(&guessed);
        render_png(&guessed).unwrap();
    }
}

#[test]
fn long_takes_give_small_files() {
    let long = take(&["A", "B"], 200_000);
    let svg = svg(&PlotInput::take("an hour", &long, &chain(&long)));
    // Seven curves of at most four points in each of 700 columns, 11 characters a point.
    assert!(svg.len() < 7 * 4 * 700 * 11 + 20_000, "{} bytes", svg.len());
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let (take, bones) = (leg(), BoneSet::default());
    let plain = PlotInput::take("", &take, &bones);
    let mask = Mask::none(50, 2);
    let error = render_svg(&PlotInput { measured: &mask, ..plain.clone() }).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the mask of measured cells has 50 frames × 2 markers, but the take has 50 × 3"
    );
    let short = crate::take(&["HIP", "KNEE", "ANKLE"], 49);
    let error = render_svg(&PlotInput { truth: Some(&short), ..plain.clone() }).unwrap_err();
    assert!(matches!(error, ReportError::Shape { found_frames: 49, .. }));
    let with_markers = |m: Vec<usize>| PlotInput { markers: Some(m), ..plain.clone() };
    let error = render_svg(&with_markers(vec![3])).unwrap_err();
    assert!(matches!(error, ReportError::Core(CoreError::OutOfRange { marker: 3, .. })));
    let error = render_png(&with_markers(vec![0; MAX_FIGURE_MARKERS + 1])).unwrap_err();
    assert!(matches!(error, ReportError::TooManyMarkers { asked: 13, limit: 12 }));
    let foreign = chain(&crate::take(&["1", "2", "3", "4"], 50));
    let error = render_svg(&PlotInput { bones: &foreign, ..plain }).unwrap_err();
    assert!(matches!(error, ReportError::Core(CoreError::OutOfRange { .. })));
}

#[test]
fn the_extension_names_the_format() {
    let format = |path: &str| FigureFormat::from_path(Path::new(path));
    assert_eq!(format("a/b.SVG").unwrap(), FigureFormat::Svg);
    assert_eq!(format("b.png").unwrap(), FigureFormat::Png);
    assert_eq!(
        format("walk.pdf").unwrap_err().to_string(),
        "`walk.pdf` ends in neither .svg nor .png; name the figure one of the two"
    );
    let (take, bones) = (leg(), BoneSet::default());
    let input = PlotInput::take("", &take, &bones);
    assert_eq!(plot_take(&input, Path::new("x.svg")).unwrap(), render_svg(&input).unwrap());
    assert!(plot_take(&input, Path::new("x")).is_err());
}
