//! Makes the sample recordings in `fixtures/` with the workspace's own generator.

use std::{fs, path::Path};

use anyhow::{Context, Result, bail};
use clap::Args;

use crate::process;

/// Make the sample recordings in fixtures/ again, or check that they are what the generator makes
///
/// The recordings are synthetic: a walking, running, jumping and throwing body whose true marker
/// positions are known. Everything is seeded, so the files come out the same every time.
#[derive(Args)]
pub struct Options {
    /// Write nothing there; fail if a file differs from what the generator makes
    #[arg(long)]
    check: bool,
}

/// One recording; the format is that of its extension.
struct Fixture {
    file: &'static str,
    motion: &'static str,
    frames: u32,
    seed: u32,
}

/// Frames per second, that of the CMU recordings.
const RATE_HZ: &str = "120";

/// The walk stands in both formats, so that readers can be compared; the run is what the demo fills.
const FIXTURES: &[Fixture] = &[
    Fixture { file: "walk.c3d", motion: "walk", frames: 200, seed: 1 },
    Fixture { file: "walk.csv", motion: "walk", frames: 100, seed: 1 },
    Fixture { file: "run.c3d", motion: "run", frames: 240, seed: 2 },
    Fixture { file: "jump.c3d", motion: "jump", frames: 120, seed: 3 },
    Fixture { file: "throw.c3d", motion: "throw", frames: 120, seed: 4 },
];

/// The task as its options ask for it.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    if options.check {
        return check(root);
    }
    make(root, &root.join("fixtures"))
}

/// Makes the recordings elsewhere and compares.
///
/// # Errors
///
/// The generator fails, or a file is missing or differs; the error names the first.
pub fn check(root: &Path) -> Result<()> {
    let fresh = root.join("target/fixtures");
    make(root, &fresh)?;
    for fixture in FIXTURES {
        let kept = read(&root.join("fixtures").join(fixture.file))?;
        if let Some(offset) = first_difference(&kept, &read(&fresh.join(fixture.file))?) {
            bail!(
                "fixtures/{} differs from what the generator makes, first at byte {offset}. If \
                 the generator was meant to change, run `cargo xtask fixtures` and keep the result",
                fixture.file
            );
        }
    }
    println!("fixtures: all {} are what the generator makes", FIXTURES.len());
    Ok(())
}

fn make(root: &Path, folder: &Path) -> Result<()> {
    fs::create_dir_all(folder)?;
    process::build_mocap(root)?;
    for fixture in FIXTURES {
        let mut synth = process::mocap(root);
        synth.args(["synth", "--motion", fixture.motion, "--rate", RATE_HZ]);
        synth.args(["--frames", &fixture.frames.to_string(), "--seed", &fixture.seed.to_string()]);
        process::run(synth.arg("-o").arg(folder.join(fixture.file)).arg("--force"))?;
    }
    Ok(())
}

fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// The offset of the first byte in which two files differ; a longer file differs where the
/// shorter one ends.
fn first_difference(kept: &[u8], fresh: &[u8]) -> Option<usize> {
    let common = kept.iter().zip(fresh).position(|(a, b)| a != b);
    common.or_else(|| (kept.len() != fresh.len()).then(|| kept.len().min(fresh.len())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_differ_at_a_changed_byte_or_where_the_shorter_one_ends() {
        assert_eq!(first_difference(b"abc", b"abc"), None);
        assert_eq!(first_difference(b"abc", b"axc"), Some(1));
        assert_eq!(first_difference(b"abc", b"abcd"), Some(3));
        assert_eq!(first_difference(b"abc", b""), Some(0));
    }

    #[test]
    fn the_list_holds_every_motion_and_no_file_twice() {
        for motion in ["walk", "run", "jump", "throw"] {
            assert!(FIXTURES.iter().any(|fixture| fixture.motion == motion), "{motion}");
        }
        let mut files: Vec<_> = FIXTURES.iter().map(|fixture| fixture.file).collect();
        files.sort_unstable();
        files.dedup();
        assert_eq!(files.len(), FIXTURES.len());
    }
}
