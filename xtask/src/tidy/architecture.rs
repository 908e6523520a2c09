//! `ARCHITECTURE.md` holds every crate of the workspace and no other.
//!
//! Its table of crates is read by people and by this program alike: the layer of each crate, and
//! what it must never depend on.

use super::{Finding, Tree};

pub(super) const FILE: &str = "ARCHITECTURE.md";
const RULE: &str = "architecture";
const TABLE: (&str, &str) = ("<!-- tidy:crates -->", "<!-- tidy:end -->");
const EDGE_ONLY: (&str, &str) = ("<!-- tidy:edge-only -->", "<!-- tidy:end -->");
const LAYERS: &[&str] = &["core", "algorithm", "data", "registry", "edge", "dev", "link"];

/// A row of the table: `` | `name` | layer | what it holds | `banned`, *layer* | ``.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) line: usize,
    pub(super) name: String,
    pub(super) layer: String,
    pub(super) banned: Vec<Ban>,
}

/// What a crate must not depend on.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Ban {
    /// `` `name` ``, or `` `start-*` `` for all whose name starts so.
    Package(String),
    /// `*layer*`: every crate of that layer, or of all layers for `*workspace*`.
    Layer(String),
}

/// The table's rows; none where it is missing, which [`check`] reports.
pub(super) fn rows(tree: &Tree) -> Vec<Row> {
    between(tree, TABLE).filter_map(|(line, text)| parse_row(line, text)).collect()
}

/// The packages that only crates of the layer `edge` may depend on.
pub(super) fn edge_only(tree: &Tree) -> Vec<String> {
    between(tree, EDGE_ONLY).flat_map(|(_, text)| quoted(text, '`')).map(str::to_owned).collect()
}

fn between<'a>(
    tree: &'a Tree,
    (start, end): (&'static str, &'static str),
) -> impl Iterator<Item = (usize, &'a str)> {
    let text = tree.text(FILE).unwrap_or_default();
    let lines = (1..).zip(text.lines()).skip_while(move |(_, line)| line.trim() != start);
    lines.skip(1).take_while(move |(_, line)| line.trim() != end)
}

fn parse_row(line: usize, text: &str) -> Option<Row> {
    let cells: Vec<_> = text.trim().trim_matches('|').split('|').map(str::trim).collect();
    let &[name, layer, _, banned] = cells.as_slice() else { return None };
    let name = name.strip_prefix('`')?.strip_suffix('`')?.to_owned();
    let packages = quoted(banned, '`').map(|name| Ban::Package(name.into()));
    // A `*` inside a package pattern is no mark of a layer.
    let outside: String = banned.split('`').step_by(2).collect();
    let layers = quoted(&outside, '*').map(|name| Ban::Layer(name.into())).collect::<Vec<_>>();
    Some(Row { line, name, layer: layer.into(), banned: packages.chain(layers).collect() })
}

/// The words between pairs of a mark.
fn quoted(text: &str, mark: char) -> impl Iterator<Item = &str> {
    text.split(mark).skip(1).step_by(2)
}

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let rows = rows(tree);
    let finding = |line, message| Finding::new(FILE, line, RULE, message);
    let mut findings = Vec::new();
    for krate in &tree.crates {
        match rows.iter().filter(|row| row.name == krate.name).count() {
            1 => {}
            0 => findings.push(finding(
                0,
                format!("the crate `{}` has no row in the table of crates: add one", krate.name),
            )),
            n => findings.push(finding(0, format!("`{}` has {n} rows: keep one", krate.name))),
        }
    }
    for row in &rows {
        if !tree.crates.iter().any(|krate| krate.name == row.name) {
            let message = format!("no crate is called `{}`: take its row out", row.name);
            findings.push(finding(row.line, message));
        }
        let banned = row.banned.iter().filter_map(|ban| match ban {
            Ban::Layer(layer) if layer != "workspace" => Some(layer),
            _ => None,
        });
        for layer in banned.chain([&row.layer]).filter(|layer| !LAYERS.contains(&layer.as_str())) {
            let message = format!("`{layer}` is no layer: use one of {}", LAYERS.join(", "));
            findings.push(finding(row.line, message));
        }
    }
    findings.extend(missing_paths(tree));
    findings
}

/// Paths such as `crates/name` in any document must lead to a folder that exists.
fn missing_paths(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, text) in tree.of_kind(&["md"]) {
        for (line, text) in (1..).zip(text.lines()) {
            for (start, _) in text.match_indices("crates/") {
                let is_start =
                    text[..start].chars().next_back().is_none_or(|c| " `(\"[".contains(c));
                let rest = &text[start + "crates/".len()..];
                let name = rest.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-')).next();
                let name = name.unwrap_or_default();
                let exists = tree.crates.iter().any(|krate| krate.name == name);
                if is_start && !name.is_empty() && !exists {
                    let message = format!("there is no `crates/{name}`: correct the path");
                    findings.push(Finding::new(path, line, RULE, message));
                }
            }
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::{super::testing::*, *};

    fn with_table(rows: &str) -> Tree {
        let text = format!("# Map\n\n{}\n{rows}\n{}\n", TABLE.0, TABLE.1);
        tree(&[(FILE, &text)])
    }

    #[test]
    fn a_true_table_passes() {
        let tree = with_table(
            "| crate | layer | holds | never |\n|---|---|---|---|\n| `a` | core | x | – |",
        );
        assert!(check(&tree.with_crate("a", &[])).is_empty());
    }

    #[test]
    fn a_row_names_packages_patterns_and_layers() {
        let tree = with_table("| `a` | core | x, `y` | `serde`, `b-*`, *algorithm* |");
        let [row] = &rows(&tree)[..] else { panic!("one row") };
        let bans = [
            Ban::Package("serde".into()),
            Ban::Package("b-*".into()),
            Ban::Layer("algorithm".into()),
        ];
        assert_eq!(row.banned, bans);
    }

    #[test]
    fn a_crate_without_a_row_is_found() {
        let tree = with_table("| `a` | core | x | – |").with_crate("a", &[]).with_crate("b", &[]);
        assert_one(&check(&tree), "ARCHITECTURE.md: error", "`b` has no row");
    }

    #[test]
    fn a_row_without_a_crate_is_found() {
        let tree = with_table("| `a` | core | x | – |\n| `gone` | core | x | – |");
        assert_one(&check(&tree.with_crate("a", &[])), "ARCHITECTURE.md:5:", "`gone`");
    }

    #[test]
    fn a_row_that_stands_twice_is_found() {
        let tree = with_table("| `a` | core | x | – |\n| `a` | core | x | – |");
        assert_one(&check(&tree.with_crate("a", &[])), "ARCHITECTURE.md", "2 rows");
    }

    #[test]
    fn an_unknown_layer_is_found_in_either_column() {
        for row in ["| `a` | cellar | x | – |", "| `a` | core | x | *cellar* |"] {
            assert_one(
                &check(&with_table(row).with_crate("a", &[])),
                "ARCHITECTURE.md:4:",
                "cellar",
            );
        }
    }

    #[test]
    fn a_path_to_a_crate_that_is_gone_is_found() {
        let mut tree = with_table("| `a` | core | x | – |").with_crate("a", &[]);
        tree.files.insert("docs/x.md".into(), "see `crates/a/src` and\n`crates/gone/src`\n".into());
        assert_one(&check(&tree), "docs/x.md:2:", "crates/gone");
    }
}
