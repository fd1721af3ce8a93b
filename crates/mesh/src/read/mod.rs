//! Reading meshes from files.
//!
//! [`read`] chooses the format by the extension; each format has its own module. What a file says is checked here
//! as far as the file goes (syntax, counts, node tags, finite coordinates); whether the elements are fit for
//! computation is [`Mesh::check`]. Coordinates are taken as they stand: [`Mesh::scale`] makes them metres.

pub mod file;
pub mod gmsh;

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::Mesh;

/// Extensions of the files that [`read`] takes.
pub const EXTENSIONS: &[&str] = &["msh"];

/// Most bytes of a mesh file: 16 GiB, some hundred million nodes.
const LARGEST: u64 = 16 << 30;

/// Reads the mesh in a file; the extension, in any case, says the format: `.msh` is Gmsh's ([`gmsh`]).
///
/// Fails if the file cannot be read or its content refused; see [`ReadError`].
pub fn read(path: &Path) -> Result<Mesh, ReadError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    if !EXTENSIONS.contains(&extension.to_lowercase().as_str()) {
        return Err(ReadError::Extension {
            path: path.to_owned(),
            found: extension.into_owned(),
        });
    }
    let bytes = file::regular(path, LARGEST).map_err(|source| ReadError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    gmsh::parse(path, &bytes)
}

/// Why a mesh could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The operating system does not give the file.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The extension is none of [`EXTENSIONS`].
    #[error("{}: found the extension \"{found}\", expected one of: {}", path.display(), EXTENSIONS.join(", "))]
    Extension {
        /// The file.
        path: PathBuf,
        /// Its extension, empty if it has none.
        found: String,
    },
    /// The content breaks the rules of the format.
    #[error("{}, {place}: found {found}, expected {expected}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        place: Place,
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// The content is sound, but of a sort that Carom does not read.
    #[error("{}, {place}: {found} cannot be read; accepted: {accepted}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        place: Place,
        /// What stands there.
        found: String,
        /// What would be read.
        accepted: String,
    },
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of a text file, from 1.
    Line(usize),
    /// A byte of a binary file, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}
