//! Where an OpenBLAS archive and the Fortran run-time library lie on this machine.
//!
//! The build script and `cargo xtask setup` both compile this file, so that what setup finds is
//! what the build links.

use std::{
    env,
    fs::File,
    io::{self, Read},
    path::{Path, PathBuf},
    process::Command,
};

/// The folder of the first `libopenblas.a`: the one `OPENBLAS_LIB_DIR` names, else a folder where
/// a distribution puts it. `arch` is the target's name for its processor, such as `x86_64`.
pub fn archive_dir(arch: &str) -> Option<PathBuf> {
    let chosen = env::var_os("OPENBLAS_LIB_DIR").map(PathBuf::from);
    first_with_archive(chosen.into_iter().chain(usual_dirs(arch)))
}

/// The serial build comes first: its results cannot depend on a number of threads.
fn usual_dirs(arch: &str) -> Vec<PathBuf> {
    let debian = format!("/usr/lib/{arch}-linux-gnu");
    vec![
        format!("{debian}/openblas-serial"),
        format!("{debian}/openblas-pthread"),
        format!("{debian}/openblas-openmp"),
        debian,
        "/usr/lib64".into(),
        "/usr/lib".into(),
        "/opt/homebrew/opt/openblas/lib".into(),
        "/usr/local/opt/openblas/lib".into(),
    ]
    .into_iter()
    .map(PathBuf::from)
    .collect()
}

fn first_with_archive(mut dirs: impl Iterator<Item = PathBuf>) -> Option<PathBuf> {
    dirs.find(|dir| dir.join("libopenblas.a").is_file())
}

/// Whether the archive was built to run on several threads.
///
/// Reads the archive's symbol index, its first member, for the function that hands work to
/// threads, which only such builds define.
///
/// # Errors
///
/// An archive that cannot be opened or read.
pub fn is_threaded(archive: &Path) -> io::Result<bool> {
    /// Global magic and the header of the first member; its size stands in bytes 56..66.
    const HEADER: usize = 68;
    let mut file = File::open(archive)?;
    let mut header = [0; HEADER];
    file.read_exact(&mut header)?;
    let size = str::from_utf8(&header[56..66]).ok().and_then(|text| text.trim().parse().ok());
    let mut index = Vec::new();
    file.take(size.unwrap_or(0)).read_to_end(&mut index)?;
    let symbol = b"exec_blas\0";
    Ok(index.windows(symbol.len()).any(|bytes| bytes == symbol))
}

/// The folder of a compiler's run-time archive, such as `gfortran`, as the compiler itself would
/// find it. The Fortran compiler is asked last: only it knows the answer on a Mac.
pub fn runtime_dir(name: &str) -> Option<PathBuf> {
    let chosen = env::var("CC").unwrap_or_else(|_| "cc".into());
    [chosen.as_str(), "gcc", "gfortran"].into_iter().find_map(|compiler| {
        let out = Command::new(compiler).arg(format!("-print-file-name=lib{name}.a")).output();
        let path = String::from_utf8(out.ok()?.stdout).ok()?;
        let path = Path::new(path.trim());
        // The compiler echoes the bare name when it knows no such file.
        path.is_absolute().then(|| path.parent().map(Path::to_path_buf)).flatten()
    })
}
