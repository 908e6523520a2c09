//! Tells rustc how to link the OpenBLAS of this machine, or the user what to install.
#![allow(clippy::print_stdout, reason = "a build script speaks to cargo through its output")]

use std::{env, path::Path};

mod search;

const NO_ARCHIVE: &str = "no libopenblas.a on this machine. Run `cargo xtask setup`, or install \
    it yourself (Debian and Ubuntu: `apt-get install libopenblas-serial-dev gfortran`; Homebrew: \
    `brew install openblas gcc`), or set OPENBLAS_LIB_DIR to the folder that holds it";
const NO_RUNTIME: &str = "the C compiler finds no libgfortran.a, which OpenBLAS needs. Run \
    `cargo xtask setup`, or install gfortran yourself";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=search.rs");
    println!("cargo::rerun-if-env-changed=OPENBLAS_LIB_DIR");
    println!("cargo::rerun-if-env-changed=CC");
    if env::var_os("CARGO_FEATURE_SYSTEM").is_some() {
        link_shared();
    } else {
        link_archive();
    }
}

fn link_shared() {
    if let Ok(dir) = env::var("OPENBLAS_LIB_DIR") {
        println!("cargo::rustc-link-search=native={dir}");
    }
    println!("cargo::rustc-link-lib=dylib=openblas");
}

fn link_archive() {
    let arch = env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    let Some(dir) = search::archive_dir(&arch) else {
        println!("cargo::error={NO_ARCHIVE}");
        return;
    };
    let archive = dir.join("libopenblas.a");
    println!("cargo::rerun-if-changed={}", archive.display());
    if search::is_threaded(&archive).unwrap_or(false) {
        println!(
            "cargo::warning=linking the threaded OpenBLAS of {}: outside `cargo run` and `cargo \
             test` set OPENBLAS_NUM_THREADS=1 for results that repeat to the last bit",
            dir.display()
        );
    }
    link("openblas", &dir);
    // OpenBLAS needs the first always, the others where it was built to use them.
    for runtime in ["gfortran", "quadmath", "gomp"] {
        match search::runtime_dir(runtime) {
            Some(dir) => link(runtime, &dir),
            None if runtime == "gfortran" => println!("cargo::error={NO_RUNTIME}"),
            None => {}
        }
    }
}

/// `-bundle` keeps a 30 MB archive out of every rlib: only the final link reads it.
fn link(library: &str, dir: &Path) {
    println!("cargo::rustc-link-search=native={}", dir.display());
    println!("cargo::rustc-link-lib=static:-bundle={library}");
}
