//! The rules of the house that no compiler checks.
//!
//! Every rule is a function from a [`Tree`], a plain value, to the findings in it, so that each
//! can be tested on a tree of two short files.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt, fs,
    path::Path,
};

use anyhow::{Context, Result, bail};
use cargo_metadata::{DependencyKind, MetadataCommand};

mod architecture;
mod citations;
mod dependencies;
mod front_page;
mod links;
mod manifests;
mod size;
mod text;

/// What the rules look at: the text files of the workspace and its crates.
#[derive(Default)]
struct Tree {
    /// Text by path from the root, with `/` between folders.
    files: BTreeMap<String, String>,
    /// The paths of all files, text or not.
    paths: BTreeSet<String>,
    crates: Vec<Crate>,
}

struct Crate {
    name: String,
    /// Its folder from the root.
    folder: String,
    has_library: bool,
    /// The packages it depends on, those of its tests left out.
    dependencies: Vec<String>,
}

/// A rule broken at a place.
#[derive(Debug)]
struct Finding {
    path: String,
    /// From 1; 0 where the whole file is meant.
    line: usize,
    rule: &'static str,
    /// What is wrong and what to do.
    message: String,
    is_warning: bool,
}

impl Finding {
    fn new(path: &str, line: usize, rule: &'static str, message: String) -> Self {
        Self { path: path.into(), line, rule, message, is_warning: false }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, rule, message, is_warning } = self;
        let level = if *is_warning { "warning" } else { "error" };
        match line {
            0 => write!(f, "{path}: {level} [{rule}]: {message}"),
            _ => write!(f, "{path}:{line}: {level} [{rule}]: {message}"),
        }
    }
}

const RULES: &[fn(&Tree) -> Vec<Finding>] = &[
    architecture::check,
    dependencies::check,
    front_page::check,
    links::check,
    citations::check,
    manifests::check,
    size::check,
    text::check,
];

/// Checks the workspace and prints every finding.
///
/// # Errors
///
/// The tree cannot be read, or a rule is broken; warnings do not count.
pub fn run(root: &Path) -> Result<()> {
    let tree = Tree::load(root)?;
    let findings: Vec<_> = RULES.iter().flat_map(|rule| rule(&tree)).collect();
    for finding in &findings {
        println!("{finding}");
    }
    let errors = findings.iter().filter(|finding| !finding.is_warning).count();
    println!(
        "tidy: {} crates, {} files, {errors} errors, {} warnings",
        tree.crates.len(),
        tree.files.len(),
        findings.len() - errors
    );
    if errors > 0 {
        bail!("{errors} rules broken; every line above says the way out");
    }
    Ok(())
}

impl Tree {
    fn load(root: &Path) -> Result<Self> {
        let mut tree = Self { crates: crates(root)?, ..Self::default() };
        tree.read_folder(root, "")?;
        Ok(tree)
    }

    /// Reads the text files of a folder and of those in it; `prefix` is its path with a final `/`.
    fn read_folder(&mut self, folder: &Path, prefix: &str) -> Result<()> {
        let entries = fs::read_dir(folder)
            .with_context(|| format!("cannot list the folder {}", folder.display()))?;
        for entry in entries {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = format!("{prefix}{name}");
            if entry.file_type()?.is_dir() {
                if !is_foreign(&path) {
                    self.read_folder(&entry.path(), &format!("{path}/"))?;
                }
                continue;
            }
            if ["rs", "md", "toml", "bib"].contains(&kind(&name)) {
                let bytes =
                    fs::read(entry.path()).with_context(|| format!("cannot read {path}"))?;
                self.files.insert(path.clone(), String::from_utf8_lossy(&bytes).into_owned());
            }
            self.paths.insert(path);
        }
        Ok(())
    }

    /// Path and text of the files of these kinds, such as `rs`.
    fn of_kind(&self, kinds: &[&str]) -> impl Iterator<Item = (&str, &str)> {
        self.files
            .iter()
            .filter(move |(path, _)| kinds.contains(&kind(path)))
            .map(|(path, text)| (path.as_str(), text.as_str()))
    }

    fn text(&self, path: &str) -> Option<&str> {
        self.files.get(path).map(String::as_str)
    }
}

/// Folders whose files are not ours to keep tidy: those of git and of builds.
fn is_foreign(path: &str) -> bool {
    path == ".git" || path == "out" || path == "target" || path.starts_with("target-")
}

/// What stands after the last dot of a path.
fn kind(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(_, kind)| kind)
}

fn crates(root: &Path) -> Result<Vec<Crate>> {
    let metadata = MetadataCommand::new().current_dir(root).no_deps().exec()?;
    let describe = |package: &cargo_metadata::Package| {
        let folder = package.manifest_path.parent().context("a manifest in no folder")?;
        let folder = folder.strip_prefix(&metadata.workspace_root)?;
        let dependencies = package.dependencies.iter();
        Ok(Crate {
            name: package.name.to_string(),
            folder: folder.as_str().replace('\\', "/"),
            has_library: package.targets.iter().any(cargo_metadata::Target::is_lib),
            dependencies: dependencies
                .filter(|dependency| dependency.kind != DependencyKind::Development)
                .map(|dependency| dependency.name.clone())
                .collect(),
        })
    };
    metadata.workspace_packages().into_iter().map(describe).collect()
}

/// Trees for the tests of the rules.
#[cfg(test)]
mod testing {
    use super::{Crate, Finding, Tree};

    pub(super) fn tree(files: &[(&str, &str)]) -> Tree {
        let paths = files.iter().map(|(path, _)| (*path).into()).collect();
        let files = files.iter().map(|(path, text)| ((*path).into(), (*text).into())).collect();
        Tree { files, paths, crates: Vec::new() }
    }

    impl Tree {
        /// Adds a library crate below `crates/`.
        pub(super) fn with_crate(mut self, name: &str, dependencies: &[&str]) -> Self {
            self.crates.push(Crate {
                name: name.into(),
                folder: format!("crates/{name}"),
                has_library: true,
                dependencies: dependencies.iter().map(|name| (*name).into()).collect(),
            });
            self
        }
    }

    /// Each finding as one line, for comparisons that show what went wrong.
    pub(super) fn lines(findings: &[Finding]) -> Vec<String> {
        findings.iter().map(ToString::to_string).collect()
    }

    /// Asserts that there is exactly one finding, and that it stands there and says that.
    #[track_caller]
    pub(super) fn assert_one(findings: &[Finding], place: &str, word: &str) {
        let lines = lines(findings);
        assert_eq!(lines.len(), 1, "{lines:#?}");
        assert!(lines[0].starts_with(place), "{lines:#?}");
        assert!(lines[0].contains(word), "{lines:#?}");
    }
}
