//! Files that are there whole or not at all.
//!
//! The content goes to a temporary file in the same folder, is forced to the disk, and takes the final name by one
//! rename: a reader sees the old file or the new one, never a part, whenever the run is cut.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

use crate::Error;

/// Beginning of the name of a temporary file.
const PREFIX: &str = ".carom-";
/// End of the name of a temporary file.
const SUFFIX: &str = ".part";

/// Writes a file whole: `content` is given a buffered writer.
///
/// # Errors
/// [`Error::File`], naming `path` and the cause; an existing file of that name is then untouched and no temporary
/// file remains.
pub fn write(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Error> {
    write_after(path, content, || Ok(()))
}

/// As [`write()`]; `before` is called when the content is on the disk and the file not yet renamed.
pub(crate) fn write_after(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    before: impl FnOnce() -> io::Result<()>,
) -> Result<(), Error> {
    replace(path, |to| content(to), before).map_err(Error::file("write", path))
}

/// As [`write()`], of a content that is not written from the start to the end.
///
/// # Errors
/// As [`write()`].
#[cfg(feature = "hdf5")]
pub(crate) fn write_seeking(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<NamedTempFile>) -> io::Result<()>,
) -> Result<(), Error> {
    replace(path, content, || Ok(())).map_err(Error::file("write", path))
}

/// Writes text as a whole file.
///
/// # Errors
/// As [`write()`].
pub fn write_text(path: &Path, text: &str) -> Result<(), Error> {
    write(path, |to| to.write_all(text.as_bytes()))
}

/// Creates an empty file to append to; what stood there is replaced, a symbolic link and not its target.
///
/// # Errors
/// [`Error::File`].
pub fn create(path: &Path) -> Result<File, Error> {
    let anew = || {
        match fs::remove_file(path) {
            Err(cause) if cause.kind() != ErrorKind::NotFound => return Err(cause),
            _ => {}
        }
        File::create_new(path)
    };
    anew().map_err(Error::file("create", path))
}

/// Removes the temporary files that a run left in a folder when it was killed. To be called by the only run that writes there.
pub(crate) fn remove_parts(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && name.starts_with(PREFIX) && name.ends_with(SUFFIX) {
            // one that stays takes some place, and nothing else
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn replace(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<NamedTempFile>) -> io::Result<()>,
    before: impl FnOnce() -> io::Result<()>,
) -> io::Result<()> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut buffer = BufWriter::new(temporary(folder)?);
    content(&mut buffer)?;
    let file = buffer
        .into_inner()
        .map_err(io::IntoInnerError::into_error)?;
    file.as_file().sync_all()?;
    before()?;
    file.persist(path)?;
    Ok(())
}

/// A temporary file that will be as readable as an ordinary one (temporary files are private by default).
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
