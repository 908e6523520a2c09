//! No crate depends on what `ARCHITECTURE.md` forbids it.

use std::collections::{HashMap, VecDeque};

use super::{
    Crate, Finding, Tree,
    architecture::{self, Ban, Row},
};

const RULE: &str = "dependencies";

/// Files that must not use a crate although their own crate depends on it.
struct Narrow {
    folder: &'static str,
    except: &'static str,
    word: &'static str,
    why: &'static str,
}

const NARROW: &[Narrow] = &[Narrow {
    folder: "crates/lds-kalman/src/",
    except: "crates/lds-kalman/src/filler",
    word: "mocap_core",
    why: "the linear dynamical system works on matrices, whatever they measure; what ties it to \
          motion capture belongs into the module `filler`",
}];

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let rows = architecture::rows(tree);
    let edge_only = architecture::edge_only(tree);
    let layers = rows.iter().map(|row| (row.name.as_str(), row.layer.as_str())).collect();
    let mut findings = Vec::new();
    for krate in &tree.crates {
        let Some(row) = rows.iter().find(|row| row.name == krate.name) else { continue };
        for chain in chains(tree, krate) {
            if let Some(why) = objection(row, &chain, &layers, &edge_only) {
                findings.push(report(tree, krate, &chain, &why));
            }
        }
    }
    findings.extend(narrow(tree));
    findings
}

/// The ways from a crate to all it depends on: over crates of the workspace to any depth, to
/// packages from elsewhere only directly, because what those need is not ours to choose.
fn chains<'a>(tree: &'a Tree, krate: &'a Crate) -> Vec<Vec<&'a str>> {
    let mut found: Vec<Vec<&str>> = Vec::new();
    let mut waiting = VecDeque::from([(krate, vec![krate.name.as_str()])]);
    while let Some((from, chain)) = waiting.pop_front() {
        for name in &from.dependencies {
            let inner = tree.crates.iter().find(|other| other.name == *name);
            let known = found.iter().any(|chain| chain.last() == Some(&name.as_str()));
            if known || (inner.is_none() && chain.len() > 1) {
                continue;
            }
            let chain = [&chain[..], &[name]].concat();
            waiting.extend(inner.map(|inner| (inner, chain.clone())));
            found.push(chain);
        }
    }
    found
}

/// Why the last link of a chain may not be there.
fn objection(
    row: &Row,
    chain: &[&str],
    layers: &HashMap<&str, &str>,
    edge_only: &[String],
) -> Option<String> {
    let target = *chain.last()?;
    let layer = layers.get(target).copied();
    let hits = |ban: &&Ban| match ban {
        Ban::Package(pattern) => matches(pattern, target),
        Ban::Layer(banned) => layer.is_some_and(|layer| banned == "workspace" || banned == layer),
    };
    match row.banned.iter().find(hits) {
        Some(Ban::Package(pattern)) => return Some(format!("its row forbids `{pattern}`")),
        Some(Ban::Layer(banned)) => return Some(format!("its row forbids *{banned}*")),
        None => {}
    }
    if row.layer != "edge" && edge_only.iter().any(|name| name == target) {
        return Some("only crates of the layer edge may".into());
    }
    if row.layer != "dev" && layer == Some("dev") {
        return Some("it serves tests: make it a dev-dependency".into());
    }
    None
}

fn matches(pattern: &str, name: &str) -> bool {
    pattern.strip_suffix('*').map_or(pattern == name, |start| name.starts_with(start))
}

fn report(tree: &Tree, krate: &Crate, chain: &[&str], why: &str) -> Finding {
    let manifest = format!("{}/Cargo.toml", krate.folder);
    let text = tree.text(&manifest).unwrap_or_default();
    let starts = |line: &str| {
        let rest = line.trim_start().strip_prefix(chain[1]);
        rest.is_some_and(|rest| rest.starts_with([' ', '.', '=']))
    };
    let line = (1..).zip(text.lines()).find_map(|(number, line)| starts(line).then_some(number));
    let message = format!(
        "`{}` must not depend on `{}` ({}): {why}. Move the code that needs it, or change {} \
         together with a note in docs/adr that says why",
        krate.name,
        chain[chain.len() - 1],
        chain.join(" -> "),
        architecture::FILE,
    );
    Finding::new(&manifest, line.unwrap_or(0), RULE, message)
}

fn narrow(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for Narrow { folder, except, word, why } in NARROW {
        let files = tree.of_kind(&["rs"]);
        for (path, text) in files.filter(|(p, _)| p.starts_with(folder) && !p.starts_with(except)) {
            for (line, text) in (1..).zip(text.lines()).filter(|(_, text)| is_code(text)) {
                if text.contains(word) {
                    findings.push(Finding::new(path, line, RULE, format!("`{word}` here: {why}")));
                }
            }
        }
    }
    findings
}

fn is_code(line: &str) -> bool {
    !line.trim_start().starts_with("//")
}

#[cfg(test)]
mod tests {
    use super::{super::testing::*, *};

    /// A core, an algorithm, a crate for tests, a program, and whatever row the test adds.
    fn house(row: &str) -> Tree {
        let text = format!(
            "<!-- tidy:crates -->\n\
             | `core` | core | x | *workspace*, `serde` |\n\
             | `em` | algorithm | x | `em-*` |\n\
             | `kit` | dev | x | – |\n\
             {row}\n\
             <!-- tidy:end -->\n\
             <!-- tidy:edge-only -->\n`clap`, `anyhow`\n<!-- tidy:end -->\n"
        );
        let manifest = "[dependencies]\nndarray = \"1\"\nserde.workspace = true\n";
        tree(&[("ARCHITECTURE.md", &text), ("crates/core/Cargo.toml", manifest)])
            .with_crate("em", &["core"])
            .with_crate("kit", &["core"])
    }

    #[test]
    fn what_the_table_allows_passes() {
        let tree = house("| `io` | data | x | *algorithm* |");
        let tree = tree.with_crate("core", &["ndarray"]).with_crate("io", &["core", "serde"]);
        assert!(check(&tree).is_empty(), "{:?}", lines(&check(&tree)));
    }

    #[test]
    fn a_forbidden_package_is_found_at_its_line() {
        let tree = house("").with_crate("core", &["ndarray", "serde"]);
        assert_one(&check(&tree), "crates/core/Cargo.toml:3:", "forbids `serde`");
    }

    #[test]
    fn a_forbidden_layer_is_found_behind_a_crate_in_between() {
        let tree = house("| `io` | data | x | *algorithm* |\n| `glue` | registry | x | – |");
        let tree =
            tree.with_crate("core", &[]).with_crate("glue", &["em"]).with_crate("io", &["glue"]);
        assert_one(&check(&tree), "crates/io/Cargo.toml", "io -> glue -> em");
    }

    #[test]
    fn a_pattern_forbids_every_name_that_starts_so() {
        let tree = house("| `em-soft` | algorithm | x | – |");
        let mut tree = tree.with_crate("core", &[]).with_crate("em-soft", &[]);
        tree.crates[0].dependencies.push("em-soft".into());
        assert_one(&check(&tree), "crates/em/Cargo.toml", "forbids `em-*`");
    }

    #[test]
    fn the_core_depends_on_no_crate_of_the_workspace() {
        let tree = house("").with_crate("core", &["em"]);
        assert!(lines(&check(&tree)).iter().any(|line| line.contains("forbids *workspace*")));
    }

    #[test]
    fn what_belongs_to_the_edge_is_found_elsewhere() {
        let row = "| `app` | edge | x | – |\n| `io` | data | x | – |";
        let tree = house(row).with_crate("core", &[]).with_crate("app", &["clap"]);
        assert!(check(&tree).is_empty());
        assert_one(&check(&tree.with_crate("io", &["clap"])), "crates/io", "layer edge");
    }

    #[test]
    fn test_support_is_found_among_the_dependencies_of_a_library() {
        let tree = house("| `io` | data | x | – |");
        let tree = tree.with_crate("core", &[]).with_crate("io", &["kit"]);
        assert_one(&check(&tree), "crates/io", "dev-dependency");
    }

    #[test]
    fn the_matrix_part_of_the_dynamical_system_knows_no_markers() {
        let text = "//! For mocap_core see `filler`.\nuse mocap_core::Take;\n";
        let tree = tree(&[
            ("crates/lds-kalman/src/filler.rs", text),
            ("crates/lds-kalman/src/model.rs", text),
        ]);
        assert_one(&check(&tree), "crates/lds-kalman/src/model.rs:2:", "filler");
    }
}
