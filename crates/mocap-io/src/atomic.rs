use std::{io::Write, path::Path};

use crate::{WriteError, format::is_gzip};

/// Writes a whole file or nothing: into a temporary file beside it, synced, then renamed.
///
/// A path that ends in `.gz` is compressed. An existing file is replaced only with `overwrite`.
///
/// # Errors
/// [`WriteError::Exists`], and [`WriteError::Io`] with the path.
pub fn write_atomic(path: &Path, bytes: &[u8], overwrite: bool) -> Result<(), WriteError> {
    let at = |source| WriteError::Io { path: path.to_owned(), source };
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = as_any_file().prefix(".mocap-").tempfile_in(folder).map_err(at)?;
    if is_gzip(path) {
        let mut gz = flate2::write::GzEncoder::new(file.as_file_mut(), flate2::Compression::best());
        gz.write_all(bytes).and_then(|()| gz.finish().map(|_| ())).map_err(at)?;
    } else {
        file.write_all(bytes).map_err(at)?;
    }
    file.as_file().sync_all().map_err(at)?;
    if overwrite {
        file.persist(path).map_err(|e| at(e.error))?;
        return Ok(());
    }
    // `persist_noclobber` decides and renames in one step, so no other writer slips in between.
    file.persist_noclobber(path).map(|_| ()).map_err(|e| match e.error.kind() {
        std::io::ErrorKind::AlreadyExists => WriteError::Exists { path: path.to_owned() },
        _ => at(e.error),
    })
}

/// Temporary files are private to their owner by default; what a user asked for is as readable as
/// their umask lets any new file be.
#[cfg(unix)]
fn as_any_file<'a>() -> tempfile::Builder<'a, 'a> {
    use std::os::unix::fs::PermissionsExt;
    let mut builder = tempfile::Builder::new();
    builder.permissions(std::fs::Permissions::from_mode(0o666));
    builder
}

#[cfg(not(unix))]
fn as_any_file<'a>() -> tempfile::Builder<'a, 'a> {
    tempfile::Builder::new()
}
