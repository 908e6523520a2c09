//! Links between the documents lead to something that is there.

use super::{Finding, Tree};

const RULE: &str = "links";

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, text) in tree.of_kind(&["md"]) {
        let mut in_code = false;
        for (line, text) in (1..).zip(text.lines()) {
            in_code ^= text.trim_start().starts_with("```");
            let targets = targets(text).filter(|target| !in_code && is_local(target));
            for target in targets.filter(|target| !exists(tree, path, target)) {
                let message = format!("`{target}` leads nowhere: correct the link");
                findings.push(Finding::new(path, line, RULE, message));
            }
        }
    }
    findings
}

/// What stands in the round brackets of `[text](target)`.
fn targets(line: &str) -> impl Iterator<Item = &str> {
    line.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0))
}

/// Addresses are not ours to check, and rustdoc checks the names of Rust items.
fn is_local(target: &str) -> bool {
    !["://", "::", "mailto:", ".html"].iter().any(|mark| target.contains(mark))
        && !target.starts_with('#')
}

fn exists(tree: &Tree, from: &str, target: &str) -> bool {
    let target = target.split('#').next().unwrap_or_default();
    let mut parts: Vec<_> = from.split('/').collect();
    parts.pop();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()),
            name => parts.push(name),
        }
    }
    let path = parts.join("/");
    let folder = format!("{path}/");
    tree.paths.iter().any(|known| *known == path || known.starts_with(&folder))
}

#[cfg(test)]
mod tests {
    use super::{super::testing::*, *};

    #[test]
    fn links_to_files_folders_addresses_and_items_pass() {
        let text = "[a](b.md#top) [b](../crates/a) [c](https://x.org/y) [d](crate::Take) [e](#x)\n";
        assert!(
            check(&tree(&[("docs/a.md", text), ("docs/b.md", ""), ("crates/a/c.rs", "")]))
                .is_empty()
        );
    }

    #[test]
    fn a_link_that_leads_nowhere_is_found_unless_it_is_code() {
        let text = "[a](a.md)\n[`b`](../gone.md)\n```text\n[c](gone.md)\n```\n";
        assert_one(&check(&tree(&[("docs/a.md", text)])), "docs/a.md:2:", "../gone.md");
    }
}
