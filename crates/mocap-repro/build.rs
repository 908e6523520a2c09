//! A fingerprint of everything that decides a result: the sources of the methods and of the metrics.
//!
//! Cells that another build computed are reused only where the fingerprints agree.

use std::{
    collections::hash_map::DefaultHasher,
    env, fs,
    hash::{Hash, Hasher},
    path::{Path, PathBuf},
};

/// Crates whose code no result depends on.
const ASIDE: [&str; 6] =
    ["mocap-cli", "mocap-io", "mocap-report", "mocap-repro", "mocap-synth", "mocap-testkit"];

fn main() {
    let home = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let crates = home.join("..");
    let mut files = vec![home.join("../../Cargo.lock")];
    // What is computed and scored in this crate itself.
    files.extend(
        ["cell.rs", "outcome.rs", "sureness.rs", "trial.rs"]
            .map(|file| home.join("src").join(file)),
    );
    for folder in children(&crates) {
        let aside = folder.file_name().is_some_and(|name| ASIDE.iter().any(|a| name == *a));
        if !aside {
            collect(&folder.join("src"), &mut files);
            collect(&folder.join("data"), &mut files);
        }
    }
    files.sort();
    let mut hasher = DefaultHasher::new();
    for file in &files {
        println!("cargo::rerun-if-changed={}", file.display());
        file.strip_prefix(&home).unwrap_or(file).hash(&mut hasher);
        fs::read(file).unwrap_or_default().hash(&mut hasher);
    }
    println!("cargo::rustc-env=MOCAP_REPRO_FINGERPRINT={:016x}", hasher.finish());
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    if folder.is_dir() {
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    for path in children(folder) {
        if path.is_dir() {
            collect(&path, files);
        } else {
            files.push(path);
        }
    }
}

fn children(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect()
}
