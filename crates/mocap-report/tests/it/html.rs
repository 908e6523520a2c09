use mocap_report::{FillSummary, PlotInput, TakeSummary, html_page, render_svg};

use crate::{chain, filled, gap, hide, leg, take, xml};

fn page() -> String {
    let truth = leg();
    let (filled, bones) = (filled(&truth), chain(&truth));
    let input = hide(&truth, &[gap(1, 10..20), gap(2, 30..50)]);
    let svg = render_svg(&PlotInput::fill("a fill", &filled, &bones)).unwrap();
    let fill = FillSummary::new(&filled, 1, 2.0);
    html_page("a fill", &TakeSummary::new(&input, 1), Some(&fill), Some(&svg))
}

#[test]
fn the_page_holds_figure_and_tables() {
    let page = page();
    assert_eq!(page.matches("<svg").count(), 1);
    // The fill, the markers, the gaps.
    assert_eq!(page.matches("<table>").count(), 3);
    assert!(page.contains("<td>KNEE</td>") && page.contains("longer than the limit"));
}

#[test]
fn the_page_is_well_formed_and_loads_nothing() {
    let page = page();
    let (_, html) = page.split_once('\n').unwrap();
    xml::check(&html.replace("<meta charset=\"utf-8\">", "")).unwrap();
    let elsewhere = page.replace("http://www.w3.org/2000/svg", "");
    for loader in ["http", "src=", "href=", "url(", "@import", "<script", "<link"] {
        assert!(!elsewhere.contains(loader), "{loader}");
    }
}

#[test]
fn names_cannot_inject_markup() {
    let evil = take(&["<script>alert(1)</script>"], 4);
    let evil = hide(&evil, &[gap(0, 0..4)]);
    let page = html_page("<b>&", &TakeSummary::new(&evil, 1), None, None);
    assert!(!page.contains("<script") && !page.contains("<b>"));
    assert!(page.contains("&lt;script&gt;alert(1)&lt;/script&gt;"));
}

#[test]
fn a_figure_that_is_no_text_is_left_out() {
    let page = html_page("x", &TakeSummary::new(&leg(), 1), None, Some(&[0xff, 0xfe]));
    assert!(!page.contains("<svg"));
}
