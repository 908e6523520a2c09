//! Every citation such as `[Li10]` resolves in `docs/references.bib`.

use std::collections::HashSet;

use super::{Finding, Tree, kind};

const RULE: &str = "citations";
const FILE: &str = "docs/references.bib";

/// Words before a bracket that make it a citation whatever its shape.
const BEFORE: &[&str] = &["Implements ", "Deviates from "];
/// Words after a bracket that do.
const AFTER: &[&str] = &[" Eq", " Sec", " Alg", " Table", " Fig"];

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let (keys, mut findings) = keys(tree.text(FILE).unwrap_or_default());
    for (path, text) in tree.of_kind(&["rs", "md"]) {
        let is_rust = kind(path) == "rs";
        for (line, text) in (1..).zip(text.lines()) {
            let prose = if is_rust { comment(text) } else { text };
            for key in citations(prose).filter(|key| !keys.contains(key)) {
                let message =
                    format!("[{key}] is not in {FILE}: correct the key, or add the work under it");
                findings.push(Finding::new(path, line, RULE, message));
            }
        }
    }
    findings
}

/// The keys of the bibliography, and those that stand there twice.
fn keys(bibliography: &str) -> (HashSet<&str>, Vec<Finding>) {
    let mut keys = HashSet::new();
    let mut findings = Vec::new();
    for (line, text) in (1..).zip(bibliography.lines()) {
        let entry = text.strip_prefix('@').and_then(|text| text.split_once('{'));
        let Some(key) = entry.map(|(_, rest)| rest.trim_end_matches(',').trim()) else { continue };
        if !keys.insert(key) {
            let message = format!("the key {key} stands here a second time: rename one");
            findings.push(Finding::new(FILE, line, RULE, message));
        }
    }
    (keys, findings)
}

/// The comment on a line of Rust; in code and in strings, brackets mean other things.
fn comment(line: &str) -> &str {
    let is_outside_strings = |at: &usize| line[..*at].matches('"').count().is_multiple_of(2);
    let start = line.match_indices("//").map(|(at, _)| at).find(is_outside_strings);
    start.map_or("", |start| &line[start..])
}

fn citations(text: &str) -> impl Iterator<Item = &str> {
    text.match_indices('[').filter_map(move |(open, _)| {
        let (before, rest) = (&text[..open], &text[open + 1..]);
        let (key, after) = rest.split_once(']')?;
        let is_word = !key.is_empty() && key.bytes().all(|byte| byte.is_ascii_alphanumeric());
        // `[text](link)` and `[text]: link` are links.
        let is_link = after.starts_with(['(', ':', '[']);
        let is_marked = BEFORE.iter().any(|word| before.ends_with(word))
            || AFTER.iter().any(|word| after.starts_with(word));
        (is_word && !is_link && (is_marked || has_key_shape(key))).then_some(key)
    })
}

/// Whether a word looks like `Li10`, `SS82`, `deBoor78` or `Holden18a`.
fn has_key_shape(word: &str) -> bool {
    let word = word.strip_suffix(|c: char| c.is_ascii_lowercase()).unwrap_or(word);
    let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
    letters.len() >= 2
        && word.len() - letters.len() == 2
        && letters.bytes().all(|byte| byte.is_ascii_alphabetic())
        && letters.bytes().any(|byte| byte.is_ascii_uppercase())
}

#[cfg(test)]
mod tests {
    use super::{super::testing::*, *};

    fn findings(path: &str, text: &str) -> Vec<Finding> {
        check(&tree(&[(FILE, "@inproceedings{Li10,\n}\n@misc{C3D,\n}\n"), (path, text)]))
    }

    #[test]
    fn known_keys_pass() {
        let text = "/// Implements [Li10] Eq. (17), and [C3D] Section 3.\n";
        assert!(findings("a.rs", text).is_empty());
    }

    #[test]
    fn an_unknown_key_is_found_by_its_shape_in_code_and_documents() {
        assert_one(&findings("a.rs", "//! x\n/// After [Lj10].\n"), "a.rs:2:", "[Lj10]");
        assert_one(&findings("a.rs", "f(\"a\"); // after [Lj10]\n"), "a.rs:1:", "[Lj10]");
        assert_one(&findings("a.md", "after [SS82]\n"), "a.md:1:", "[SS82]");
        assert_one(&findings("a.md", "after [deBor78b]\n"), "a.md:1:", "[deBor78b]");
    }

    #[test]
    fn an_unknown_key_of_any_shape_is_found_by_the_words_around_it() {
        assert_one(&findings("a.rs", "/// Implements [Bolero].\n"), "a.rs:1:", "[Bolero]");
        assert_one(&findings("a.rs", "/// See [Trc] Eq. (3).\n"), "a.rs:1:", "[Trc]");
    }

    #[test]
    fn links_code_and_intra_doc_links_are_no_citations() {
        let text = "/// [`Take`], [Take], [f64], [Lj10](x), [Lj10]: x\nlet a = keys[Lj10];\n\
            let b = \"// [Lj10]\";\n";
        assert!(findings("a.rs", text).is_empty());
    }

    #[test]
    fn a_key_that_stands_twice_is_found() {
        let tree = tree(&[(FILE, "@misc{A10,\n}\n@book{A10,\n}\n")]);
        assert_one(&check(&tree), "docs/references.bib:3:", "second time");
    }
}
