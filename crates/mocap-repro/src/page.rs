use crate::{Table, table::escape};

const STYLE: &str = "\
body{font:15px/1.45 'DejaVu Sans',Verdana,sans-serif;color:#222;max-width:1240px;margin:2em auto;padding:0 1em}\
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}\
table{border-collapse:collapse;font-size:.85em;display:block;overflow-x:auto}\
th,td{padding:.2em .7em;text-align:left;border-bottom:1px solid #ddd}\
.n{text-align:right;font-variant-numeric:tabular-nums}svg{max-width:100%;height:auto}";

/// One web page that loads nothing from elsewhere; figures are SVG and stand in it as they are.
pub(crate) fn html(
    title: &str,
    intro: &[String],
    tables: &[Table],
    figures: &[(String, String)],
) -> String {
    let title = escape(title);
    let intro: Vec<String> = intro.iter().map(|p| format!("<p>{}</p>\n", escape(p))).collect();
    let intro = intro.concat();
    let figure = |(title, svg): &(String, String)| format!("<h2>{}</h2>\n{svg}\n", escape(title));
    let figures: String = figures.iter().map(figure).collect();
    let tables: String = tables.iter().map(Table::to_html).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{intro}{figures}{tables}</body>\n</html>\n"
    )
}
