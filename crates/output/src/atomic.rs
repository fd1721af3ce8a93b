//! Files that are there whole or not at all.
//!
//! The content goes to a temporary file in the same folder, is forced to the disk, and takes the final name by one
//! rename: a reader sees the old file or the new one, never a part, whenever the run is cut.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

use crate::Error;

/// Writes a file whole: `content` is given a buffered writer.
///
/// # Errors
/// [`Error::File`], naming `path` and the cause; an existing file of that name is then untouched and no temporary
/// file remains.
pub fn write(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Error> {
    replace(path, content).map_err(Error::file("write", path))
}

/// Writes text as a whole file.
///
/// # Errors
/// As [`write()`].
pub fn write_text(path: &Path, text: &str) -> Result<(), Error> {
    write(path, |to| to.write_all(text.as_bytes()))
}

fn replace(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
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
    file.persist(path)?;
    Ok(())
}

/// A temporary file that will be as readable as an ordinary one (temporary files are private by default).
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".carom-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
