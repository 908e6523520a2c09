use crate::{FillSummary, TakeSummary, draw::printable, table::escape};

const STYLE: &str = "\
body{font:15px/1.45 'DejaVu Sans',Verdana,sans-serif;color:#222;max-width:1240px;margin:2em auto;padding:0 1em}\
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}\
table{border-collapse:collapse;font-size:.9em;display:block;overflow-x:auto}\
th,td{padding:.25em .8em;text-align:left;border-bottom:1px solid #ddd}\
.n{text-align:right;font-variant-numeric:tabular-nums}svg{max-width:100%;height:auto}";

/// One web page with everything on a take and its fill: nothing is loaded from elsewhere.
///
/// `figure` is SVG as [`render_svg`](crate::render_svg) gives it and stands in the page as it is; bytes
/// that are not UTF-8 are left out.
#[must_use]
pub fn html_page(
    title: &str,
    take: &TakeSummary,
    fill: Option<&FillSummary>,
    figure: Option<&[u8]>,
) -> String {
    let title = escape(&printable(title));
    let figure = figure.and_then(|svg| std::str::from_utf8(svg).ok()).unwrap_or_default();
    let fill = fill.map(fill_section).unwrap_or_default();
    let body = format!("{}{fill}{figure}\n{}", take_section(take), marker_section(take));
    web_page(&title, &body)
}

/// A web page of this body in the style of all reports; `title` and `body` are HTML and stand in it as
/// they are.
#[must_use]
pub fn web_page(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n"
    )
}

fn take_section(take: &TakeSummary) -> String {
    let unused = if take.unused_markers.is_empty() {
        String::new()
    } else {
        let names = escape(&printable(&take.unused_markers.join(", ")));
        format!("<p>Unused markers: {names}</p>\n")
    };
    let line = escape(&take.headline().replace('\n', "; "));
    format!("<p>{line}.</p>\n{unused}")
}

fn fill_section(fill: &FillSummary) -> String {
    format!(
        "<h2>Fill</h2>\n<p>{}</p>\n{}",
        escape(&printable(&fill.headline())),
        fill.gap_table().to_html()
    )
}

fn marker_section(take: &TakeSummary) -> String {
    let gaps = if take.gaps.is_empty() {
        String::new()
    } else {
        format!("<h2>Gaps of the input</h2>\n{}", take.gap_table().to_html())
    };
    format!("<h2>Markers</h2>\n{}{gaps}", take.marker_table(|_| true).to_html())
}
