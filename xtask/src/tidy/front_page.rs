//! Every library opens with a page that says what it is, shows it, and says when not to use it.

use super::{Crate, Finding, Tree, kind};

const RULE: &str = "front page";
const HEADINGS: &[&str] = &["When to use", "References", "Guarantees"];
const INCLUDE: &str = "#![doc = include_str!(\"../README.md\")]";
const LONGEST_EXAMPLE: usize = 30;

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let libraries = tree.crates.iter().filter(|krate| krate.has_library);
    let mut findings: Vec<_> = libraries.flat_map(|krate| check_crate(tree, krate)).collect();
    findings.extend(tree.of_kind(&["rs", "md"]).flat_map(|(path, text)| ignored(path, text)));
    findings
}

fn check_crate(tree: &Tree, krate: &Crate) -> Vec<Finding> {
    let readme = format!("{}/README.md", krate.folder);
    let Some(text) = tree.text(&readme) else {
        let message = "missing: write the front page, see CONTRIBUTING.md".into();
        return vec![Finding::new(&readme, 0, RULE, message)];
    };
    let mut findings = Vec::new();
    let mut find = |line, message: String| {
        findings.push(Finding::new(&readme, line, RULE, message));
    };
    let lines: Vec<_> = text.lines().collect();
    let first = lines.iter().position(|line| !line.is_empty() && !line.starts_with('#'));
    if !first.is_some_and(|first| is_sentence(&lines[first..])) {
        let line = first.map_or(1, |first| first + 1);
        find(line, "must open with one sentence, before anything else".into());
    }
    match example(&lines) {
        None => find(0, "shows no example: add a ```rust block".into()),
        Some((line, length)) if length > LONGEST_EXAMPLE => {
            find(
                line,
                format!("the first example has {length} lines: cut it to {LONGEST_EXAMPLE}"),
            );
        }
        Some(_) => {}
    }
    for heading in HEADINGS {
        if !lines.iter().any(|line| line.starts_with(&format!("## {heading}"))) {
            find(0, format!("has no section `## {heading}`: write it"));
        }
    }
    let root = format!("{}/src/lib.rs", krate.folder);
    if !tree.text(&root).is_some_and(|text| text.lines().any(|line| line == INCLUDE)) {
        let message = format!("must show the front page: add `{INCLUDE}`");
        findings.push(Finding::new(&root, 1, RULE, message));
    }
    findings
}

/// Whether a paragraph of text, ended by a full stop, comes first.
fn is_sentence(lines: &[&str]) -> bool {
    let paragraph: Vec<_> = lines.iter().take_while(|line| !line.is_empty()).copied().collect();
    let text = paragraph.join(" ");
    text.starts_with(|c: char| c.is_alphanumeric() || "`[".contains(c)) && text.ends_with('.')
}

/// Line and length of the first block of Rust.
fn example(lines: &[&str]) -> Option<(usize, usize)> {
    let mut fences = fences(lines);
    let (start, _) = fences.find(|(_, info)| info.is_empty() || info.starts_with("rust"))?;
    let length = lines[start + 1..].iter().position(|line| line.starts_with("```"))?;
    Some((start + 1, length))
}

/// The lines that open a block of code, with what stands after the backticks.
fn fences<'a>(lines: &'a [&'a str]) -> impl Iterator<Item = (usize, &'a str)> {
    let all = lines.iter().enumerate();
    all.filter_map(|(at, line)| Some((at, line.trim_start().strip_prefix("```")?))).step_by(2)
}

/// Examples that are never compiled rot; tests run all others.
fn ignored(path: &str, text: &str) -> Vec<Finding> {
    let is_rust = kind(path) == "rs";
    let prose = |line| {
        let line = str::trim_start(line);
        if !is_rust {
            return line;
        }
        let doc = line.strip_prefix("///").or_else(|| line.strip_prefix("//!"));
        doc.map_or("", str::trim_start)
    };
    let lines: Vec<_> = text.lines().map(prose).collect();
    let is_ignored = |info: &str| info.split([',', ' ', '-']).any(|word| word == "ignore");
    fences(&lines)
        .filter(|(_, info)| is_ignored(info))
        .map(|(at, _)| {
            let message = "an example that is never run: make it run, or mark it `text`".into();
            Finding::new(path, at + 1, RULE, message)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{super::testing::*, *};

    const GOOD: &str = "# a\n\nFills gaps.\n\n```rust\nlet x = 1;\n```\n\n## When to use / when \
        not\n\n## References\n\n## Guarantees\n";

    fn findings(readme: &str, root: &str) -> Vec<Finding> {
        let files = [("crates/a/README.md", readme), ("crates/a/src/lib.rs", root)];
        check(&tree(&files).with_crate("a", &[]))
    }

    #[test]
    fn a_full_page_passes() {
        assert!(findings(GOOD, &format!("{INCLUDE}\n")).is_empty());
    }

    #[test]
    fn a_missing_page_is_found() {
        assert_one(&check(&tree(&[]).with_crate("a", &[])), "crates/a/README.md:", "missing");
    }

    #[test]
    fn a_program_needs_no_page() {
        let mut tree = tree(&[]).with_crate("a", &[]);
        tree.crates[0].has_library = false;
        assert!(check(&tree).is_empty());
    }

    #[test]
    fn a_page_that_opens_with_something_else_is_found() {
        for other in ["```text\nx\n```", "- a list.", "Fills gaps"] {
            let page = GOOD.replacen("Fills gaps.", other, 1);
            assert_one(&findings(&page, INCLUDE), "crates/a/README.md:3:", "one sentence");
        }
    }

    #[test]
    fn each_missing_section_is_found() {
        for heading in HEADINGS {
            let page = GOOD.replace(&format!("## {heading}"), "## Else");
            assert_one(&findings(&page, INCLUDE), "crates/a/README.md:", heading);
        }
    }

    #[test]
    fn a_page_without_an_example_or_with_a_long_one_is_found() {
        let none = GOOD.replace("```rust", "```toml");
        assert_one(&findings(&none, INCLUDE), "crates/a/README.md", "no example");
        let long = GOOD.replace("let x = 1;", &"let x = 1;\n".repeat(31));
        assert_one(&findings(&long, INCLUDE), "crates/a/README.md:5:", "cut it");
    }

    #[test]
    fn a_library_that_does_not_show_its_page_is_found() {
        assert_one(&findings(GOOD, "//! A crate.\n"), "crates/a/src/lib.rs:1:", "include_str");
    }

    #[test]
    fn an_example_that_never_runs_is_found_in_code_and_in_documents() {
        let fence = "```";
        let code = format!("/// {fence}rust,ignore\n/// x\n/// {fence}\nfn f() {{}}\n");
        assert_one(&check(&tree(&[("a.rs", &code)])), "a.rs:1:", "never run");
        let page = format!("{fence}\nx\n{fence}\n{fence}ignore\nx\n{fence}\n");
        assert_one(&check(&tree(&[("a.md", &page)])), "a.md:4:", "never run");
        let fine = format!("/// {fence}rust,no_run\n/// ignore\n/// {fence}\n");
        assert!(check(&tree(&[("a.rs", &fine)])).is_empty());
    }
}
