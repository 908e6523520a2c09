//! No leftovers: unfinished code, skipped tests, paths of one machine, stray white space.

use super::{Finding, Tree, kind};

const RULE: &str = "text";

/// Macros that mark unfinished or debugging code, without their `!`, so that this list does not
/// find itself.
const MACROS: &[&str] = &["todo", "unimplemented", "dbg"];

/// Folders at the root that mean something on one machine only.
const MACHINE: &[&str] = &["home", "root", "tmp", "Users", "work"];

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, text) in tree.of_kind(&["rs", "md", "toml"]) {
        for (line, text) in (1..).zip(text.split_terminator('\n')) {
            let rust = (kind(path) == "rs").then(|| unfinished(text)).flatten();
            let messages = [rust, machine_path(text), white_space(text)];
            let found = messages.into_iter().flatten();
            findings.extend(found.map(|message| Finding::new(path, line, RULE, message)));
        }
        if !text.is_empty() && (!text.ends_with('\n') || text.ends_with("\n\n")) {
            let line = text.lines().count();
            let message = "must end with one line feed: add it, or drop the blank lines".into();
            findings.push(Finding::new(path, line, RULE, message));
        }
    }
    findings
}

fn unfinished(line: &str) -> Option<String> {
    let leftover =
        MACROS.iter().map(|name| format!("{name}!")).find(|word| starts_word(line, word));
    if let Some(word) = leftover {
        return Some(format!("`{word}` is left over: write the code, or return a typed error"));
    }
    let skipped = format!("#[{}", "ignore");
    line.trim_start().starts_with(&skipped).then(|| {
        "a skipped test: make it run, or skip inside it with a printed line that says why".into()
    })
}

/// Whether a word stands there that is not the end of a longer one.
fn starts_word(line: &str, word: &str) -> bool {
    line.match_indices(word).any(|(at, _)| {
        line[..at].chars().next_back().is_none_or(|c| !(c.is_alphanumeric() || c == '_'))
    })
}

fn machine_path(line: &str) -> Option<String> {
    MACHINE.iter().map(|name| format!("/{name}/")).find_map(|folder| {
        let is_path = line.match_indices(&folder).any(|(at, _)| {
            // Inside a longer path or an address the word is an ordinary one.
            line[..at].chars().next_back().is_none_or(|c| " \t\"'`(=<[".contains(c))
        });
        is_path.then(|| {
            format!("`{folder}` exists on one machine: take the path from an option or a variable")
        })
    })
}

fn white_space(line: &str) -> Option<String> {
    if line.ends_with('\r') {
        return Some("ends in a carriage return: save with plain line feeds".into());
    }
    if line.contains('\t') {
        return Some("holds a tab: use spaces, or `\\t` in a string".into());
    }
    line.ends_with(' ').then(|| "ends in white space: take it out".into())
}

#[cfg(test)]
mod tests {
    use super::{super::testing::*, *};

    fn findings(path: &str, text: &str) -> Vec<Finding> {
        check(&tree(&[(path, text)]))
    }

    #[test]
    fn ordinary_text_passes() {
        let text = "fn a() {\n    my_todo!(\"https://x.org/home/a\", \"a/tmp/b\");\n}\n";
        assert!(findings("a.rs", text).is_empty());
    }

    #[test]
    fn unfinished_code_is_found() {
        for name in MACROS {
            let text = format!("fn a() {{\n    {name}!()\n}}\n");
            assert_one(&findings("a.rs", &text), "a.rs:2:", name);
        }
    }

    #[test]
    fn a_skipped_test_is_found() {
        let text = format!("#[test]\n#[{} = \"slow\"]\nfn a() {{}}\n", "ignore");
        assert_one(&findings("a.rs", &text), "a.rs:2:", "skipped");
    }

    #[test]
    fn paths_of_one_machine_are_found() {
        for name in MACHINE {
            let text = format!("data = \"/{name}/me/data\"\n");
            assert_one(&findings("a.toml", &text), "a.toml:1:", "one machine");
        }
    }

    #[test]
    fn stray_white_space_is_found() {
        assert_one(&findings("a.md", "a\nb \n"), "a.md:2:", "white space");
        assert_one(&findings("a.md", "\ta\n"), "a.md:1:", "tab");
        assert_one(&findings("a.md", "a\r\n"), "a.md:1:", "carriage return");
        assert_one(&findings("a.md", "a"), "a.md:1:", "line feed");
        assert_one(&findings("a.md", "a\n\n"), "a.md:2:", "line feed");
    }
}
