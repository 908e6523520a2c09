//! Real recordings: what they are, where they come from, and whether a copy is the right one.
//!
//! They stay in a folder of the user's, named by `--data` or the variable `MOCAP_DATA`, and never
//! enter the repository.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail, ensure};
use clap::{Args, Subcommand};
use sha2::{Digest, Sha256};

use crate::process;

/// List, check and fetch the real recordings that some tests use
///
/// Twelve files of the CMU motion capture database: three trials with markers (C3D) and their
/// fitted skeletons (ASF, AMC), and two more fits. xtask/data-manifest.tsv holds the list.
#[derive(Subcommand)]
pub enum Task {
    /// Print the files, their sizes and their addresses
    List,
    /// Check the files that are there against their known sums
    Verify(Place),
    /// Download what is missing or damaged, with curl
    Fetch {
        #[command(flatten)]
        place: Place,
        /// Where the database lies; `file:///…` works too
        #[arg(long, value_name = "URL", default_value = "http://mocap.cs.cmu.edu/subjects")]
        base: String,
    },
}

#[derive(Args)]
pub struct Place {
    /// The data folder; without it the one that `MOCAP_DATA` names
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
}

impl Place {
    fn folder(&self) -> Result<PathBuf> {
        let folder = self.data.clone().or_else(|| env::var_os("MOCAP_DATA").map(PathBuf::from));
        folder.context("which folder? Give --data DIR or set MOCAP_DATA")
    }
}

/// A line of the manifest.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Entry {
    path: String,
    bytes: u64,
    sha256: String,
    address: String,
}

/// What a folder holds under an entry's name.
#[derive(Debug, PartialEq, Eq)]
enum State {
    Right,
    Missing,
    Wrong(String),
}

/// The task as its options ask for it.
pub fn run(task: &Task) -> Result<()> {
    let manifest = parse(include_str!("../data-manifest.tsv"))?;
    match task {
        Task::List => {
            for Entry { path, bytes, sha256, address } in &manifest {
                println!("{path:<24} {bytes:>9} {address:<16} {sha256}");
            }
            Ok(())
        }
        Task::Verify(place) => verify(&manifest, &place.folder()?),
        Task::Fetch { place, base } => fetch(&manifest, &place.folder()?, base),
    }
}

fn parse(manifest: &str) -> Result<Vec<Entry>> {
    let lines = manifest.lines().zip(1..).filter(|(line, _)| !line.starts_with('#'));
    lines.map(|(line, number)| parse_line(line).with_context(|| format!("line {number}"))).collect()
}

fn parse_line(line: &str) -> Result<Entry> {
    let fields: Vec<_> = line.split('\t').collect();
    let &[path, bytes, sha256, address] = fields.as_slice() else {
        bail!("{} fields, not path, bytes, sha256 and address with tabs between", fields.len());
    };
    let bytes = bytes.parse().with_context(|| format!("`{bytes}` is no number of bytes"))?;
    digest(sha256)?;
    Ok(Entry { path: path.into(), bytes, sha256: sha256.into(), address: address.into() })
}

/// The 32 bytes that 64 hexadecimal digits stand for.
fn digest(digits: &str) -> Result<[u8; 32]> {
    let parse = || {
        let mut bytes = [0; 32];
        for (byte, pair) in bytes.iter_mut().zip(digits.as_bytes().chunks(2)) {
            *byte = u8::from_str_radix(str::from_utf8(pair).ok()?, 16).ok()?;
        }
        (digits.len() == 2 * bytes.len()).then_some(bytes)
    };
    parse().with_context(|| format!("`{digits}` is not 64 hexadecimal digits"))
}

fn verify(manifest: &[Entry], folder: &Path) -> Result<()> {
    let mut counts = [0; 3];
    for entry in manifest {
        let (state, column) = match inspect(entry, &folder.join(&entry.path))? {
            State::Right => ("right".into(), 0),
            State::Missing => ("not there".into(), 1),
            State::Wrong(why) => (format!("WRONG: {why}"), 2),
        };
        counts[column] += 1;
        println!("{:<24} {state}", entry.path);
    }
    let [right, missing, wrong] = counts;
    println!("{right} right, {missing} not there, {wrong} wrong in {}", folder.display());
    ensure!(wrong == 0, "{wrong} files are not what the manifest says; `data fetch` replaces them");
    Ok(())
}

fn inspect(entry: &Entry, file: &Path) -> Result<State> {
    let mut content = match fs::File::open(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(State::Missing),
        other => other.with_context(|| format!("cannot open {}", file.display()))?,
    };
    let mut hash = Sha256::new();
    let bytes = io::copy(&mut content, &mut HashWriter(&mut hash))
        .with_context(|| format!("cannot read {}", file.display()))?;
    if bytes != entry.bytes {
        return Ok(State::Wrong(format!("{bytes} bytes, not {}", entry.bytes)));
    }
    if hash.finalize()[..] != digest(&entry.sha256)? {
        return Ok(State::Wrong(format!("its sha256 is not {}", entry.sha256)));
    }
    Ok(State::Right)
}

struct HashWriter<'a>(&'a mut Sha256);

impl io::Write for HashWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Downloads every file that is not there and right. A file takes its name only once it has the
/// right sum, so an interrupted download leaves nothing that looks like a recording.
fn fetch(manifest: &[Entry], folder: &Path, base: &str) -> Result<()> {
    for entry in manifest {
        let file = folder.join(&entry.path);
        if inspect(entry, &file)? == State::Right {
            println!("{:<24} right already", entry.path);
            continue;
        }
        let parent = file.parent().unwrap_or(folder);
        fs::create_dir_all(parent).with_context(|| format!("cannot make {}", parent.display()))?;
        let part = file.with_extension("part");
        let url = format!("{}/{}", base.trim_end_matches('/'), entry.address);
        let result = download(entry, &url, &part);
        if result.is_err() && part.exists() {
            fs::remove_file(&part)?;
        }
        result?;
        fs::rename(&part, &file).with_context(|| format!("cannot write {}", file.display()))?;
    }
    Ok(())
}

fn download(entry: &Entry, url: &str, part: &Path) -> Result<()> {
    let mut curl = Command::new("curl");
    curl.args(["--fail", "--location", "--silent", "--show-error", "--output"]);
    process::run(curl.arg(part).arg(url)).context("cannot download")?;
    match inspect(entry, part)? {
        State::Right => Ok(()),
        State::Missing => bail!("{url}: curl wrote nothing"),
        State::Wrong(why) => bail!("{url} is not the file the manifest means: {why}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `printf abc | sha256sum`
    const ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

    /// A source folder with one file and an empty data folder, removed at the end.
    struct Folders(PathBuf);

    impl Folders {
        fn new(test: &str, content: &str) -> Self {
            let root = env::temp_dir().join(format!("xtask-data-{test}-{}", std::process::id()));
            fs::create_dir_all(root.join("source/02")).expect("a folder in the temporary folder");
            fs::write(root.join("source/02/a.c3d"), content).expect("a file there");
            Self(root)
        }

        fn fetch(&self) -> Result<()> {
            let base = format!("file://{}/source/", self.0.display());
            fetch(&[entry()], &self.0.join("data"), &base)
        }

        fn fetched(&self) -> PathBuf {
            self.0.join("data/cmu/a.c3d")
        }
    }

    impl Drop for Folders {
        fn drop(&mut self) {
            drop(fs::remove_dir_all(&self.0));
        }
    }

    fn entry() -> Entry {
        Entry { path: "cmu/a.c3d".into(), bytes: 3, sha256: ABC.into(), address: "02/a.c3d".into() }
    }

    #[test]
    fn the_manifest_in_the_tree_can_be_read() {
        let manifest = parse(include_str!("../data-manifest.tsv")).expect("a sound manifest");
        assert!(manifest.iter().any(|entry| entry.path == "cmu/paired/02_01.c3d"));
    }

    #[test]
    fn a_manifest_line_with_a_short_sum_or_a_missing_field_is_refused() {
        assert!(parse(&format!("a\t3\t{ABC}\tb")).is_ok());
        assert!(parse("a\t3\tba78\tb").is_err());
        assert!(parse(&format!("a\t3\t{ABC}")).is_err());
        assert!(parse(&format!("a\tthree\t{ABC}\tb")).is_err());
    }

    #[test]
    fn a_file_is_fetched_once_and_then_left_alone() {
        let folders = Folders::new("once", "abc");
        folders.fetch().expect("a right file");
        let first = fs::metadata(folders.fetched()).and_then(|file| file.modified()).expect("it");
        fs::remove_dir_all(folders.0.join("source")).expect("the source can go");
        folders.fetch().expect("nothing to download");
        let second = fs::metadata(folders.fetched()).and_then(|file| file.modified()).expect("it");
        assert_eq!(first, second);
    }

    #[test]
    fn a_wrong_download_is_refused_and_leaves_nothing() {
        for wrong in ["abd", "abcd"] {
            let folders = Folders::new("wrong", wrong);
            assert!(folders.fetch().is_err(), "{wrong}");
            let left = fs::read_dir(folders.0.join("data/cmu")).expect("the folder").count();
            assert_eq!(left, 0, "{wrong}");
        }
    }

    #[test]
    fn a_damaged_copy_is_found_and_replaced() {
        let folders = Folders::new("damaged", "abc");
        fs::create_dir_all(folders.0.join("data/cmu")).expect("the data folder");
        fs::write(folders.fetched(), "abx").expect("a damaged copy");
        assert!(verify(&[entry()], &folders.0.join("data")).is_err());
        folders.fetch().expect("a right file");
        assert!(verify(&[entry()], &folders.0.join("data")).is_ok());
    }

    #[test]
    fn a_file_that_is_not_there_does_not_make_verify_fail() {
        let folders = Folders::new("absent", "abc");
        assert!(verify(&[entry()], &folders.0.join("data")).is_ok());
    }
}
