//! No file of code is too long to read at one go.

use super::{Finding, Tree};

const RULE: &str = "file size";
const LONG: usize = 300;
const TOO_LONG: usize = 500;

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let files = tree.of_kind(&["rs"]).filter(|(path, _)| !is_test(path));
    files
        .filter_map(|(path, text)| {
            let lines = lines_of_code(text);
            let message = format!(
                "{lines} lines of code, more than {}: split it where its subject splits",
                if lines > TOO_LONG { TOO_LONG } else { LONG }
            );
            let finding = Finding::new(path, 0, RULE, message);
            (lines > LONG).then_some(Finding { is_warning: lines <= TOO_LONG, ..finding })
        })
        .collect()
}

fn is_test(path: &str) -> bool {
    path.contains("/tests/") || path.ends_with("/tests.rs")
}

/// Lines that are neither blank nor comment nor inside a module of tests. Relies on rustfmt: such
/// a module ends at the first brace that stands as far left as the module itself.
fn lines_of_code(text: &str) -> usize {
    let mut count = 0;
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let code = line.trim_start();
        if code.starts_with("#[cfg(test)]") {
            let indent = &line[..line.len() - code.len()];
            let end = format!("{indent}}}");
            let opens = lines.by_ref().find(|line| !line.trim_start().starts_with("#["));
            if opens.is_some_and(|line| line.ends_with('{')) {
                lines.find(|line| **line == end);
            }
        } else if !code.is_empty() && !code.starts_with("//") {
            count += 1;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::{super::testing::*, *};

    #[test]
    fn blanks_comments_and_tests_do_not_count() {
        let text = "//! Doc.\n\nfn a() {\n    // why\n    b();\n}\n\n#[cfg(test)]\nmod tests {\n    \
            fn c() {\n    }\n}\n\nfn d() {}\n";
        assert_eq!(lines_of_code(text), 4);
    }

    #[test]
    fn code_for_tests_without_a_body_hides_nothing_behind_it() {
        assert_eq!(lines_of_code("#[cfg(test)]\nmod tests;\nfn a() {}\n"), 1);
        assert_eq!(
            lines_of_code("#[cfg(test)]\n#[allow(x)]\nfn a() {\n    b();\n}\nfn c() {}\n"),
            1
        );
    }

    #[test]
    fn a_file_that_is_too_long_is_found() {
        let file = |lines| tree(&[("crates/a/src/b.rs", &"a();\n".repeat(lines))]);
        assert!(check(&file(300)).is_empty());
        assert_one(&check(&file(301)), "crates/a/src/b.rs: warning", "more than 300");
        assert_one(&check(&file(500)), "crates/a/src/b.rs: warning", "more than 300");
        assert_one(&check(&file(501)), "crates/a/src/b.rs: error", "more than 500");
    }

    #[test]
    fn files_of_tests_may_be_long() {
        assert!(check(&tree(&[("crates/a/tests/it/b.rs", &"a();\n".repeat(900))])).is_empty());
    }
}
