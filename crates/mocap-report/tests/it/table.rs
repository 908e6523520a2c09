use mocap_report::{Entry, Table};

fn table() -> Table {
    Table::new(["the name", "x %", "y"]).with_rows([
        vec![Entry::text("a|b, c"), Entry::scientific(Some(0.001_234_5)), Entry::count(3)],
        vec![Entry::text("<d>"), Entry::number(None, 1)],
        vec![Entry::text("\u{e9}"), Entry::number(Some(2.345), 1), Entry::integer(Some(-7))],
    ])
}

#[test]
fn tables_say_the_same_in_every_form() {
    assert_eq!(
        table().to_markdown(),
        "| the name | x % | y |\n| --- | ---: | ---: |\n| a\\|b, c | 1.23e-3 | 3 |\n\
         | <d> | \u{2013} | \u{2013} |\n| \u{e9} | 2.3 | -7 |\n"
    );
    assert_eq!(
        table().to_csv(),
        "the_name,x_percent,y\n\"a|b, c\",0.0012345,3\n<d>,,\n\u{e9},2.345,-7\n"
    );
    assert_eq!(
        table().to_text(),
        "the name      x %   y\na|b, c    1.23e-3   3\n<d>             -   -\n\u{e9}             2.3  -7\n"
    );
    let html = table().to_html();
    assert!(html.contains("<th>the name</th><th class=\"n\">x %</th>"));
    assert!(html.contains("<td>&lt;d&gt;</td><td class=\"n\">\u{2013}</td>"));
}

#[test]
fn rows_are_as_long_as_there_are_columns() {
    let mut table = table();
    table.push(vec![Entry::Empty; 9]);
    assert!(table.rows().iter().all(|row| row.len() == 3));
    table.truncate(1);
    assert_eq!(table.rows().len(), 1);
    assert!(Table::new(["a"]).is_empty());
    assert_eq!(Table::new(["a"]).to_csv(), "a\n");
    assert_eq!(Entry::number(Some(f64::NAN), 2), Entry::Empty);
    assert_eq!(Entry::scientific(Some(f64::INFINITY)), Entry::Empty);
}
