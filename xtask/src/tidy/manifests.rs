//! Every crate takes its lints from the workspace.

use super::{Finding, Tree};

const RULE: &str = "manifests";

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let manifests = tree.crates.iter().map(|krate| format!("{}/Cargo.toml", krate.folder));
    manifests.filter_map(|path| check_one(tree.text(&path).unwrap_or_default(), &path)).collect()
}

fn check_one(text: &str, path: &str) -> Option<Finding> {
    let table = match text.parse::<toml::Table>() {
        Ok(table) => table,
        Err(error) => return Some(Finding::new(path, 0, RULE, error.message().to_owned())),
    };
    let inherits = table.get("lints").and_then(|lints| lints.get("workspace"));
    (inherits != Some(&toml::Value::Boolean(true))).then(|| {
        let message = "takes no lints from the workspace: add `[lints]` with `workspace = true`";
        Finding::new(path, 0, RULE, message.into())
    })
}

#[cfg(test)]
mod tests {
    use super::{super::testing::*, *};

    fn findings(manifest: &str) -> Vec<Finding> {
        check(&tree(&[("crates/a/Cargo.toml", manifest)]).with_crate("a", &[]))
    }

    #[test]
    fn both_spellings_pass() {
        assert!(findings("[lints]\nworkspace = true\n").is_empty());
        assert!(findings("lints.workspace = true\n").is_empty());
    }

    #[test]
    fn a_crate_with_lints_of_its_own_or_none_is_found() {
        for manifest in ["", "[lints.rust]\nunsafe_code = \"allow\"\n", "lints.workspace = false\n"]
        {
            assert_one(&findings(manifest), "crates/a/Cargo.toml:", "no lints");
        }
    }

    #[test]
    fn a_manifest_that_is_no_toml_is_found() {
        assert_eq!(findings("[lints\n").len(), 1);
    }
}
