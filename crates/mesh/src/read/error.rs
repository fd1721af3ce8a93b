//! Why a mesh could not be read.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

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
    /// No reader takes the extension.
    #[error("{}: found the extension \"{found}\", expected one of: {}", path.display(), expected.join(", "))]
    Extension {
        /// The file.
        path: PathBuf,
        /// Its extension, empty if it has none.
        found: String,
        /// Extensions that are read.
        expected: &'static [&'static str],
    },
    /// The format needs a feature that is not built in.
    #[error(
        "{}: this carom reads no MED files; build it with: cargo build --release --features hdf5", path.display()
    )]
    Feature {
        /// The file.
        path: PathBuf,
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
    /// A group or data set of an HDF5 file.
    Object(&'static str),
    /// A line of a text file, from 1.
    Line(usize),
    /// A byte of a binary file, from 0.
    Byte(usize),
}

impl ReadError {
    /// That a file has something other than expected there; `unsupported`: it is sound but not read.
    pub fn of_content(
        path: &Path,
        place: Place,
        (found, expected): (String, String),
        unsupported: bool,
    ) -> ReadError {
        let path = path.to_owned();
        match unsupported {
            true => ReadError::Unsupported {
                path,
                place,
                found,
                accepted: expected,
            },
            false => ReadError::Malformed {
                path,
                place,
                found,
                expected,
            },
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Object(name) => write!(f, "{name}"),
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}
